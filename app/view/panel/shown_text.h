// Text as the panel shows it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace binosplat {

// Private-use letters, which stand for glyphs that a font has formed: ImGui draws only letters.
inline constexpr char32_t kFirstPrivate = 0xe000, kLastPrivate = 0xf8ff;

// Words in scripts whose letters change with their neighbours, and the private letters that stand for them,
// from left to right.
using WordForms = std::map<std::u32string, std::u32string>;

// Any text as UTF-8 from left to right, as ImGui draws it: control characters and private letters become
// boxes, words of Hebrew and Arabic are reversed (Unicode's bidirectional algorithm, by FriBidi), and words
// for which the current ImGui context has forms (WordForms, its UserData) take these; in other words Arabic
// letters are at least joined.
std::string asShown(std::string_view text);
// Only replaces control characters by boxes.
std::string withoutControls(std::string_view text);
// The text's words in scripts that need forms.
std::set<std::u32string> wordsToForm(std::string_view text);

}  // namespace binosplat
