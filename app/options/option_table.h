// Every option, once. The command line, config files, reports, the viewer's saved settings, the man page, the
// completions, docs/options.md and configs/default.toml are made from these rows.
#pragma once

#include "app/options/option_row.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

// Options of more than one command, also allowed in config files.
std::span<const OptionRow<RunOptions>> runRows();
const OptionRow<RunOptions>* findRunRow(std::string_view key);  // nullptr: there is none

// Options of a single command.
std::span<const OptionRow<RenderOptions>> renderRows();
std::span<const OptionRow<BenchOptions>> benchRows();
std::span<const OptionRow<ViewOptions>> viewRows();
std::span<const OptionRow<SceneOptions>> sceneRows();
std::span<const OptionRow<ConvertOptions>> convertRows();
std::span<const OptionRow<CompareOptions>> compareRows();
std::span<const OptionRow<StabilityOptions>> stabilityRows();
std::span<const OptionRow<KernelsOptions>> kernelsRows();

// "text", "0.5", "1,2,3", "true"; empty if there is none.
std::string textOf(const OptionValue& value);

// An option's description for people.
struct OptionDescription {
    OptionText text;
    std::string range, standard;              // empty if there is none, or the help says
    std::vector<std::string_view> choices{};  // as in its field
    bool is_file = false;

    [[nodiscard]] std::string help() const;  // with range and default in brackets
};

// In a fresh `Owner` fields have their defaults.
template <typename Owner>
OptionDescription describe(const OptionRow<Owner>& row) {
    std::string standard = *row.text.standard != '\0' ? row.text.standard : textOf(row.field.value(Owner{}));
    if (row.text.isFlag() && standard == "false") { standard.clear(); }  // obvious for a flag
    return {row.text, row.field.range, standard, row.field.choices, row.field.is_file};
}
template <typename Owner>
std::vector<OptionDescription> describe(std::span<const OptionRow<Owner>> rows) {
    std::vector<OptionDescription> descriptions;
    for (const OptionRow<Owner>& row : rows) { descriptions.push_back(describe(row)); }
    return descriptions;
}

// `options`, with the rows that are in `settings` replaced.
template <typename Owner>
Owner readRows(std::span<const OptionRow<Owner>> rows, const Settings& settings, Owner options = {}) {
    for (const OptionRow<Owner>& row : rows) {
        if (const auto found = settings.find(row.text.key); found != settings.end()) {
            row.field.read(found->second, options);
        }
    }
    return options;
}

}  // namespace binosplat
