// Where each eye's picture is in a window, and what it sees.
#pragma once

#include "app/desktop/orbit_camera.h"
#include "app/view/settings/view_settings.h"
#include "app/view/window/window_drawing.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace binosplat {

// A part of the window, from its top left corner.
struct EyePart {
    int eye = kLeft;
    glm::uvec2 at_px{0, 0}, size_px{0, 0};
};

[[nodiscard]] bool isIn(const WindowPart& part, const glm::dvec2& place_px);
[[nodiscard]] bool showsTwoEyes(WindowStereo stereo);
// Parts of equal size that fill an area; one part for an anaglyph.
std::vector<EyePart> partsOf(WindowStereo stereo, glm::uvec2 area_px);
// The part that contains a pixel of the area, if any.
std::optional<EyePart> partAt(const std::vector<EyePart>& parts, const glm::dvec2& place_px);

// How the eyes look at the scene.
struct WindowSight {
    WindowStereo stereo = WindowStereo::kMono;
    double eye_distance = 0.033;  // as a share of the distance to the plane
    // The distance to the plane of the screen, as a multiple of the distance to the centre.
    double plane = 1.0;
    double angle_rad = 1.0;  // of view, along a part's longer side
};

// What is where in a window.
struct WindowLayout {
    WindowPart panel;            // on the right; empty: hidden
    glm::uvec2 area_px{0, 0};    // the scene's, beside it
    std::vector<EyePart> parts;  // of the area
    WindowSight sight;

    [[nodiscard]] glm::uvec2 partPx() const { return parts.front().size_px; }
};
// Of one whose pixels are `scale` times as small as those in which desktops count.
WindowLayout layOutWindow(glm::uvec2 size_px, double scale, const ViewSettings& settings, double angle_rad);

// One eye, or two, [kLeft] and [kRight], of `size_px`. Content in the plane of the screen is at the same
// pixel for both.
std::vector<Eye> eyesOf(const OrbitCamera& camera, const WindowSight& sight, glm::uvec2 size_px);
// A quarter of a part, or of another rectangle of pixels: 0 to 3, row-major.
WindowPart quarterOf(glm::uvec2 size_px, int quarter);
// An eye that sees one quarter of a part, of this size, with this many samples per pixel each way.
Eye quarterOf(const Eye& whole, glm::uvec2 part_px, int quarter, double samples);
// The place that an eye sees at a pixel of its picture, at `depth` along its axis.
glm::dvec3 pointAt(const Eye& eye, const glm::dvec2& place_px, double depth);

}  // namespace binosplat
