// ImGui's atlas of letters, rebuilt when there are more.
#include "app/view/panel/panel_font.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr ImWchar kBox = 0x25a1;
// Latin with all its marks (also combining ones, which some systems use in names), Greek, Cyrillic,
// punctuation, currencies, the box, stars.
constexpr std::array<ImWchar, 17> kRanges{0x0020, 0x024f, 0x0300, 0x052f, 0x1e00, 0x1fff,
                                          0x2010, 0x205e, 0x20a0, 0x20bf, 0x2190, 0x2193,
                                          kBox,   kBox,   0x2605, 0x2606, 0};
// Fonts with all of Unicode take 20 MB.
constexpr std::size_t kMostFontBytes = std::size_t{64} << 20;
// With these limits they fit into kLettersPx.
constexpr std::size_t kMostAdded = 1200, kMostGlyphs = 600;
constexpr std::size_t kMostPictures = 48, kMostWords = 400;

bool isThereFromTheBeginning(ImWchar letter) {
    for (std::size_t i = 0; kRanges[i] != 0; i += 2) {
        if (letter >= kRanges[i] && letter <= kRanges[i + 1]) { return true; }
    }
    return letter < kRanges[0];
}

std::uint64_t numberAt(std::span<const unsigned char> bytes, std::size_t at, std::size_t length) {
    std::uint64_t number = 0;
    for (const unsigned char byte : bytes.subspan(at, length)) { number = number * 256 + byte; }
    return number;
}

// A font's bytes, or why there are none.
std::string readFont(const fs::path& file, std::string& complaint) {
    try {
        std::string bytes = readTextFile(file, "a TrueType font", kMostFontBytes);
        if (looksLikeFont({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()})) {
            return bytes;
        }
        complaint = fmt::format("{}: is not a whole TrueType font", file.string());
    } catch (const Error& error) { complaint = error.what(); }
    return {};
}

// A picture in the atlas besides the letters.
struct AtlasPicture {
    glm::uvec2 size_px;
    std::vector<unsigned char> rgba;
    // Takes the corners, in shares of the texture.
    std::function<void(ImFont& font, const ImVec2& low, const ImVec2& high)> use;
};

void drawPictures(ImFontAtlas& atlas, std::span<const AtlasPicture> pictures, int first_rect) {
    if (pictures.empty()) { return; }
    // The letters' own texture, with colours.
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    for (const AtlasPicture& picture : pictures) {
        const ImFontAtlasCustomRect& rect = *atlas.GetCustomRectByIndex(first_rect++);
        const std::size_t bytes = 4 * std::size_t{picture.size_px.x};
        for (std::size_t y = 0; y < picture.size_px.y; ++y) {
            std::copy_n(picture.rgba.data() + y * bytes, bytes,
                        pixels + 4 * ((rect.Y + y) * static_cast<std::size_t>(width) + rect.X));
        }
        ImVec2 low, high;
        atlas.CalcCustomRectUV(&rect, &low, &high);
        picture.use(*atlas.Fonts[0], low, high);
    }
}

// As large as kLettersPx. ImGui chooses the height by what is in it: a column one texel wide.
void fixSize(ImFontAtlas& atlas) {
    atlas.TexDesiredWidth = static_cast<int>(kLettersPx.x);
    atlas.AddCustomRectRegular(1, static_cast<int>(kLettersPx.y) - 2 * atlas.TexGlyphPadding);
}

// With the initial letters and those added, each from the first font that has it. False, and an empty atlas,
// if one is not a font, or if there are too many.
bool buildAtlas(ImFontAtlas& atlas, std::span<const LoadedFont> fonts, const std::set<ImWchar>& added,
                std::span<const AtlasPicture> pictures = {}) {
    atlas.Clear();
    const int first_rect = atlas.CustomRects.Size;
    for (const AtlasPicture& picture : pictures) {
        atlas.AddCustomRectRegular(static_cast<int>(picture.size_px.x), static_cast<int>(picture.size_px.y));
    }
    std::vector<ImWchar> ranges;
    for (const ImWchar letter : added) { ranges.insert(ranges.end(), {letter, letter}); }
    ranges.insert(ranges.end(), kRanges.begin(), kRanges.end());
    for (const auto& [font, bytes] : fonts) {
        ImFontConfig config;
        config.FontDataOwnedByAtlas = false;
        config.OversampleH = 2;  // a headset's pixels do not lie on the font's
        config.MergeMode = &bytes != &fonts.front().bytes;
        config.FontNo = font.number;
        atlas.AddFontFromMemoryTTF(const_cast<char*>(bytes.data()), static_cast<int>(bytes.size()), kFontPx,
                                   &config, ranges.data());
    }
    fixSize(atlas);
    if (!atlas.Build() || atlas.TexHeight != static_cast<int>(kLettersPx.y)) {
        atlas.Clear();
        return false;
    }
    drawPictures(atlas, pictures, first_rect);
    // Neither the fonts' bytes nor the pictures' places are needed again.
    atlas.ClearInputData();
    atlas.Fonts[0]->FallbackChar = kBox;
    atlas.Fonts[0]->BuildLookupTable();
    return true;
}

