// One look at every byte. toml++ 3.1 makes a table within a table for each dot of a key and frees them by recursion, and runs into an
// "unreachable" branch at letters such as U+00A1 to U+0499 where a blank could stand, be it between quotes that begin within a number.
#include "engine/setup/settings_guard.h"

#include "engine/error.h"

namespace binosplat {

void refuseUnreadableSettings(const std::string& file, std::string_view text) {
    constexpr std::string_view kByteOrderMark("\xef\xbb\xbf"), kBetweenKeys("=,[]{}/:;()\n"), kBeforeQuotes(" \t=,[{\n\r");
    constexpr int kMaxParts = 64;
    if (text.starts_with(kByteOrderMark)) { text.remove_prefix(kByteOrderMark.size()); }
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
        check(dots <= kMaxParts, "{}:{}: a key of more than {} parts, must be a [table] and a key", file, line, kMaxParts);
        if (comment) { continue; }
        if (quote != '\0') {
            if (letter == '\\' && quote == '"') {
                ++i;  // whatever follows does not close the quotes
            } else if (letter == quote) {
                quote = '\0';
            }
            continue;
        }
        check(static_cast<unsigned char>(letter) < 128, "{}:{}: a letter that is neither ASCII nor in quotes nor in a comment", file, line);
        comment = letter == '#';
        if (letter != '"' && letter != '\'') { continue; }
        const bool begins = i == 0 || kBeforeQuotes.find(text[i - 1]) != std::string_view::npos;
        check(begins, "{}:{}: quotes within a word, must be around it", file, line);
        const std::string_view three = text.substr(i, 3);
        check(three != "\"\"\"" && three != "'''", "{}:{}: a text over several lines, must be on one", file, line);
        quote = letter;
    }
}

}  // namespace binosplat
