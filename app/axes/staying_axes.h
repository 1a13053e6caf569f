// Pictures whose axes stay while the head turns, so that what an eye saw need not be resampled in every frame: whoever shows them resamples
// them anyway, and is told their poses and angles.
#pragma once

#include "engine/passes/warp_view.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// How far the view may turn to any side until the axes move: measured, docs/tried.md.
inline constexpr double kAxesMarginDegrees = 2.0;

// A picture from the same place that also covers what the view would show if it turned this far to any side, with the same pixels and
// whole tiles more at each edge.
Eye coverOf(const Eye& view, double margin_rad);
// True if the picture, from the same place, shows all of the view.
bool covers(const Eye& picture, const Eye& view);
// The tiles of the picture that the view does not show, as of FrameSettings. `hidden_in_view`: tiles of the view that nobody sees; may be
// empty.
std::vector<std::uint8_t> hiddenFrom(const Eye& view, const Eye& picture, std::span<const std::uint8_t> hidden_in_view = {});

// From pixels of the view to those of the picture, from the same place.
glm::dmat3 pictureFromView(const Eye& picture, const Eye& view);

// Where the eyes look, in the pictures' axes instead of the views'.
std::array<std::optional<Gaze>, 2> turnGazes(std::array<std::optional<Gaze>, 2> gazes, std::span<const Eye> views,
                                             std::span<const Eye> pictures);

// The pictures of one or two eyes that turn as one, of equal sizes if the views have these. Their places follow the eyes in every frame;
// their axes, angles and sizes stay until a picture does not cover its view any more. Then the axes move to those of the views, or, while
// the head turns, ahead of them.
class StayingAxes {
public:
    explicit StayingAxes(double margin_rad) : margin_rad_(margin_rad) {}

    // To be called once for each frame. Valid until the next.
    std::span<const Eye> follow(std::span<const Eye> views, const std::array<std::span<const std::uint8_t>, 2>& hidden_in_views = {});
    // Of the pictures, for FrameSettings.
    [[nodiscard]] std::array<std::span<const std::uint8_t>, 2> hiddenTiles() const { return {hidden_[0], hidden_[1]}; }

private:
    [[nodiscard]] bool coverAll(std::span<const Eye> views) const;
    [[nodiscard]] bool isFarFrom(const Eye& view) const;
    void moveTo(std::span<const Eye> views);

    double margin_rad_;
    std::vector<Eye> pictures_, views_;  // of the last frame
    std::array<std::vector<std::uint8_t>, 2> hidden_;
};

}  // namespace binosplat
