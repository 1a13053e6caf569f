// By FriBidi, which wants its letters in 32 bits.
#include "app/view/panel/shown_text.h"

#include <fribidi.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <vector>

namespace binosplat {

namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD, which is shown as a box

// Hebrew, U+0590, begins the letters that are read from right to left.
bool mayTurnRound(std::string_view text) {
    return std::ranges::any_of(text, [](char byte) { return static_cast<unsigned char>(byte) >= 0xd6; });
}

std::string turnedRound(const std::string& text) {
    std::vector<FriBidiChar> letters, seen;
    for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
        unsigned int letter = 0;
        at += std::max(ImTextCharFromUtf8(&letter, at, end), 1);
        letters.push_back(letter);
    }
    seen.resize(letters.size() + 1);
    FriBidiParType base = FRIBIDI_PAR_LTR;  // a path, or a sentence in English
    const auto length = static_cast<FriBidiStrIndex>(letters.size());
    if (fribidi_log2vis(letters.data(), length, &base, seen.data(), nullptr, nullptr, nullptr) == 0) { return text; }
    seen.pop_back();
    std::erase(seen, FriBidiChar{FRIBIDI_CHAR_FILL});  // what is left of letters that became one
    std::string shown;
    for (const FriBidiChar letter : seen) {
        std::array<char, 8> bytes{};
        FriBidiChar one = letter;
        const FriBidiStrIndex count = fribidi_unicode_to_charset(FRIBIDI_CHAR_SET_UTF8, &one, 1, bytes.data());
        shown.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return shown;
}

}  // namespace

std::string withoutControls(std::string_view text) {
    std::string clean;
    for (const char letter : text) {
        const bool control = static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
        clean += control ? kReplacement : std::string_view(&letter, 1);
    }
    return clean;
}

std::string asShown(std::string_view text) {
    std::string shown = withoutControls(text);
    return mayTurnRound(shown) ? turnedRound(shown) : shown;
}

}  // namespace binosplat
