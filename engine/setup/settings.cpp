// Settings from TOML files. Headset files, the only other ones, are read in xr/simulated/files.
#include "engine/setup/settings.h"

#include "engine/error.h"
#include "engine/setup/data_folders.h"
#include "engine/setup/text_file.h"
#include "xr/simulated/files/toml_guard.h"

#include <algorithm>
#include <optional>
#include <utility>

// Warnings in the library are not our concern.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
#include <toml++/toml.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace binosplat {

namespace {

std::string place(const std::string& file, const toml::node& node) {
    return fmt::format("{}:{}", file, node.source().begin.line);
}

// The text of a plain value; nothing for arrays, tables, dates and times.
std::optional<std::string> plainText(const toml::node& node) {
    if (const auto* text = node.as_string()) { return text->get(); }
    if (const auto* number = node.as_integer()) { return fmt::format("{}", number->get()); }
    if (const auto* number = node.as_floating_point()) { return fmt::format("{}", number->get()); }
    if (const auto* flag = node.as_boolean()) { return flag->get() ? "true" : "false"; }
    return std::nullopt;
}

Setting settingFrom(const std::string& file, const std::string& key, const toml::node& node) {
    Setting setting{fmt::format("{}: {}", place(file, node), key), {}};
    if (const toml::array* array = node.as_array()) {
        for (const toml::node& element : *array) {
            const std::optional<std::string> text = plainText(element);
            check(text.has_value(), "{} holds a {}, must be an array of numbers, strings or booleans",
                  setting.origin,
                  element.is_table()   ? "table"
                  : element.is_array() ? "nested array"
                                       : "date or time");
            setting.items.push_back(*text);
        }
        return setting;
    }
    const std::optional<std::string> text = plainText(node);
    check(text.has_value(), "{} must be a number, a string, a boolean or an array of these", setting.origin);
    setting.items.push_back(*text);
    return setting;
}

void addSetting(const std::string& file, SettingsTable& table, const std::string& written_key,
                const toml::node& node) {
    std::string key = written_key;
    std::ranges::replace(key, '_', '-');
    check(!table.settings.contains(key), "{}: {} is set twice, must be set once ('_' and '-' are the same)",
          place(file, node), written_key);
    table.settings.emplace(key, settingFrom(file, written_key, node));
}

SettingsTable tableFrom(const std::string& file, const std::string& name, const toml::table& table) {
    SettingsTable result{name, place(file, table), {}};
    for (const auto& [key, node] : table) {
        check(!node.is_table() && !node.is_array_of_tables(),
              "{}: [{}.{}] is a table in a table, must be a [table] of its own", place(file, node), name,
              key.str());
        addSetting(file, result, std::string(key.str()), node);
    }
    return result;
}

}  // namespace

std::string Setting::text() const {
    std::string joined;
    for (std::size_t i = 0; i < items.size(); ++i) { joined += (i == 0 ? "" : ",") + items[i]; }
    return joined;
}

std::vector<SettingsTable> readSettingsFile(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string text = readTextFile(givenOrShipped(path), "a TOML file");
    if (const auto found = files::findUnreadableToml(text)) {
        fail("{}:{}: {}", file, found->line, found->problem);
    }

    toml::table root;
    try {
        root = toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        fail("{}:{}: {}, must be valid TOML", file, error.source().begin.line,
             std::string(error.description()));
    }
    std::vector<SettingsTable> tables{SettingsTable{"", fmt::format("{}:1", file), {}}};
    for (const auto& [key, node] : root) {
        const std::string name(key.str());
        if (const toml::table* table = node.as_table()) {
            tables.push_back(tableFrom(file, name, *table));
        } else if (node.is_array_of_tables()) {
            for (const toml::node& element : *node.as_array()) {
                tables.push_back(tableFrom(file, name, *element.as_table()));
            }
        } else {
            addSetting(file, tables.front(), name, node);
        }
    }
    return tables;
}

}  // namespace binosplat
