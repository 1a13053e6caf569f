// A line of a script as words, taken one after the other; every mistake is a ScriptError with file and line.
#pragma once

#include "xr/simulated/compose/geometry.h"
#include "xr/simulated/files/file_words.h"
#include "xr/simulated/script/script.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simulated {

template <typename... Args>
[[noreturn]] void failAt(const std::string& place, fmt::format_string<Args...> format, Args&&... args) {
    throw ScriptError(fmt::format("{}: {}", place, fmt::format(format, std::forward<Args>(args)...)));
}

using files::listWords;
using files::parseNumber;
using files::shown;

// Blanks separate words, # begins a comment, "double quotes" hold a word with blanks.
class Words {
public:
    Words(std::string_view line, std::string place);

    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] bool isAtEnd() const { return next_ == words_.size(); }
    // Takes the next word if it is `word`.
    bool takeIf(std::string_view word);

    // `meaning` is what a message calls the word.
    std::string takeText(std::string_view meaning);
    double takeNumber(std::string_view meaning, double least, double most);
    std::uint64_t takeCount(std::string_view meaning, std::uint64_t least, std::uint64_t most);
    // The index of the next word in `choices`.
    std::size_t takeChoice(std::string_view meaning, std::initializer_list<std::string_view> choices);
    bool takeOnOff(std::string_view meaning) { return takeChoice(meaning, {"on", "off"}) == 0; }
    Side takeSide() { return takeChoice("the side", {"left", "right"}) == 0 ? kLeft : kRight; }
    double takeTime(std::string_view meaning = "the time in seconds") {
        return takeNumber(meaning, -1e6, 1e6);
    }
    glm::dvec3 takePosition();
    glm::dquat takeRotation();
    // left right up down in degrees, within 85 degrees.
    Fov takeAngles();

    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        failAt(place_, format, std::forward<Args>(args)...);
    }
    void requireEnd() const;

private:
    std::string place_;
    std::vector<std::string> words_;
    std::size_t next_ = 0;
};

}  // namespace simulated
