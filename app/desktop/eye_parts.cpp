// Stereo pictures in one window.
#include "app/desktop/eye_parts.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

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
        const glm::dvec2 low(part.at_px), high(part.at_px + part.size_px);
        return glm::all(glm::greaterThanEqual(place_px, low)) && glm::all(glm::lessThan(place_px, high));
    });
    return found == parts.end() ? std::nullopt : std::optional(*found);
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

glm::dvec3 pointAt(const Eye& eye, const glm::dvec2& place_px, double depth) {
    const Intrinsics& lens = eye.intrinsics;
    return transform(eye.world_from_camera, depth * glm::dvec3((place_px.x - lens.cx) / lens.fx,
                                                               (place_px.y - lens.cy) / lens.fy, 1.0));
}

}  // namespace binosplat
