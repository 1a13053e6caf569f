// ImGui's atlas of letters, made anew when there are more.
#include "app/view/panel/panel_font.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr ImWchar kBox = 0x25a1;
// Latin with all its marks (also those that stand alone, as some systems write names), Greek, Cyrillic, punctuation, currencies, the box,
// stars.
constexpr std::array<ImWchar, 17> kRanges{0x0020, 0x024f, 0x0300, 0x052f, 0x1e00, 0x1fff, 0x2010, 0x205e, 0x20a0,
                                          0x20bf, 0x2190, 0x2193, kBox,   kBox,   0x2605, 0x2606, 0};
// Fonts of all of Unicode take 20 MB.
constexpr std::size_t kMostFontBytes = std::size_t{64} << 20;
// With them the atlas stays below 4096x2048, which every device can sample.
constexpr std::size_t kMostAdded = 3000;
constexpr std::size_t kMostPictures = 48;

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

// Its bytes, or why there are none.
std::string readFont(const fs::path& file, std::string& complaint) {
    try {
        std::string bytes = readTextFile(file, "a TrueType font", kMostFontBytes);
        if (looksLikeFont({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()})) { return bytes; }
        complaint = fmt::format("{}: is no whole TrueType font", file.string());
    } catch (const Error& error) { complaint = error.what(); }
    return {};
}

// With the letters of the beginning and those added, each from the first font that has it. False, and an empty atlas: one is none.
// `add_pictures` asks for room for what else belongs there, `draw_pictures` draws it.
bool buildAtlas(ImFontAtlas& atlas, std::span<const LoadedFont> fonts, const std::set<ImWchar>& added,
                const std::function<void(ImFontAtlas&)>& add_pictures = {}, const std::function<void(ImFontAtlas&)>& draw_pictures = {}) {
    atlas.Clear();
    if (add_pictures) { add_pictures(atlas); }
    std::vector<ImWchar> ranges;
    for (const ImWchar letter : added) { ranges.insert(ranges.end(), {letter, letter}); }
    ranges.insert(ranges.end(), kRanges.begin(), kRanges.end());
    for (const auto& [font, bytes] : fonts) {
        ImFontConfig config;
        config.FontDataOwnedByAtlas = false;
        config.OversampleH = 2;  // a headset's pixels do not lie on the font's
        config.MergeMode = &bytes != &fonts.front().bytes;
        config.FontNo = font.number;
        atlas.AddFontFromMemoryTTF(const_cast<char*>(bytes.data()), static_cast<int>(bytes.size()), kFontPx, &config, ranges.data());
    }
    if (!atlas.Build()) {
        atlas.Clear();
        return false;
    }
    if (draw_pictures) { draw_pictures(atlas); }
    // The fonts' bytes are not asked for again, nor where what else is there lies.
    atlas.ClearInputData();
    atlas.Fonts[0]->FallbackChar = kBox;
    atlas.Fonts[0]->BuildLookupTable();
    return true;
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
    return has("cmap") && has("head") && has("hhea") && has("hmtx") && has("maxp") && ((has("glyf") && has("loca")) || has("CFF "));
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
}

bool PanelFont::want(std::string_view text, const std::vector<ScenePicture>& pictures) {
    if (is_building_ || fonts_.empty()) { return false; }
    std::set<ImWchar> brought;
    for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
        unsigned int letter = 0;
        at += std::max(ImTextCharFromUtf8(&letter, at, end), 1);
        const auto wanted = static_cast<ImWchar>(letter);
        const bool is_letter = letter <= IM_UNICODE_CODEPOINT_MAX && letter != IM_UNICODE_CODEPOINT_INVALID;
        const bool is_there = isThereFromTheBeginning(wanted) && ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(wanted) != nullptr;
        if (is_letter && !is_there) { brought.insert(wanted); }
    }
    const bool shows_new = std::ranges::any_of(pictures, [&](const ScenePicture& picture) { return !pictures_.contains(picture.key); });
    const bool says_new = brought.size() <= kMostAdded && !std::ranges::includes(added_, brought);
    if (!says_new && !shows_new) { return false; }
    if (!says_new) { brought.clear(); }
    if (shows_new && pictures_.size() + pictures.size() > kMostPictures) { pictures_.clear(); }
    for (const ScenePicture& picture : pictures) { pictures_.emplace(picture.key, picture); }
    if (added_.size() + brought.size() > kMostAdded) { added_.clear(); }
    added_.merge(brought);
    is_building_ = true;
    return true;
}

void PanelFont::build() {
    // They are large, and only now needed.
    std::vector<SystemFont> wanted = fontsWith({added_.begin(), added_.end()});
    if (wanted.empty() && fonts_.size() == 1) {
        for (const fs::path& file : furtherSystemFonts()) { wanted.push_back({file}); }
    }
    for (const SystemFont& font : wanted) {
        const bool is_there = std::ranges::any_of(
            fonts_, [&](const LoadedFont& loaded) { return loaded.font.file == font.file && loaded.font.number == font.number; });
        std::string complaint, bytes = is_there ? "" : readFont(font.file, complaint);
        if (!bytes.empty()) { fonts_.push_back({font, std::move(bytes)}); }
    }
    // ImGui counts allocations of the context, if there is one, for a window of its own that is never opened: nothing else is shared.
    built_.reset(IM_NEW(ImFontAtlas)());
    std::vector<std::pair<int, const ScenePicture*>> rects;
    const auto add_pictures = [&](ImFontAtlas& atlas) {
        rects.clear();
        for (const auto& [key, picture] : pictures_) {
            rects.emplace_back(atlas.AddCustomRectRegular(static_cast<int>(kScenePicturePx.x), static_cast<int>(kScenePicturePx.y)),
                               &picture);
        }
    };
    const auto draw_pictures = [&](ImFontAtlas& atlas) {
        // The letters' own texture, with colours.
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
        for (const auto& [id, picture] : rects) {
            const ImFontAtlasCustomRect& rect = *atlas.GetCustomRectByIndex(id);
            for (std::size_t y = 0; y < kScenePicturePx.y; ++y) {
                const auto row = picture->rgba.begin() + static_cast<std::ptrdiff_t>(4 * y * kScenePicturePx.x);
                std::copy_n(row, 4 * kScenePicturePx.x, pixels + 4 * ((rect.Y + y) * static_cast<std::size_t>(width) + rect.X));
            }
            PictureCorners& corners = built_places_[picture->key];
            atlas.CalcCustomRectUV(&rect, &corners.low, &corners.high);
        }
    };
    built_places_.clear();
    if (!buildAtlas(*built_, fonts_, added_, add_pictures, draw_pictures) &&
        !buildAtlas(*built_, std::span(fonts_).first(1), {}, add_pictures, draw_pictures)) {
        built_.reset();
    }
}

void PanelFont::take() {
    is_building_ = false;
    if (!built_) { return; }
    places_ = std::exchange(built_places_, {});
    // The context owns the one that it has.
    ImGuiIO& io = ImGui::GetIO();
    IM_DELETE(std::exchange(io.Fonts, built_.release()));
}

}  // namespace binosplat
