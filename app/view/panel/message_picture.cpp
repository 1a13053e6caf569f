// Copies letters from the font's texture.
#include "app/view/panel/message_picture.h"

#include "app/view/panel/panel_font.h"
#include "app/view/panel/shown_text.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace binosplat {

namespace {

constexpr float kLineStepPx = 28.0f, kMarginPx = 16.0f, kDrawingPx = 92.0f;
constexpr double kPlateAlpha = 0.75, kRoundPx = 14.0;

// How much of a pixel letters cover, for places between the texture's pixels.
class Letters {
public:
    Letters() {
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels_, &width, &height);
        size_px_ = {width, height};
    }

    void write(const char* begin, const char* end, ImVec2 at, std::vector<float>& coverage) const {
        const ImFont& font = *ImGui::GetIO().Fonts->Fonts[0];
        while (begin < end) {
            unsigned int letter = 0;
            begin += std::max(ImTextCharFromUtf8(&letter, begin, end), 1);
            const ImFontGlyph* const glyph = font.FindGlyph(static_cast<ImWchar>(letter));
            if (glyph == nullptr) { continue; }
            if (glyph->Visible != 0) { write(*glyph, at, coverage); }
            at.x += glyph->AdvanceX;
        }
    }

private:
    void write(const ImFontGlyph& glyph, const ImVec2& at, std::vector<float>& coverage) const {
        const glm::vec2 low(at.x + glyph.X0, at.y + glyph.Y0), high(at.x + glyph.X1, at.y + glyph.Y1);
        const glm::ivec2 first = glm::max(glm::ivec2(glm::floor(low)), glm::ivec2(0));
        const glm::ivec2 last = glm::min(glm::ivec2(glm::ceil(high)), glm::ivec2(kMessagePx));
        for (int y = first.y; y < last.y; ++y) {
            for (int x = first.x; x < last.x; ++x) {
                const glm::vec2 share = (glm::vec2(glm::ivec2(x, y)) + 0.5f - low) / (high - low);
                if (glm::any(glm::lessThan(share, glm::vec2(0.0f))) ||
                    glm::any(glm::greaterThan(share, glm::vec2(1.0f)))) {
                    continue;
                }
                const glm::vec2 place =
                    glm::mix(glm::vec2(glyph.U0, glyph.V0), glm::vec2(glyph.U1, glyph.V1), share) *
                    glm::vec2(size_px_);
                float& pixel =
                    coverage[static_cast<std::size_t>(y) * kMessagePx.x + static_cast<std::size_t>(x)];
                pixel = std::max(pixel, sample(place - 0.5f));
            }
        }
    }
    [[nodiscard]] float sample(const glm::vec2& place) const {
        const glm::ivec2 low(glm::floor(place));
        const glm::vec2 t = place - glm::vec2(low);
        const auto at = [&](int dx, int dy) {
            const glm::ivec2 p = glm::clamp(low + glm::ivec2(dx, dy), glm::ivec2(0), size_px_ - 1);
            return static_cast<float>(
                       pixels_[4 * (static_cast<std::size_t>(p.y) * static_cast<std::size_t>(size_px_.x) +
                                    static_cast<std::size_t>(p.x)) +
                               3]) /
                   255.0f;
        };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), t.x), glm::mix(at(0, 1), at(1, 1), t.x), t.y);
    }

    unsigned char* pixels_ = nullptr;
    glm::ivec2 size_px_{0};
};

// Breaks lines at blanks; what does not fit into two lines is dropped.
std::vector<std::string> linesOf(const std::string& shown, float width_px) {
    const ImFont& font = *ImGui::GetIO().Fonts->Fonts[0];
    std::vector<std::string> lines;
    for (const char *at = shown.data(), *const end = at + shown.size(); at < end && lines.size() < 2;) {
        const char* wrap = std::max(font.CalcWordWrapPositionA(1.0f, at, end, width_px), at + 1);
        lines.emplace_back(at, wrap);
        for (at = wrap; at < end && *at == ' ';) { ++at; }
    }
    return lines;
}

// How much a plate with round corners covers a place, given relative to the plate's middle.
double plateAt(const glm::dvec2& place, const glm::dvec2& half) {
    const glm::dvec2 beyond = glm::max(glm::abs(place) - half + kRoundPx, glm::dvec2(0.0));
    return std::clamp(kRoundPx + 0.5 - glm::length(beyond), 0.0, 1.0);
}

}  // namespace

TexelPicture drawMessage(std::string_view message, const TexelLayout& layout, const Drawing& drawing) {
    const auto width = static_cast<float>(kMessagePx.x), height = static_cast<float>(kMessagePx.y);
    const float beside_px = drawing ? kDrawingPx + kMarginPx : 0.0f;
    const ImFont& font = *ImGui::GetIO().Fonts->Fonts[0];
    const std::vector<std::string> lines = linesOf(asShown(message), width - 2.0f * kMarginPx - beside_px);
    const auto longOf = [&](const std::string& line) {
        return font.CalcTextSizeA(font.FontSize, width, 0.0f, line.data(), line.data() + line.size()).x;
    };
    float widest = 0.0f;
    for (const std::string& line : lines) { widest = std::max(widest, longOf(line)); }
    const float begin = std::round(0.5f * (width - widest - beside_px)),
                high = kLineStepPx * static_cast<float>(lines.size());
    std::vector<float> coverage(std::size_t{kMessagePx.x} * kMessagePx.y, 0.0f);
    const Letters letters;
    float y = 0.5f * (height - high) + 0.5f * (kLineStepPx - font.FontSize);
    for (const std::string& line : lines) {
        const float x = drawing ? begin + beside_px : std::round(0.5f * (width - longOf(line)));
        letters.write(line.data(), line.data() + line.size(), {x, std::round(y)}, coverage);
        y += kLineStepPx;
    }
    const float plate_width = std::min(widest + beside_px + 2.0f * kMarginPx, width);
    const float plate_height = std::min(drawing ? height : high + kMarginPx, height);
    const glm::dvec2 half =
        0.5 * glm::dvec2(static_cast<double>(plate_width), static_cast<double>(plate_height));
    TexelPicture picture{kMessagePx, std::vector<std::uint32_t>(coverage.size())};
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        const glm::dvec2 place(static_cast<double>(i % kMessagePx.x) + 0.5,
                               static_cast<double>(i / kMessagePx.x) + 0.5);
        const double plate = kPlateAlpha * plateAt(place - 0.5 * glm::dvec2(kMessagePx), half);
        const glm::dvec2 middle(static_cast<double>(begin + 0.5f * kDrawingPx),
                                0.5 * static_cast<double>(height));
        const glm::dvec2 in_square = (place - middle) / (0.5 * static_cast<double>(kDrawingPx));
        const bool is_drawn = drawing && std::max(std::abs(in_square.x), std::abs(in_square.y)) <= 1.0;
        const DrawnPoint ink =
            is_drawn ? drawing(in_square) : DrawnPoint{glm::dvec3(1.0), static_cast<double>(coverage[i])};
        const double alpha = ink.alpha + (1.0 - ink.alpha) * plate;
        picture.texels[i] =
            texelOf(alpha > 0.0 ? ink.alpha / alpha * ink.light : glm::dvec3(0.0), alpha, layout);
    }
    return picture;
}

}  // namespace binosplat
