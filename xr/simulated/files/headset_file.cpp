// Headset files; the only place of the simulated runtime that knows toml++.
#include "xr/simulated/files/headset_file.h"

#include "xr/simulated/files/file_words.h"
#include "xr/simulated/files/toml_guard.h"

#include <algorithm>
#include <initializer_list>
#include <numbers>
#include <vector>

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

namespace files {

namespace {

double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

double degrees(double radians) { return radians * (180.0 / std::numbers::pi); }

std::string putInWords(const toml::node& node) {
    if (const auto text = node.value<std::string>()) { return shown(*text); }
    if (const auto* number = node.as_integer()) { return std::to_string(number->get()); }
    if (const auto number = node.value<double>()) {
        std::ostringstream text;
        text << *number;
        return text.str();
    }
    return node.is_table() ? "a table" : "no number";
}

// A table that names itself in messages.
class Table {
public:
    Table(const toml::table& values, std::string file, std::string prefix,
          std::initializer_list<std::string_view> known)
        : values_(values), file_(std::move(file)), prefix_(std::move(prefix)) {
        std::vector<std::string> seen;
        for (const auto& [key, node] : values) {
            std::string word(key.str());
            std::ranges::replace(word, '-', '_');
            if (std::ranges::find(known, word) == known.end()) {
                fail(node, prefix_, shown(key.str()), " is not a key of a headset, must be ",
                     listWords(known));
            }
            if (std::ranges::find(seen, word) != seen.end()) {
                fail(node, prefix_, word, " is set twice, must be set once");
            }
            seen.push_back(word);
        }
    }

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::string& prefix() const { return prefix_; }
    [[nodiscard]] const toml::node& require(std::string_view key) const {
        if (const toml::node* node = find(key)) { return *node; }
        const bool is_table = key == "left" || key == "right";
        if (prefix_.empty() && is_table) { fail(values_, '[', key, "] is missing, must be given"); }
        fail(values_, prefix_, key, " is missing, must be given");
    }
    // Null: it is not there.
    [[nodiscard]] const toml::node* find(std::string_view key) const {
        for (const auto& [name, node] : values_) {
            std::string word(name.str());
            std::ranges::replace(word, '-', '_');
            if (word == key) { return &node; }
        }
        return nullptr;
    }
    [[nodiscard]] double number(std::string_view key, double least, double most) const {
        return numberOf(require(key), key, least, most);
    }
    [[nodiscard]] double numberOf(const toml::node& node, std::string_view key, double least,
                                  double most) const {
        const std::optional<double> value = node.value<double>();
        // Written so that NaN is refused, too.
        if (!value || !(*value >= least && *value <= most)) {
            fail(node, prefix_, key, " is ", putInWords(node), ", must be a number from ", least, " to ",
                 most);
        }
        return *value;
    }
    [[nodiscard]] std::string text(std::string_view key) const {
        const toml::node& node = require(key);
        const std::optional<std::string> value = node.value<std::string>();
        if (!value || value->empty()) {
            fail(node, prefix_, key, value ? " is empty, must be a text" : " must be a text");
        }
        return *value;
    }
    template <typename... Parts>
    [[noreturn]] void fail(const toml::node& node, const Parts&... parts) const {
        failAt(file_, node.source().begin.line, parts...);
    }

private:
    const toml::table& values_;
    std::string file_;
    std::string prefix_;  // "left." or nothing
};

std::array<std::uint32_t, 2> sizeOf(const Table& table, std::string_view key = "size") {
    const std::string text = table.text(key);
    const auto side = [](std::string_view digits) {
        const std::uint32_t value = parseWhole<std::uint32_t>(digits).value_or(0);
        return value <= 16384 ? value : 0;
    };
    const std::size_t cross = std::min(text.find('x'), text.size());
    const std::string_view all = text;
    const std::array<std::uint32_t, 2> size_px{side(all.substr(0, cross)),
                                               side(all.substr(std::min(cross + 1, all.size())))};
    if (size_px[0] == 0 || size_px[1] == 0) {
        table.fail(table.require(key), table.prefix(), key, " is ", shown(text),
                   ", must be WxH with 1 to 16384 per side");
    }
    return size_px;
}

// To the right and upwards of the eye's axis, within its view.
std::array<double, 2> lensCentreOf(const Table& table, const HeadsetAngles& angles) {
    const toml::node* node = table.find("lens_centre");
    if (node == nullptr) { return {}; }
    const toml::array* both = node->as_array();
    if (both == nullptr || both->size() != 2) {
        table.fail(*node, table.prefix(), "lens_centre must be two angles, [right, up]");
    }
    const auto within = [&](std::size_t i, double least_rad, double most_rad) {
        return radians(table.numberOf(*both->get(i), "lens_centre", degrees(least_rad), degrees(most_rad)));
    };
    return {within(0, angles.left_rad, angles.right_rad), within(1, angles.down_rad, angles.up_rad)};
}

struct Lens {
    HeadsetAngles angles;
    std::array<double, 2> centre_rad;
};

Lens lensOf(const Table& root, std::string_view side) {
    const toml::node& node = root.require(side);
    if (!node.is_table()) { root.fail(node, side, " must be a table"); }
    const Table table(*node.as_table(), root.file(), std::string(side) + ".",
                      {"left", "right", "up", "down", "lens_centre"});
    const auto angle = [&](std::string_view key) { return radians(table.number(key, -85.0, 85.0)); };
    const HeadsetAngles angles{angle("left"), angle("right"), angle("up"), angle("down")};
    if (angles.left_rad >= angles.right_rad) {
        table.fail(node, side, ".left must be less than ", side, ".right");
    }
    if (angles.down_rad >= angles.up_rad) { table.fail(node, side, ".down must be less than ", side, ".up"); }
    return {angles, lensCentreOf(table, angles)};
}

HeadsetInset insetOf(const Table& root, const toml::node& node) {
    if (!node.is_table()) { root.fail(node, "inset must be a table"); }
    const Table table(*node.as_table(), root.file(), "inset.", {"half_angle_deg", "size", "context_size"});
    HeadsetInset inset{radians(table.number("half_angle_deg", 1.0, 85.0)), {}, {}};
    if (table.find("size") != nullptr) { inset.size_px = sizeOf(table); }
    if (table.find("context_size") != nullptr) { inset.context_size_px = sizeOf(table, "context_size"); }
    return inset;
}

}  // namespace

HeadsetFile parseHeadset(const std::string& text, const std::string& file) {
    if (const auto found = findUnreadableToml(text)) {
        failAt(file, static_cast<std::size_t>(found->line), found->problem);
    }
    toml::table root;
    try {
        root = toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        failAt(file, error.source().begin.line, error.description(), ", must be valid TOML");
    }
    const Table table(root, file, "",
                      {"name", "source", "size", "canting_deg", "eye_distance_m", "left", "right", "inset"});
    HeadsetFile headset;
    headset.name = table.text("name");
    headset.source = table.text("source");
    headset.size_px = sizeOf(table);
    headset.canting_rad = radians(table.number("canting_deg", 0.0, 45.0));
    headset.eye_distance_m = table.number("eye_distance_m", 0.0, 1.0);
    for (std::size_t side = 0; side < 2; ++side) {
        const Lens lens = lensOf(table, side == 0 ? "left" : "right");
        headset.angles[side] = lens.angles;
        headset.lens_centres_rad[side] = lens.centre_rad;
    }
    if (const toml::node* const inset = table.find("inset")) { headset.inset = insetOf(table, *inset); }
    return headset;
}

}  // namespace files
