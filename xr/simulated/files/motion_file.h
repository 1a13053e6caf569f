// Recorded head motion from CSV, as it was recorded.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace files {

struct MotionSample {
    double time_s = 0.0;  // since the first sample
    std::array<double, 3> position_m{};
    std::array<double, 4> orientation_xyzw{};  // of length 1
};

struct MotionFile {
    std::vector<MotionSample> samples;
    std::string note;  // a sentence about what was skipped; empty: nothing
};

// Lines of eight comma-separated numbers: time, position x, y, z in metres, orientation x, y, z, w; blanks
// around numbers, empty lines and lines that begin with # do not count. The first line may be a header; then
// it says what it can:
//   - time_s, time_ms, time_us, time_ns or time_ticks (of 100 ns), or timestamp_..., is the unit of time.
//     Without one, numbers under 1e12 are seconds and those from 1e16 to 1e18 ticks, as Windows counts them;
//     for others, the unit must be stated;
//   - a fifth column called w or qw means that the orientation is w, x, y, z.
// There is at least one sample, and times increase strictly from 0. Throws Error with file and line for other
// numbers of columns, numbers that are not finite, times that do not increase, orientations whose length is
// not 1 to within 5 %, and texts without a pose. Only a last row that is incomplete because the recorder was
// stopped is skipped, with a note: one that has too few columns, nothing after its time, or a broken last
// number and no line break.
[[nodiscard]] MotionFile parseMotion(std::string_view text, const std::string& file);

}  // namespace files
