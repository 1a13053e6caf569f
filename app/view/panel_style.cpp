// ImGui's style and font.
#include "app/view/panel_style.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr ImWchar kBox = 0x25a1;
// Latin with all its marks (also those that stand alone, as some systems write names), Greek, Cyrillic, punctuation, currencies, the box.
constexpr std::array<ImWchar, 15> kRanges{0x0020, 0x024f, 0x0300, 0x052f, 0x1e00, 0x1fff, 0x2010, 0x205e,
                                          0x20a0, 0x20bf, 0x2190, 0x2193, kBox,   kBox,   0};

std::uint64_t numberAt(std::span<const unsigned char> bytes, std::size_t at, std::size_t length) {
    std::uint64_t number = 0;
    for (const unsigned char byte : bytes.subspan(at, length)) { number = number * 256 + byte; }
    return number;
}

// Its bytes, or why there are none.
std::string readFont(const fs::path& file, std::string& complaint) {
    try {
        std::string bytes = readTextFile(file, "a TrueType font", kMostRecordingBytes);
        if (looksLikeFont({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()})) { return bytes; }
        complaint = fmt::format("{}: is no whole TrueType font", file.string());
    } catch (const Error& error) { complaint = error.what(); }
    return {};
}

bool addVectorFont(const std::string& bytes) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;  // a headset's pixels do not lie on the font's
    std::string copy = bytes;
    ImFont* font = fonts.AddFontFromMemoryTTF(copy.data(), static_cast<int>(copy.size()), kFontPx, &config, kRanges.data());
    if (font == nullptr || !fonts.Build()) {
        fonts.Clear();
        return false;
    }
    // The font's bytes are not asked for again.
    fonts.ClearInputData();
    font->FallbackChar = kBox;
    font->BuildLookupTable();
    return true;
}

}  // namespace

std::vector<fs::path> fontFiles() {
    if (const std::string chosen = environment("BINOSPLAT_FONT"); !chosen.empty()) { return {chosen}; }
    std::vector<fs::path> files;
    for (const char* folder : {"truetype/dejavu", "TTF", "dejavu-sans-fonts", "dejavu"}) {
        files.push_back(fs::path("/usr/share/fonts") / folder / "DejaVuSans.ttf");
    }
    return files;
}

bool looksLikeFont(std::span<const unsigned char> bytes) {
    constexpr std::size_t kHeader = 12, kRecord = 16;
    if (bytes.size() < kHeader) { return false; }
    const std::uint64_t kind = numberAt(bytes, 0, 4);
    if (kind != 0x00010000 && kind != 0x4f54544f && kind != 0x74727565) { return false; }  // 1.0, OTTO, true
    const std::size_t tables = numberAt(bytes, 4, 2);
    if (bytes.size() < kHeader + tables * kRecord) { return false; }
    std::vector<std::string_view> names;
    for (std::size_t at = kHeader; at < kHeader + tables * kRecord; at += kRecord) {
        const std::uint64_t offset = numberAt(bytes, at + 8, 4), length = numberAt(bytes, at + 12, 4);
        if (offset > bytes.size() || length > bytes.size() - offset) { return false; }
        names.emplace_back(reinterpret_cast<const char*>(bytes.data()) + at, 4);
    }
    const auto has = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
    return has("cmap") && has("head") && has("hhea") && has("hmtx") && has("maxp") && ((has("glyf") && has("loca")) || has("CFF "));
}

std::string stylePanel() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.ScaleAllSizes(1.6f);  // a ray points less finely than a mouse
    style.WindowRounding = 0.0f;
    style.Colors[ImGuiCol_WindowBg].w = 1.0f;
    std::string complaint;
    for (const fs::path& file : fontFiles()) {
        const std::string bytes = readFont(file, complaint);
        if (!bytes.empty() && addVectorFont(bytes)) { return {}; }
    }
    ImFontConfig font;
    font.SizePixels = kFontPx;
    ImGui::GetIO().Fonts->AddFontDefault(&font);
    return fmt::format("the panel is written in a small built-in font: {}", complaint);
}

}  // namespace binosplat
