// The letters of the panel.
#pragma once

#include "app/view/panel/formed_words.h"
#include "app/view/panel/shown_text.h"
#include "app/view/panel/unique_of.h"
#include "app/view/scenes/seen_scenes.h"

#include <imgui.h>

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

// Of a line. Capitals of DejaVu Sans are 0.63 times as high: half a degree, which is read at arm's length in any headset.
inline constexpr float kFontPx = 24.0f;

// Where the font may lie, the best place first: BINOSPLAT_FONT alone if it is set, else where the system keeps its own.
std::vector<std::filesystem::path> fontFiles();

// Whether the tables that a TrueType or OpenType font says it has, and those that are needed, lie within these bytes; of a collection, its
// first font.
bool looksLikeFont(std::span<const unsigned char> bytes);

// Where a picture lies in the font's texture.
struct PictureCorners {
    ImVec2 low, high;
};
using PicturePlaces = std::map<std::string, PictureCorners>;  // by ScenePicture::key

// The font of the current ImGui context, with the letters that are shown: Latin, Greek and Cyrillic from the beginning, others as names
// bring them along, boxes for what no font has; and the context's UserData, see asShown. Of these want() and take() are for the thread that
// draws, build() for any.
class PanelFont {
public:
    // Before the font is made a texture. Where there is no vector font, ImGui's own small one is taken.
    PanelFont();
    // Empty, or why ImGui's own font is used: one line.
    [[nodiscard]] const std::string& complaint() const { return complaint_; }
    // Between two frames. True: the text (UTF-8, as it is read) has letters or words, or there are pictures, that were never asked for,
    // which build() is to bring once. Until take() nothing more is wanted.
    [[nodiscard]] bool want(std::string_view text, const std::vector<ScenePicture>& pictures = {});
    // Makes a font of all that was wanted, reading files where there are more letters in them.
    void build();
    // After build(), between two frames: it is the font from now on, and must be made a texture.
    void take();

    // That are there, as of take().
    [[nodiscard]] const PicturePlaces& pictures() const { return places_; }

private:
    std::vector<LoadedFont> fonts_;  // the chosen one first, the system's once a letter is not in it; none: ImGui's own
    std::string complaint_;
    std::set<ImWchar> added_;  // beyond those of the beginning, whether a font has them or not
    std::set<std::u32string> words_;
    std::map<std::string, ScenePicture> pictures_;
    UniqueOf<ImFontAtlas, IM_DELETE<ImFontAtlas>> built_;
    PicturePlaces built_places_, places_;
    WordForms built_forms_, forms_;
    bool is_building_ = false;  // from want() on, until take(): then all but this is build()'s
};

}  // namespace binosplat
