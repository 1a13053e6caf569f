// Draws a line with a handle between two scenes.
#include "app/desktop/curtain.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr double kReachPx = 8.0;
constexpr std::array<glm::ivec2, 2> kHandlePx{glm::ivec2(11, 57), glm::ivec2(7, 53)};
constexpr std::array<int, 2> kLinePx{5, 1};
constexpr std::array<std::array<float, 4>, 2> kInks{{{0.1f, 0.1f, 0.1f, 1.0f}, {0.95f, 0.95f, 0.95f, 1.0f}}};

OwnImage makeInk(const Context& context) {
    constexpr auto kUsage = vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc;
    return {context, "the curtain's line", {1, 1}, vk::Format::eR8G8B8A8Unorm, kUsage};
}

int lineIn(const EyePart& part, double share) {
    return static_cast<int>(std::lround(part.at_px.x + share * part.size_px.x));
}

}  // namespace

Curtain::Curtain(const Context& context, const FrameLog& log)
    : log_(log), inks_{makeInk(context), makeInk(context)} {}

double Curtain::shareAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px) {
    const EyePart part = partAt(parts, place_px).value_or(parts.front());
    return (place_px.x - part.at_px.x) / part.size_px.x;
}

bool Curtain::hold(bool is_held) {
    const bool is_away = stays_away_ != is_held;
    if (std::exchange(is_away_, is_away) == is_away) { return false; }
    return has_moved_ = true;
}

bool Curtain::takes(const DesktopEvent& event, const std::vector<EyePart>& parts) {
    using Kind = DesktopEvent::Kind;
    const std::optional<EyePart> part = partAt(parts, event.place_px);
    const bool is_at = !is_away_ && part && std::abs(event.place_px.x - lineIn(*part, share_)) <= kReachPx;
    if (event.kind == Kind::kMove) {
        is_pointed_at_ = is_at || is_dragged_;
        if (!is_dragged_) { return false; }
        share_ = std::clamp(shareAt(parts, event.place_px), 0.0, 1.0);
        return has_moved_ = true;
    }
    if (event.kind == Kind::kPress && event.isLeft() && is_at) { return is_dragged_ = true; }
    if (event.kind != Kind::kRelease || !is_dragged_) { return false; }
    is_dragged_ = false;
    log_.say(fmt::format("the curtain hangs at {:.0f} %", 100.0 * share_));
    return true;
}

void Curtain::compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts) const {
    using Layout = vk::ImageLayout;
    for (std::size_t i = 0; i < inks_.size(); ++i) {
        const vk::Image ink = *inks_[i].image;
        changeLayout(commands, ink, Layout::eUndefined, Layout::eTransferDstOptimal);
        commands.buffer().clearColorImage(
            ink, Layout::eTransferDstOptimal, vk::ClearColorValue(kInks[i]),
            vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
        changeLayout(commands, ink, Layout::eTransferDstOptimal, Layout::eTransferSrcOptimal);
        for (const EyePart& part : parts) {
            const glm::ivec2 low(part.at_px), high = low + glm::ivec2(part.size_px);
            const glm::ivec2 middle(lineIn(part, share_), (low.y + high.y) / 2);
            for (const glm::ivec2& size_px :
                 {glm::ivec2(kLinePx[i], static_cast<int>(part.size_px.y)), kHandlePx[i]}) {
                const glm::ivec2 from = glm::max(middle - size_px / 2, low),
                                 to = glm::min(middle - size_px / 2 + size_px, high);
                if (glm::any(glm::greaterThanEqual(from, to))) { continue; }
                // One after another: later ones are on top.
                changeLayout(commands, window, Layout::eTransferDstOptimal, Layout::eTransferDstOptimal);
                blitInto(commands, ink, {1, 1}, window, {from, to - from});
            }
        }
    }
}

}  // namespace binosplat
