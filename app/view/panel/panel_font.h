// The letters of the panel.
#pragma once

#include "app/view/panel/formed_words.h"
#include "app/view/panel/shown_text.h"
#include "app/view/panel/unique_of.h"
#include "app/view/scenes/seen_scenes.h"

#include <imgui.h>
#include <glm/glm.hpp>

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

// Height of a line. Capitals of DejaVu Sans are 0.63 times as high: half a degree, legible at arm's length in
// any headset.
inline constexpr float kFontPx = 24.0f;
// Of the font's texture, however many letters there are: new ones come into the one that there is.
inline constexpr glm::uvec2 kLettersPx(2048, 2048);

// Candidate font files, the best first: only BINOSPLAT_FONT if it is set, otherwise the system's fonts.
std::vector<std::filesystem::path> fontFiles();

// True if the tables listed by a TrueType or OpenType font include all that are needed and lie within these
// bytes; for a collection, this is about its first font.
bool looksLikeFont(std::span<const unsigned char> bytes);

// Where a picture is in the font's texture.
struct PictureCorners {
    ImVec2 low, high;
};
using PicturePlaces = std::map<std::string, PictureCorners>;  // by ScenePicture::key

// The font of the current ImGui context, with the letters that are shown: Latin, Greek and Cyrillic from the
// start, others as names need them, boxes for letters that none of the fonts has. It also sets the context's
// UserData; see asShown. want() and take() are for the drawing thread, build() for any thread.
class PanelFont {
public:
    // Before the font is made into a texture. If there is no vector font, ImGui's own small one is used.
    PanelFont();
    // Empty, or why ImGui's own font is used: one line.
    [[nodiscard]] const std::string& complaint() const { return complaint_; }
    // Between two frames. Returns true if the text (UTF-8, in reading order) has new letters or words, or if
    // there are new pictures; then call build() once. Nothing more is accepted until take().
    [[nodiscard]] bool want(std::string_view text, const std::vector<ScenePicture>& pictures = {});
    // Makes a font with everything that was wanted, reading font files for further letters.
    void build();
    // What it has made; null: nothing better than the current one.
    [[nodiscard]] ImFontAtlas* built() const { return built_.get(); }
    // After build(), between two frames: switches to the new font, which must then be copied to the texture.
    void take();

    // The pictures of the current font.
    [[nodiscard]] const PicturePlaces& pictures() const { return places_; }

private:
    // The chosen one first, then the system's once it lacks a letter; none: ImGui's own.
    std::vector<LoadedFont> fonts_;
    std::string complaint_;
    std::set<ImWchar> added_;  // in addition to the initial ones, whether or not a font has them
    std::set<std::u32string> words_;
    std::map<std::string, ScenePicture> pictures_;
    UniqueOf<ImFontAtlas, IM_DELETE<ImFontAtlas>> built_;
    PicturePlaces built_places_, places_;
    WordForms built_forms_, forms_;
    bool is_building_ = false;  // from want() until take(): meanwhile all other members are build()'s
};

}  // namespace binosplat
