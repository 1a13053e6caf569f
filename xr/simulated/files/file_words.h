// Shared by the readers of headsets and head motion: numbers, and errors that name file and line.
#pragma once

#include <charconv>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace files {

// One line: file, place, what is wrong, what it must be.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

template <typename... Parts>
[[noreturn]] void failAt(std::string_view file, std::size_t line, const Parts&... parts) {
    std::ostringstream text;
    text << file << ':' << line << ": ";
    (text << ... << parts);
    throw Error(text.str());
}

// A word in the form that a message shows: short and printable.
[[nodiscard]] std::string shown(std::string_view word);

// The whole word as a number in the C locale; empty if it is anything else, or not finite.
[[nodiscard]] std::optional<double> parseNumber(std::string_view word);

// The whole word as an integer; empty if it is anything else, or too large for the type.
template <typename Integer>
[[nodiscard]] std::optional<Integer> parseWhole(std::string_view word) {
    Integer value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

// "one, two or three"
[[nodiscard]] std::string listWords(std::initializer_list<std::string_view> words);

// Without blanks around it.
[[nodiscard]] std::string_view trim(std::string_view text);

}  // namespace files