AtlasPicture pictureOf(const ScenePicture& scene, PicturePlaces& places) {
    return {kScenePicturePx, scene.rgba, [&scene, &places](ImFont&, const ImVec2& low, const ImVec2& high) {
                places[scene.key] = {low, high};
            }};
}

AtlasPicture pictureOf(const FormedGlyph& sign, ImWchar letter) {
    const glm::uvec2 size_px = glm::max(sign.size_px, 1u);  // a blank has none
    std::vector<unsigned char> rgba(std::size_t{4} * size_px.x * size_px.y, 255);
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
        rgba[4 * i + 3] = i < sign.coverage.size() ? sign.coverage[i] : 0;
    }
    return {size_px, std::move(rgba), [&sign, letter](ImFont& font, const ImVec2& low, const ImVec2& high) {
                const glm::vec2 at = sign.low_px + glm::vec2(0.0f, std::round(font.Ascent)),
                                end = at + glm::vec2(sign.size_px) * glm::vec2(0.5f, 1.0f);
                font.AddGlyph(nullptr, letter, at.x, at.y, end.x, end.y, low.x, low.y, high.x, high.y,
                              sign.advance_px);
            }};
}

}  // namespace

std::vector<fs::path> fontFiles() {
    if (const std::string chosen = environment("BINOSPLAT_FONT"); !chosen.empty()) { return {chosen}; }
    return systemFonts();
}

bool looksLikeFont(std::span<const unsigned char> bytes) {
    constexpr std::size_t kHeader = 12, kRecord = 16, kFirstOfCollection = 12;
    std::size_t header = 0;
    if (bytes.size() >= kFirstOfCollection + 4 && numberAt(bytes, 0, 4) == 0x74746366) {  // ttcf
        const std::uint64_t version = numberAt(bytes, 4, 4);
        if ((version != 0x00010000 && version != 0x00020000) || numberAt(bytes, 8, 4) == 0) { return false; }
        header = numberAt(bytes, kFirstOfCollection, 4);
    }
    if (bytes.size() < header + kHeader) { return false; }
    const std::uint64_t kind = numberAt(bytes, header, 4);
    if (kind != 0x00010000 && kind != 0x4f54544f && kind != 0x74727565) { return false; }  // 1.0, OTTO, true
    const std::size_t first = header + kHeader, tables = numberAt(bytes, header + 4, 2);
    if (bytes.size() < first + tables * kRecord) { return false; }
    std::vector<std::string_view> names;
    for (std::size_t at = first; at < first + tables * kRecord; at += kRecord) {
        const std::uint64_t offset = numberAt(bytes, at + 8, 4), length = numberAt(bytes, at + 12, 4);
        if (offset > bytes.size() || length > bytes.size() - offset) { return false; }
        names.emplace_back(reinterpret_cast<const char*>(bytes.data()) + at, 4);
    }
    const auto has = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
    return has("cmap") && has("head") && has("hhea") && has("hmtx") && has("maxp") &&
           ((has("glyf") && has("loca")) || has("CFF "));
}

PanelFont::PanelFont() {
    for (const fs::path& file : fontFiles()) {
        fonts_ = {{{file}, readFont(file, complaint_)}};
        if (!fonts_[0].bytes.empty() && buildAtlas(*ImGui::GetIO().Fonts, fonts_, {})) {
            complaint_.clear();
            return;
        }
    }
    fonts_.clear();
    complaint_ = fmt::format("the panel is written in a small built-in font: {}", complaint_);
    ImFontConfig font;
    font.SizePixels = kFontPx;
    ImGui::GetIO().Fonts->AddFontDefault(&font);
    fixSize(*ImGui::GetIO().Fonts);
}

