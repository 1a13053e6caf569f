// Uses FriBidi, which takes letters of 32 bits.
#include "app/view/panel/shown_text.h"

#include <fribidi.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD, which is shown as a box

// Letters that are read from right to left, or change with their neighbours, begin with Hebrew, U+0590.
bool mayChange(std::string_view text) {
    return std::ranges::any_of(text, [](char byte) { return static_cast<unsigned char>(byte) >= 0xd6; });
}

// The scripts from Hebrew to Burmese, Korean in parts, the rest of South and South-East Asia, and letters
// beyond the 16 bits of ImGui's.
bool isOfWord(char32_t letter) {
    constexpr std::array<std::pair<char32_t, char32_t>, 4> kScripts{
        {{0x0590, 0x11ff}, {0x1700, 0x1cff}, {0xa800, 0xabff}, {0x10000, 0x10ffff}}};
    return std::ranges::any_of(
        kScripts, [&](const auto& range) { return letter >= range.first && letter <= range.second; });
}

// Also characters that join letters, keep them apart or choose between their forms.
bool isWithinWord(char32_t letter) {
    return isOfWord(letter) || letter == 0x200c || letter == 0x200d ||
           (letter >= 0x0300 && letter <= 0x036f) || (letter >= 0xfe00 && letter <= 0xfe0f);
}

std::u32string lettersOf(std::string_view text) {
    std::u32string letters;
    for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
        unsigned int letter = 0;
        const int bytes = std::max(ImTextCharFromUtf8(&letter, at, end), 1);
        if (bytes == 4) {  // ImGui knows only the length of these
            const auto bits = [&](int i) {
                return static_cast<unsigned>(static_cast<unsigned char>(at[i])) & 0x3fu;
            };
            const auto continues = [&](int i) { return (static_cast<unsigned char>(at[i]) & 0xc0) == 0x80; };
            const unsigned whole = (bits(0) & 7u) << 18 | bits(1) << 12 | bits(2) << 6 | bits(3);
            const bool is_one =
                continues(1) && continues(2) && continues(3) && whole >= 0x10000 && whole <= 0x10ffff;
            letter = is_one ? whole : IM_UNICODE_CODEPOINT_INVALID;
        }
        at += bytes;
        letters += letter >= kFirstPrivate && letter <= kLastPrivate ? char32_t{IM_UNICODE_CODEPOINT_INVALID}
                                                                     : char32_t{letter};
    }
    return letters;
}

// Calls `use` with the begin and end of each word.
template <typename Use>
void forEachWord(const std::u32string& letters, const Use& use) {
    for (auto at = letters.begin(); (at = std::find_if(at, letters.end(), isOfWord)) != letters.end();) {
        const auto end = std::find_if_not(at, letters.end(), isWithinWord);
        use(static_cast<std::size_t>(at - letters.begin()), static_cast<std::size_t>(end - letters.begin()));
        at = end;
    }
}

void append(std::string& shown, FriBidiChar letter) {
    std::array<char, 8> bytes{};
    const FriBidiStrIndex count = fribidi_unicode_to_charset(FRIBIDI_CHAR_SET_UTF8, &letter, 1, bytes.data());
    shown.append(bytes.data(), static_cast<std::size_t>(count));
}

std::string changed(const std::string& text) {
    const std::u32string letters = lettersOf(text);
    const std::vector<FriBidiChar> read(letters.begin(), letters.end());
    std::vector<FriBidiChar> seen(letters.size() + 1);
    std::vector<FriBidiStrIndex> places(letters.size() + 1);  // of the letters seen, among those read
    FriBidiParType base = FRIBIDI_PAR_LTR;                    // a path, or a sentence in English
    if (fribidi_log2vis(read.data(), static_cast<FriBidiStrIndex>(read.size()), &base, seen.data(), nullptr,
                        places.data(), nullptr) == 0) {
        return text;
    }
    const auto* const forms = ImGui::GetCurrentContext() != nullptr
                                  ? static_cast<const WordForms*>(ImGui::GetIO().UserData)
                                  : nullptr;
    std::vector<const std::u32string*> forms_at(letters.size(), nullptr);
    forEachWord(letters, [&](std::size_t begin, std::size_t end) {
        if (forms == nullptr) { return; }
        const auto found = forms->find(letters.substr(begin, end - begin));
        if (found != forms->end()) { std::fill(&forms_at[begin], &forms_at[end - 1] + 1, &found->second); }
    });
    std::string shown;
    const std::u32string* before = nullptr;
    for (std::size_t i = 0; i < letters.size(); ++i) {
        const std::u32string* const form = forms_at[static_cast<std::size_t>(places[i])];
        // fill: left over from letters that became one
        if (form == nullptr && seen[i] != FRIBIDI_CHAR_FILL) { append(shown, seen[i]); }
        if (form != nullptr && form != before) {
            for (const char32_t letter : *form) { append(shown, letter); }
        }
        before = form;
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
    return mayChange(shown) ? changed(shown) : shown;
}

std::set<std::u32string> wordsToForm(std::string_view text) {
    std::set<std::u32string> words;
    if (!mayChange(text)) { return words; }
    const std::u32string letters = lettersOf(text);
    forEachWord(letters, [&](std::size_t begin, std::size_t end) {
        words.insert(letters.substr(begin, end - begin));
    });
    return words;
}

}  // namespace binosplat
