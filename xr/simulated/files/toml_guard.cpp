// Scans every byte. toml++ 3.1 to 3.4 makes a table within a table for each dot of a key and frees them by
// recursion, and runs into an "unreachable" branch at letters such as U+00A1 to U+0499 or U+FAE6 to U+FEFE
// wherever it asks whether a word goes on. Letters in quotes must not get there, so quotes are allowed only
// where toml++ takes them for a string, and not for more letters of a word that is already wrong.
#include "xr/simulated/files/toml_guard.h"

#include <vector>

namespace files {

namespace {

constexpr int kMostParts = 64;

// Follows a text outside of its quotes and comments.
class Place {
public:
    // True if a string in quotes may begin here.
    [[nodiscard]] bool beginsText() const { return begins_; }

    void pass(char letter) {
        switch (letter) {
            case ' ':
            case '\t':
            case '\r':
                return;
            case '\n':
                begins_ = true;
                has_key_ = false;
                return;
            case ',':  // ends a word, too
                begins_ = true;
                has_key_ = false;
                return;
            case '=':  // ends a key, if one may stand here
                begins_ = !has_key_ && (open_.empty() || open_.back() == '{');
                has_key_ = true;
                return;
            case '[':
            case '{':
                if (!begins_) { return; }
                open_.push_back(letter);
                has_key_ = false;
                return;
            case ']':
            case '}':
                if (!open_.empty()) { open_.pop_back(); }
                begins_ = false;
                return;
            default:
                begins_ = false;
        }
    }

private:
    bool begins_ = true, has_key_ = false;
    std::vector<char> open_;  // brackets
};

}  // namespace

std::optional<UnreadableToml> findUnreadableToml(std::string_view text) {
    constexpr std::string_view kByteOrderMark("\xef\xbb\xbf"), kBetweenKeys("=,[]{}/:;()\n");
    if (text.starts_with(kByteOrderMark)) { text.remove_prefix(kByteOrderMark.size()); }
    Place place;
    int line = 1, dots = 0;
    bool comment = false;
    char quote = '\0';  // the one that is open
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char letter = text[i];
        if (letter == '\n') {
            ++line;
            comment = false;
            quote = '\0';
        }
        dots = kBetweenKeys.find(letter) != std::string_view::npos ? 0 : dots + (letter == '.');
        if (dots > kMostParts) {
            return UnreadableToml{line, "a key of more than " + std::to_string(kMostParts) +
                                            " parts, must be a [table] and a key"};
        }
        if (comment) { continue; }
        if (quote != '\0') {
            if (letter == '\\' && quote == '"' && i + 1 < text.size() && text[i + 1] != '\n') {
                ++i;  // whatever follows does not close the quotes
            } else if (letter == quote) {
                quote = '\0';
            }
            continue;
        }
        if (static_cast<unsigned char>(letter) >= 128) {
            return UnreadableToml{line, "a letter that is neither ASCII nor in quotes nor in a comment"};
        }
        comment = letter == '#';
        if (letter == '"' || letter == '\'') {
            if (!place.beginsText()) {
                return UnreadableToml{line, "quotes within a word, must be around it"};
            }
            const std::string_view three = text.substr(i, 3);
            if (three == "\"\"\"" || three == "'''") {
                return UnreadableToml{line, "a text over several lines, must be on one"};
            }
            quote = letter;
        }
        place.pass(letter);
    }
    return std::nullopt;
}

}  // namespace files
