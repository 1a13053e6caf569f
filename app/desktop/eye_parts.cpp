// Stereo pictures in one window.
#include "app/desktop/eye_parts.h"

#include "app/view/panel/panel_style.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// The panel's size: in its own pixels, on a desktop without magnification; and at most this share of the
// window's width.
constexpr double kPanelScale = 0.7, kPanelShare = 0.6;

}  // namespace

bool isIn(const WindowPart& part, const glm::dvec2& place_px) {
    const glm::dvec2 low(part.at_px), high(part.at_px + part.size_px);
    return glm::all(glm::greaterThanEqual(place_px, low)) && glm::all(glm::lessThan(place_px, high));
}

bool showsTwoEyes(WindowStereo stereo) { return stereo != WindowStereo::kMono; }

std::vector<EyePart> partsOf(WindowStereo stereo, glm::uvec2 area_px) {
    const glm::uvec2 area = glm::max(area_px, glm::uvec2(2));
    const glm::uvec2 beside(area.x / 2, area.y), above(area.x, area.y / 2), none(0, 0);
    switch (stereo) {
        case WindowStereo::kMono:
            return {{kLeft, none, area}};
        case WindowStereo::kSideBySide:
            return {{kLeft, none, beside}, {kRight, {beside.x, 0}, beside}};
        case WindowStereo::kCrossEyed:
            return {{kRight, none, beside}, {kLeft, {beside.x, 0}, beside}};
        case WindowStereo::kTopBottom:
            return {{kLeft, none, above}, {kRight, {0, above.y}, above}};
        case WindowStereo::kAnaglyph:
            break;
    }
    return {{kRight, none, area}};  // its image has the other one's red
}

std::optional<EyePart> partAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px) {
    const auto found = std::ranges::find_if(parts, [&](const EyePart& part) {
        return isIn({glm::ivec2(part.at_px), glm::ivec2(part.size_px)}, place_px);
    });
    return found == parts.end() ? std::nullopt : std::optional(*found);
}

WindowLayout layOutWindow(glm::uvec2 size_px, double scale, const ViewSettings& settings, double angle_rad) {
    WindowLayout layout;
    if (settings.panel) {
        const glm::dvec2 size(size_px), panel(kPanelPx);
        const double shown =
            std::min({scale * kPanelScale, size.y / panel.y, kPanelShare * size.x / panel.x});
        layout.panel.size_px = glm::max(glm::ivec2(shown * panel), glm::ivec2(1));
        layout.panel.at_px.x = static_cast<int>(size.x) - layout.panel.size_px.x;
    }
    layout.area_px = {size_px.x - static_cast<unsigned>(layout.panel.size_px.x), size_px.y};
    layout.parts = partsOf(settings.window_stereo, layout.area_px);
    layout.sight = {settings.window_stereo, settings.window_eyes, settings.window_plane, angle_rad};
    return layout;
}

std::vector<Eye> eyesOf(const OrbitCamera& camera, const WindowSight& sight, glm::uvec2 size_px) {
    const double focal_px = 0.5 * std::max(size_px.x, size_px.y) / std::tan(0.5 * sight.angle_rad);
    const Eye middle{camera.pose(), {focal_px, focal_px, 0.5 * size_px.x, 0.5 * size_px.y}, size_px};
    if (!showsTwoEyes(sight.stereo)) { return {middle}; }
    const double plane = sight.plane * camera.distance();
    const std::array<Eye, 2> pair = stereoPair(middle, sight.eye_distance * plane);
    std::vector<Eye> eyes(pair.begin(), pair.end());
    const double shift_px = 0.5 * focal_px * sight.eye_distance;
    eyes[kLeft].intrinsics.cx -= shift_px;
    eyes[kRight].intrinsics.cx += shift_px;
    return eyes;
}

WindowPart quarterOf(glm::uvec2 size_px, int quarter) {
    const glm::uvec2 which(quarter % 2, quarter / 2), low = which * size_px / 2u,
                                                      high = (which + 1u) * size_px / 2u;
    return {glm::ivec2(low), glm::ivec2(high - low)};
}

Eye quarterOf(const Eye& whole, glm::uvec2 part_px, int quarter, double samples) {
    const WindowPart part = quarterOf(part_px, quarter);
    Eye eye = whole;
    eye.size_px = glm::max(glm::uvec2(glm::round(samples * glm::dvec2(part.size_px))), glm::uvec2(16));
    const glm::dvec2 scale = glm::dvec2(eye.size_px) / glm::dvec2(part.size_px),
                     own = scale * glm::dvec2(part_px) / glm::dvec2(whole.size_px);
    eye.intrinsics.fx *= own.x;
    eye.intrinsics.fy *= own.y;
    eye.intrinsics.cx = own.x * eye.intrinsics.cx - scale.x * part.at_px.x;
    eye.intrinsics.cy = own.y * eye.intrinsics.cy - scale.y * part.at_px.y;
    return eye;
}

glm::dvec3 pointAt(const Eye& eye, const glm::dvec2& place_px, double depth) {
    const Intrinsics& lens = eye.intrinsics;
    return transform(eye.world_from_camera, depth * glm::dvec3((place_px.x - lens.cx) / lens.fx,
                                                               (place_px.y - lens.cy) / lens.fy, 1.0));
}

}  // namespace binosplat
