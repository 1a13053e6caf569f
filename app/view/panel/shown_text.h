// Text as the panel shows it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace binosplat {

// Letters of nobody's script, which stand for signs that a font has formed: ImGui draws letters alone.
inline constexpr char32_t kFirstPrivate = 0xe000, kLastPrivate = 0xf8ff;

// Words of scripts in which letters change with those beside them, and the private letters that stand for them, from left to right.
using WordForms = std::map<std::u32string, std::u32string>;

// UTF-8 from left to right, as ImGui draws it, of text that may hold anything: control characters and private letters become boxes, words
// of Hebrew and Arabic are turned round (Unicode's bidirectional algorithm, by FriBidi), and words that the current ImGui context has forms
// of (WordForms, its UserData) take these; of others Arabic letters are joined at least.
std::string asShown(std::string_view text);
// Without control characters alone.
std::string withoutControls(std::string_view text);
// The words of such scripts.
std::set<std::u32string> wordsToForm(std::string_view text);

}  // namespace binosplat
