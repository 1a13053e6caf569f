// Headset geometry from TOML, as in configs/headsets.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace files {

// From the eye's axis; left and down are negative for a usual eye.
struct HeadsetAngles {
    double left_rad = 0.0, right_rad = 0.0, up_rad = 0.0, down_rad = 0.0;
};

struct HeadsetFile {
    std::string name;
    std::string source;                      // where the figures come from
    std::array<std::uint32_t, 2> size_px{};  // of an eye
    double canting_rad = 0.0;                // each eye outwards
    double eye_distance_m = 0.0;
    std::array<HeadsetAngles, 2> angles;  // left, right
    // In degrees too: the lens's centre, to the right of the eye's axis and above it.
    std::array<std::array<double, 2>, 2> lens_centres_rad{};
};

// TOML with the keys name, source, size ("WxH", 1 to 16384 each), canting_deg (0 to 45), eye_distance_m (0 to 1) and the tables [left] and
// [right] of left, right, up, down in degrees (-85 to 85) and, if it is not on the eye's axis, lens_centre = [right, up], within these. '-'
// in a key reads as '_'. Throws Error with file and line.
[[nodiscard]] HeadsetFile parseHeadset(const std::string& text, const std::string& file);

}  // namespace files
