// Words of a script's line.
#include "xr/simulated/script/script_words.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace simulated {

Words::Words(std::string_view line, std::string place) : place_(std::move(place)) {
    const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    for (std::size_t i = 0; i < line.size();) {
        if (isBlank(line[i])) {
            ++i;
        } else if (line[i] == '#') {
            break;
        } else if (line[i] == '"') {
            const std::size_t end = line.find('"', i + 1);
            if (end == std::string_view::npos) { fail("a quote is not closed, must be \"...\" on one line"); }
            words_.emplace_back(line.substr(i + 1, end - i - 1));
            i = end + 1;
        } else {
            const std::size_t begin = i;
            while (i < line.size() && !isBlank(line[i]) && line[i] != '#') { ++i; }
            words_.emplace_back(line.substr(begin, i - begin));
        }
    }
}

bool Words::takeIf(std::string_view word) {
    const bool is_next = !isAtEnd() && words_[next_] == word;
    if (is_next) { ++next_; }
    return is_next;
}

std::string Words::takeText(std::string_view meaning) {
    if (isAtEnd()) { fail("{} is missing", meaning); }
    if (words_[next_].empty()) { fail("{} is empty, must be a word", meaning); }
    return words_[next_++];
}

double Words::takeNumber(std::string_view meaning, double least, double most) {
    if (isAtEnd()) { fail("{} is missing, must be a number from {} to {}", meaning, least, most); }
    const std::string& word = words_[next_++];
    const std::optional<double> value = parseNumber(word);
    if (!value || *value < least || *value > most) {
        fail("{} is {}, must be a number from {} to {}", meaning, shown(word), least, most);
    }
    return *value;
}

std::uint64_t Words::takeCount(std::string_view meaning, std::uint64_t least, std::uint64_t most) {
    if (isAtEnd()) { fail("{} is missing, must be a whole number from {} to {}", meaning, least, most); }
    const std::string& word = words_[next_++];
    const auto value = files::parseWhole<std::uint64_t>(word);
    if (!value || *value < least || *value > most) {
        fail("{} is {}, must be a whole number from {} to {}", meaning, shown(word), least, most);
    }
    return *value;
}

std::size_t Words::takeChoice(std::string_view meaning, std::initializer_list<std::string_view> choices) {
    if (isAtEnd()) { fail("{} is missing, must be {}", meaning, listWords(choices)); }
    const std::string& word = words_[next_++];
    const auto* const found = std::ranges::find(choices, word);
    if (found == choices.end()) { fail("{} is {}, must be {}", meaning, shown(word), listWords(choices)); }
    return static_cast<std::size_t>(found - choices.begin());
}

glm::dvec3 Words::takePosition() {
    constexpr double kFarthest = 1e5;
    const double x = takeNumber("position x", -kFarthest, kFarthest);
    const double y = takeNumber("position y", -kFarthest, kFarthest);
    return {x, y, takeNumber("position z", -kFarthest, kFarthest)};
}

glm::dquat Words::takeRotation() {
    std::array<double, 4> parts{};  // x, y, z, w
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i] = takeNumber(fmt::format("rotation {}", "xyzw"[i]), -1e6, 1e6);
    }
    const glm::dquat quaternion(parts[3], parts[0], parts[1], parts[2]);
    const double length = glm::length(quaternion);
    if (length < 1e-3) {
        fail("the rotation's length is {}, must be 1 (or at least 0.001 to be made so)", length);
    }
    return quaternion / length;
}

Fov Words::takeAngles() {
    constexpr double kWidest = 85.0;
    const double left = takeNumber("the angle to the left in degrees", -kWidest, kWidest);
    const double right = takeNumber("the angle to the right in degrees", -kWidest, kWidest);
    const double up = takeNumber("the angle up in degrees", -kWidest, kWidest);
    const double down = takeNumber("the angle down in degrees", -kWidest, kWidest);
    if (left >= right) {
        fail("the angles are {} to the left and {} to the right, left must be less", left, right);
    }
    if (down >= up) { fail("the angles are {} up and {} down, down must be less", up, down); }
    return {glm::radians(left), glm::radians(right), glm::radians(up), glm::radians(down)};
}

void Words::requireEnd() const {
    if (!isAtEnd()) { fail("unexpected {} at the end of the line", shown(words_[next_])); }
}

}  // namespace simulated
