// Options and the viewer's settings as lines of TOML.
#include "app/command_line/option_documents.h"

#include "app/options/option_table.h"
#include "app/view/settings/view_settings_table.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

constexpr std::size_t kHelpFrom = 36;  // columns

// Examples for keys without a default.
constexpr std::array<std::pair<std::string_view, const char*>, 16> kExamples{{
    {"eye", "[0.0, -1.5, -3.0]"},
    {"look", "[0.0, -1.0, 0.0]"},
    {"up", "[0.0, -1.0, 0.0]"},
    {"fov-x", "60.0"},
    {"size", "\"1024x1024\""},
    {"cameras", "\"cameras.json\""},
    {"near", "0.2"},
    {"headset", "\"quest2\""},
    {"ipd", "0.063"},
    {"gaze", "[0.0, 0.0, 1.0]"},
    {"order", "\"depth\""},
    {"lod", "0"},
    {"splat-budget", "2000000"},
    {"sh-degree", "3"},
    {"memory-limit", "4096"},
    {"device", "\"0\""},
}};

std::string tomlOf(const OptionValue& value) {
    if (const auto* vector = std::get_if<glm::dvec3>(&value)) {
        return fmt::format("[{}, {}, {}]", vector->x, vector->y, vector->z);
    }
    return std::holds_alternative<std::string>(value) ? fmt::format("\"{}\"", textOf(value)) : textOf(value);
}

std::string writeLine(const std::string& setting, const std::string& help) {
    return fmt::format("{:<{}}{}# {}\n", setting, kHelpFrom, setting.size() < kHelpFrom ? "" : " ", help);
}

template <typename Owner>
std::string writeRow(const OptionRow<Owner>& row) {
    const OptionValue standard = row.field.value(Owner{});
    const bool has_none = std::holds_alternative<std::monostate>(standard),
               is_open = has_none || row.text.by_command;
    std::string value = tomlOf(standard), help = row.text.help;
    if (has_none) {
        const auto* const found =
            std::ranges::find(kExamples, row.text.key, &std::pair<std::string_view, const char*>::first);
        value = found == kExamples.end() ? fmt::format("\"{}\"", row.text.value) : found->second;
    }
    if (!row.field.range.empty()) { help += fmt::format(" ({})", row.field.range); }
    if (*row.text.standard != '\0') {
        help += fmt::format("; {}: {}", is_open ? "absent" : value, row.text.standard);
    }
    return writeLine(fmt::format("{}{} = {}", is_open ? "# " : "", row.text.key, value), help);
}

}  // namespace

std::string defaultConfig() {
    std::string text =
        "# Every key of a config and its default. `binosplat render SCENE --out DIR --config "
        "configs/default.toml` does the\n# same as without a config. The command line wins over a config. "
        "Keys are the options' names, in which '_' may be\n# written for '-'. A key may also be at the top, "
        "outside its table. Keys in comments have no default, or a\n# different one for each command. File "
        "names are relative to this file. Generated from the program's own table\n# (`binosplat document "
        "config`).\n";
    const char* table = "";
    for (const OptionRow<RunOptions>& row : runRows()) {
        if (std::string_view(table) != row.text.table) {
            table = row.text.table;
            text += fmt::format("\n[{}]\n", table);
        }
        text += writeRow(row);
    }
    text += '\n';
    text += writeLine("[view]", "for `view` only; its panel saves and loads these");
    for (const OptionRow<ViewSettings>& row : viewSettingsRows()) { text += writeRow(row); }
    text +=
        writeLine("# scene-position = [0.0, 0.0, 0.0]",
                  "origin of the wearer's room in the scene; give this and the next two, or none of them");
    text += writeLine("# scene-orientation = [1.0, 0.0, 0.0, 0.0]",
                      "how the room is turned: w, x, y, z of a quaternion");
    text += writeLine("# units-per-metre = 1.0",
                      "scene units in a metre of the room; without these, [camera] and metres-per-unit say "
                      "where and how large");
    return text;
}

}  // namespace binosplat
