// Headset geometry from TOML, as in configs/headsets.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace files {

// From the eye's axis; left and down are negative for a usual eye.
struct HeadsetAngles {
    double left_rad = 0.0, right_rad = 0.0, up_rad = 0.0, down_rad = 0.0;
};

// A foveated inset, for programs that draw one: picture sizes, if they are not those that follow from the
// eyes'.
struct HeadsetInset {
    double half_angle_rad = 0.0;  // about the gaze, each way
    std::optional<std::array<std::uint32_t, 2>> size_px, context_size_px;
};

struct HeadsetFile {
    std::string name;
    std::string source;                      // where the figures come from
    std::array<std::uint32_t, 2> size_px{};  // of an eye
    double canting_rad = 0.0;                // each eye outwards
    double eye_distance_m = 0.0;
    std::array<HeadsetAngles, 2> angles;  // left, right
    // The lens's centre: angles to the right of the eye's axis and above it.
    std::array<std::array<double, 2>, 2> lens_centres_rad{};
    std::optional<HeadsetInset> inset;
};

// TOML with the keys name, source, size ("WxH", 1 to 16384 each), canting_deg (0 to 45), eye_distance_m (0 to
// 1) and the tables [left] and [right] of left, right, up, down in degrees (-85 to 85) and, if it is not on
// the eye's axis, lens_centre = [right, up], within these. Optional: the table [inset] of half_angle_deg (1
// to 85) and, if they are not the usual ones, size and context_size. '-' in a key reads as '_'. Throws Error
// with file and line.
[[nodiscard]] HeadsetFile parseHeadset(const std::string& text, const std::string& file);

}  // namespace files
