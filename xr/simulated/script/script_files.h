// The files that a script names: headsets as in configs/headsets, recorded head motion, and the script itself.
#pragma once

#include "xr/simulated/script/script.h"

namespace simulated {

// The text of a regular file of at most 16 MiB. `place` is who names it, for messages ("walk.script:3: ", or nothing). Throws ScriptError.
[[nodiscard]] std::string readText(const std::filesystem::path& path, const std::string& place, const char* expected);

struct HeadsetFile {
    std::string name;
    glm::uvec2 size_px;
    double eye_distance_m;
    double cant_rad;          // each eye outwards
    std::array<Fov, 2> fovs;  // by Side
};
// TOML with the keys name, source, size ("WxH"), canting_deg, eye_distance_m and the tables [left] and [right] of left, right, up, down in
// degrees. Throws ScriptError with the file's own line.
[[nodiscard]] HeadsetFile parseHeadset(const std::string& text, const std::string& name);

// The axes a recording was made in; y points up in both, x to the right.
enum class MotionAxes {
    kOpenXr,  // right-handed, the wearer looks along -z
    kUnity,   // left-handed, the wearer looks along +z
};
// Lines of time, position x, y, z, orientation x, y, z, w; times count from 0 at the first pose. The first line may be a header: time_s,
// time_ms, time_us, time_ns or time_ticks (of 100 ns) says the unit, and a fifth column w or qw that the orientation is w, x, y, z. Without
// a unit, numbers under 1e12 are seconds and those from 1e16 to 1e18 ticks. Throws ScriptError with the file's own line.
[[nodiscard]] Track<Pose> parseHeadMotion(std::string_view text, const std::string& name, MotionAxes axes);

}  // namespace simulated
