// Reads words as numbers, trims them, and prepares them for messages.
#include "xr/simulated/files/file_words.h"

#include <cmath>

namespace files {

std::string shown(std::string_view word) {
    constexpr std::size_t kMost = 60;
    std::string result;
    for (const char c : word.substr(0, kMost)) { result += c >= ' ' && c <= '~' ? c : '?'; }
    return word.size() > kMost ? result + "..." : result;
}

std::optional<double> parseNumber(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) { word.remove_prefix(1); }
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

std::string listWords(std::initializer_list<std::string_view> words) {
    std::string result;
    for (const std::string_view& word : words) {
        const bool is_first = &word == words.begin(), is_last = &word + 1 == words.end();
        result += is_first ? "" : is_last ? " or " : ", ";
        result += word;
    }
    return result;
}

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

}  // namespace files
