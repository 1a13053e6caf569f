// Pictures whose axes stay while the head turns, so that what an eye saw need not be resampled in every
// frame: the compositor resamples them anyway, and is told their poses and angles.
#pragma once

#include "engine/passes/warp_view.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// How far the view may turn to any side before the axes move: measured, docs/tried.md.
inline constexpr double kAxesMarginDegrees = 2.0;

// A picture from the same place that also covers what the view would show if it turned this far to any side,
// with the same pixels and additional whole tiles at each edge.
Eye coverOf(const Eye& view, double margin_rad);
// True if the picture, from the same place, shows all of the view.
bool covers(const Eye& picture, const Eye& view);
// The tiles of the picture that the view does not show, for FrameSettings. `hidden_in_view`: hidden tiles of
// the view; may be empty.
std::vector<std::uint8_t> hiddenFrom(const Eye& view, const Eye& picture,
                                     std::span<const std::uint8_t> hidden_in_view = {});

// From pixels of the view to those of the picture, from the same place.
glm::dmat3 pictureFromView(const Eye& picture, const Eye& view);

// The eyes' gazes in the pictures' axes instead of the views'.
std::array<std::optional<Gaze>, 2> turnGazes(std::array<std::optional<Gaze>, 2> gazes,
                                             std::span<const Eye> views, std::span<const Eye> pictures);

// The pictures of one or two eyes that turn as one, of equal sizes if the views have equal sizes. Their
// places follow the eyes in every frame. Their axes, angles and sizes stay until a picture no longer covers
// its view; then the axes move to those of the views or, while the head turns, ahead of them.
class StayingAxes {
public:
    explicit StayingAxes(double margin_rad) : margin_rad_(margin_rad) {}

    // Call this once for each frame. Valid until the next call.
    std::span<const Eye> follow(std::span<const Eye> views,
                                const std::array<std::span<const std::uint8_t>, 2>& hidden_in_views = {});
    // For the pictures, for FrameSettings.
    [[nodiscard]] std::array<std::span<const std::uint8_t>, 2> hiddenTiles() const {
        return {hidden_[0], hidden_[1]};
    }

private:
    [[nodiscard]] bool coverAll(std::span<const Eye> views) const;
    [[nodiscard]] bool isFarFrom(const Eye& view) const;
    void moveTo(std::span<const Eye> views);

    double margin_rad_;
    std::vector<Eye> pictures_, views_;  // of the last frame
    std::array<std::vector<std::uint8_t>, 2> hidden_;
};

}  // namespace binosplat
