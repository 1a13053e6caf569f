// Script files from disk, and headset files; the only place here that knows toml++.
#include "xr/simulated/script/script_files.h"

#include "xr/simulated/script/script_words.h"
#include "xr/simulated/script/toml_guard.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

// GCC 12 warns inside the header.
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

namespace simulated {

namespace fs = std::filesystem;

namespace {

std::string placeOf(const std::string& name, const toml::node& node) { return fmt::format("{}:{}", name, node.source().begin.line); }

// A table of a headset file that names itself in messages.
struct Table {
    const toml::table& values;
    std::string file;
    std::string prefix;  // "left." or nothing

    [[nodiscard]] const toml::node& require(std::string_view key) const {
        const toml::node* node = values.get(key);
        if (node == nullptr) { failAt(placeOf(file, values), "{}{} is missing, must be given", prefix, key); }
        return *node;
    }
    [[nodiscard]] double number(std::string_view key, double least, double most) const {
        const toml::node& node = require(key);
        const std::optional<double> value = node.value<double>();
        // Not the other way round: NaN is refused, too.
        if (!value || !(*value >= least && *value <= most)) {
            failAt(placeOf(file, node), "{}{} must be a number from {} to {}", prefix, key, least, most);
        }
        return *value;
    }
    [[nodiscard]] std::string text(std::string_view key) const {
        const toml::node& node = require(key);
        const std::optional<std::string> value = node.value<std::string>();
        if (!value) { failAt(placeOf(file, node), "{}{} must be a string", prefix, key); }
        return *value;
    }
    void refuseOthers(std::initializer_list<std::string_view> known) const {
        for (const auto& [key, node] : values) {
            const std::string_view word = key.str();
            if (std::ranges::find(known, word) != known.end()) { continue; }
            failAt(placeOf(file, node), "{}{} is not a key of a headset, must be {}", prefix, shown(word), listed(known));
        }
    }
};

glm::uvec2 sizeOf(const Table& table) {
    const std::string text = table.text("size");
    const std::size_t cross = text.find('x');
    std::array<double, 2> sides{};
    for (std::size_t i : {0, 1}) {
        const std::string_view part = i == 0 ? std::string_view(text).substr(0, cross) : std::string_view(text).substr(cross + 1);
        const std::optional<double> side = cross == std::string::npos ? std::nullopt : parseNumber(part);
        if (!side || *side < 1.0 || *side > 16384.0 || *side != std::floor(*side)) {
            failAt(placeOf(table.file, table.require("size")), "size is {}, must be WxH with 1 to 16384 per side", shown(text));
        }
        sides[i] = *side;
    }
    return {static_cast<std::uint32_t>(sides[0]), static_cast<std::uint32_t>(sides[1])};
}

Fov fovOf(const Table& root, std::string_view side) {
    const toml::node& node = root.require(side);
    if (!node.is_table()) { failAt(placeOf(root.file, node), "{} must be a table", side); }
    const Table table{*node.as_table(), root.file, std::string(side) + "."};
    table.refuseOthers({"left", "right", "up", "down"});
    const auto angle = [&](std::string_view key) { return glm::radians(table.number(key, -85.0, 85.0)); };
    const Fov fov{angle("left"), angle("right"), angle("up"), angle("down")};
    const std::string place = placeOf(root.file, node);
    if (fov.left_rad >= fov.right_rad) { failAt(place, "{0}.left must be less than {0}.right", side); }
    if (fov.down_rad >= fov.up_rad) { failAt(place, "{0}.down must be less than {0}.up", side); }
    return fov;
}

}  // namespace

std::string readText(const fs::path& path, const std::string& place, const char* expected) {
    constexpr std::size_t kMostBytes = std::size_t{16} << 20;
    const auto refuse = [&](const std::string& reason) {
        throw ScriptError(fmt::format("{}{}: cannot be read ({}), must be {}", place, path.string(), reason, expected));
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) { refuse(error ? error.message() : "No such file or directory"); }
    // Devices and pipes may never end.
    if (!fs::is_regular_file(status)) { refuse("not a regular file"); }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) { refuse(std::strerror(errno)); }
    std::string text(std::min<std::uintmax_t>(fs::file_size(path, error), kMostBytes) + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMostBytes) { refuse("longer than 16 MiB"); }
    return text;
}

HeadsetFile parseHeadset(const std::string& text, const std::string& name) {
    if (const auto found = third_party::findUnreadableToml(text)) { failAt(fmt::format("{}:{}", name, found->line), "{}", found->problem); }
    toml::table root;
    try {
        root = toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        failAt(fmt::format("{}:{}", name, error.source().begin.line), "{}, must be valid TOML", error.description());
    }
    const Table table{root, name, ""};
    table.refuseOthers({"name", "source", "size", "canting_deg", "eye_distance_m", "left", "right"});
    return {table.text("name"),
            sizeOf(table),
            table.number("eye_distance_m", 0.0, 1.0),
            glm::radians(table.number("canting_deg", 0.0, 45.0)),
            {fovOf(table, "left"), fovOf(table, "right")}};
}

}  // namespace simulated
