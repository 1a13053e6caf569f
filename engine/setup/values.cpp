// Typed values from settings.
#include "engine/setup/values.h"

#include "engine/error.h"
#include "xr/simulated/files/file_words.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

[[noreturn]] void refuse(const Setting& setting, const std::string& expected) {
    const std::string text = setting.text();
    fail("{} is {}, must be {}", setting.origin, text.empty() ? "empty" : text, expected);
}

std::optional<std::uint64_t> parseCount(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) { return std::nullopt; }
    return value;
}

// Exactly three comma-separated numbers.
std::optional<glm::dvec3> parseVector(std::string_view text) {
    glm::dvec3 vector{0.0};
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = i < 2 ? text.find(',') : text.size();
        if (comma == std::string_view::npos) { return std::nullopt; }
        const std::optional<double> number = parseNumber(text.substr(0, comma));
        if (!number) { return std::nullopt; }
        vector[i] = *number;
        text.remove_prefix(i < 2 ? comma + 1 : comma);
    }
    return vector;
}

}  // namespace

std::optional<double> parseNumber(std::string_view text) { return files::parseNumber(files::trim(text)); }

double readNumber(const Setting& setting, double least, double most) {
    const std::optional<double> value = parseNumber(setting.text());
    if (!value || *value < least || *value > most) {
        refuse(setting, fmt::format("a number from {} to {}", least, most));
    }
    return *value;
}

double readShare(const Setting& setting) {
    const std::string text = setting.text();
    const bool per_cent = text.ends_with('%');
    const std::optional<double> value =
        parseNumber(std::string_view(text).substr(0, text.size() - (per_cent ? 1 : 0)));
    const double share = value.value_or(-1.0) / (per_cent ? 100.0 : 1.0);
    if (share < 0.0 || share > 1.0) { refuse(setting, "a number from 0 to 1, or from 0% to 100%"); }
    return share;
}

double readPositive(const Setting& setting) {
    const std::optional<double> value = parseNumber(setting.text());
    if (!value || *value <= 0.0) { refuse(setting, "a number greater than 0"); }
    return *value;
}

std::uint64_t readCount(const Setting& setting, std::uint64_t least, std::uint64_t most) {
    const std::optional<std::uint64_t> value = parseCount(setting.text());
    if (!value || *value < least || *value > most) {
        refuse(setting, fmt::format("a whole number from {} to {}", least, most));
    }
    return *value;
}

glm::dvec3 readVector(const Setting& setting) {
    const std::optional<glm::dvec3> vector = parseVector(setting.text());
    if (!vector) { refuse(setting, "three finite numbers x,y,z"); }
    return *vector;
}

glm::dvec3 readDirection(const Setting& setting) {
    const std::optional<glm::dvec3> vector = parseVector(setting.text());
    // Not so long or short that its square would not be a number.
    if (!vector || !(glm::length(*vector) > 1e-100 && glm::length(*vector) < 1e100)) {
        refuse(setting, "a direction x,y,z, not 0,0,0");
    }
    return *vector;
}

glm::dvec4 readSphere(const Setting& setting) {
    const std::string text = setting.text();
    const std::size_t comma = text.rfind(',');
    const std::optional<glm::dvec3> centre =
        comma == std::string::npos ? std::nullopt : parseVector(text.substr(0, comma));
    const std::optional<double> radius =
        centre ? parseNumber(std::string_view(text).substr(comma + 1)) : std::nullopt;
    if (!radius || !(*radius > 0.0)) {
        refuse(setting, "four finite numbers x,y,z,r, with a radius r over 0");
    }
    return {*centre, *radius};
}

glm::dvec3 readColour(const Setting& setting) {
    const std::optional<glm::dvec3> colour = parseVector(setting.text());
    const bool in_range = colour && glm::all(glm::greaterThanEqual(*colour, glm::dvec3(0.0))) &&
                          glm::all(glm::lessThanEqual(*colour, glm::dvec3(1.0)));
    if (!in_range) { refuse(setting, "three numbers r,g,b from 0 to 1"); }
    return *colour;
}

glm::uvec2 readSize(const Setting& setting) {
    const std::string text = setting.text();
    const std::size_t cross = text.find('x');
    const std::string_view all = text;
    const auto width = parseCount(all.substr(0, cross));
    const auto height = cross == std::string::npos ? width : parseCount(all.substr(cross + 1));
    const auto fits = [](const std::optional<std::uint64_t>& side) {
        return side && *side >= 1 && *side <= kMaxSide;
    };
    if (!fits(width) || !fits(height)) {
        refuse(setting,
               fmt::format("WIDTHxHEIGHT with 1 to {} pixels per side, or one number for both", kMaxSide));
    }
    return {static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
}

bool readFlag(const Setting& setting) {
    const std::string text = setting.text();
    if (text == "true") { return true; }
    if (text == "false") { return false; }
    refuse(setting, "true or false");
}

std::string readText(const Setting& setting) {
    if (setting.items.size() != 1 || setting.items.front().empty()) {
        refuse(setting, "one text that is not empty");
    }
    return setting.items.front();
}

std::string readChoice(const Setting& setting, const std::vector<std::string_view>& names) {
    const std::string text = setting.text();
    std::string list;
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (text == *name) { return text; }
        list += (name == names.begin() ? "" : name + 1 == names.end() ? " or " : ", ") + std::string(*name);
    }
    refuse(setting, list);
}

}  // namespace binosplat