bool PanelFont::want(std::string_view text, const std::vector<ScenePicture>& pictures) {
    if (is_building_ || fonts_.empty()) { return false; }
    std::set<ImWchar> brought;
    const std::string shown = asShown(text);
    for (const char *at = shown.data(), *const end = at + shown.size(); at < end;) {
        unsigned int letter = 0;
        at += std::max(ImTextCharFromUtf8(&letter, at, end), 1);
        const auto wanted = static_cast<ImWchar>(letter);
        const bool is_letter =
            letter != IM_UNICODE_CODEPOINT_INVALID && (letter < kFirstPrivate || letter > kLastPrivate);
        const bool is_there = isThereFromTheBeginning(wanted) &&
                              ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(wanted) != nullptr;
        if (is_letter && !is_there) { brought.insert(wanted); }
    }
    std::set<std::u32string> words = wordsToForm(text);
    const bool shows_new = std::ranges::any_of(
        pictures, [&](const ScenePicture& picture) { return !pictures_.contains(picture.key); });
    const bool says_new = brought.size() <= kMostAdded && words.size() <= kMostWords &&
                          (!std::ranges::includes(added_, brought) || !std::ranges::includes(words_, words));
    if (!says_new && !shows_new) { return false; }
    if (!says_new) {
        brought.clear();
        words.clear();
    }
    if (shows_new && pictures_.size() + pictures.size() > kMostPictures) { pictures_.clear(); }
    std::erase_if(pictures_, [&](const auto& kept) {
        return std::ranges::any_of(pictures, [&](const ScenePicture& later) {
            return later.file == kept.second.file && later.key != kept.first;
        });
    });
    for (const ScenePicture& picture : pictures) { pictures_.emplace(picture.key, picture); }
    if (added_.size() + brought.size() > kMostAdded) { added_.clear(); }
    if (words_.size() + words.size() > kMostWords) { words_.clear(); }
    added_.merge(brought);
    words_.merge(words);
    is_building_ = true;
    return true;
}

void PanelFont::build() {
    // Fonts are large, and only needed now.
    std::set<std::uint32_t> letters(added_.begin(), added_.end());
    for (const std::u32string& word : words_) { letters.insert(word.begin(), word.end()); }
    std::vector<SystemFont> wanted = fontsWith(letters);
    if (wanted.empty() && fonts_.size() == 1) {
        for (const fs::path& file : furtherSystemFonts()) { wanted.push_back({file}); }
    }
    for (const SystemFont& font : wanted) {
        const bool is_there = std::ranges::any_of(fonts_, [&](const LoadedFont& loaded) {
            return loaded.font.file == font.file && loaded.font.number == font.number;
        });
        std::string complaint, bytes = is_there ? "" : readFont(font.file, complaint);
        if (!bytes.empty()) { fonts_.push_back({font, std::move(bytes)}); }
    }
    built_places_.clear();
    built_forms_.clear();
    std::vector<AtlasPicture> pictures;
    for (const auto& [key, picture] : pictures_) { pictures.push_back(pictureOf(picture, built_places_)); }
    const std::size_t scenes = pictures.size();
    const FormedWords formed = formWords(words_, fonts_, kFontPx, kMostGlyphs);
    for (const FormedGlyph& sign : formed.signs) {
        pictures.push_back(pictureOf(sign, static_cast<ImWchar>(kFirstPrivate + pictures.size() - scenes)));
    }
    // ImGui counts allocations of the context, if there is one, for a window of its own that is never opened:
    // nothing else is shared.
    built_.reset(IM_NEW(ImFontAtlas)());
    if (buildAtlas(*built_, fonts_, added_, pictures)) {
        for (const auto& [word, signs] : formed.words) {
            for (const std::size_t sign : signs) {
                built_forms_[word] += static_cast<char32_t>(kFirstPrivate + sign);
            }
        }
    } else if (!buildAtlas(*built_, std::span(fonts_).first(1), {}, std::span(pictures).first(scenes))) {
        built_.reset();
    }
}

void PanelFont::take() {
    is_building_ = false;
    if (!built_) { return; }
    places_ = std::exchange(built_places_, {});
    forms_ = std::exchange(built_forms_, {});
    // The context owns its current atlas.
    ImGuiIO& io = ImGui::GetIO();
    IM_DELETE(std::exchange(io.Fonts, built_.release()));
    io.UserData = &forms_;
}

}  // namespace binosplat
