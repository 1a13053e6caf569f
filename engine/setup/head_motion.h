// Recorded head motion from a CSV file, as poses in the camera's axes, and how a camera follows it.
#pragma once

#include "engine/geometry.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

// The axes of a recording; y points up in both, x to the right.
enum class MotionAxes {
    kOpenXr,  // right-handed, the wearer looks along -z: OpenXR, WebXR, SteamVR
    kUnity,   // left-handed, the wearer looks along +z: recordings of Unity applications
};

// A recorded pose in the camera's axes (x right, y down, z forward), for both head and world. Lengths stay in
// metres.
Pose poseFromRecording(const glm::dvec3& position, const glm::dquat& orientation, MotionAxes axes);

struct HeadSample {
    double time_s = 0.0;   // since the first sample
    Pose world_from_head;  // camera axes, metres
};

class HeadMotion {
public:
    // At least one sample, times strictly increasing from 0.
    explicit HeadMotion(std::vector<HeadSample> samples, std::string note = {});

    // A sentence about what was skipped in its file; empty: nothing.
    [[nodiscard]] const std::string& note() const { return note_; }
    [[nodiscard]] const std::vector<HeadSample>& samples() const { return samples_; }
    [[nodiscard]] double duration_s() const { return samples_.back().time_s; }

    // The pose at a time since the first sample: positions are interpolated linearly, orientations along the
    // shorter great arc (Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985, section 3.3).
    // Before the first and after the last sample, the head is at rest.
    [[nodiscard]] Pose poseAt(double time_s) const;

    // The motion from this second to the last sample; its times begin at 0 with the pose there.
    [[nodiscard]] HeadMotion startingAt(double from_s) const;

    // world_from_camera at `time_s` for a camera that starts at `world_from_start` and moves relative to it
    // as the head does relative to its first pose, with `units_per_metre` scene units per metre.
    [[nodiscard]] Pose cameraAt(double time_s, const Pose& world_from_start,
                                double units_per_metre = 1.0) const;

private:
    std::vector<HeadSample> samples_;
    std::string note_;
};

// The part of a recording to play.
struct MotionSegment {
    double from_s = 0.0;  // its beginning
    // Length, without its end; absent: up to and including the last sample.
    std::optional<double> seconds;
    std::optional<double> rate_hz;  // frames per second; absent: one for each sample
};

// The times of a motion's frames, starting at the segment's beginning. Throws Error if there are more than a
// million; `file` is for messages.
std::vector<double> frameTimes(const HeadMotion& motion, const MotionSegment& segment,
                               const std::string& file);

// Reads a file as described in xr/simulated/files/motion_file.h. Throws Error with file and line.
HeadMotion readHeadMotion(const std::filesystem::path& path, MotionAxes axes);

// The same from a later second. Throws Error if the recording ends before it.
HeadMotion readHeadMotion(const std::filesystem::path& path, MotionAxes axes, const MotionSegment& segment);

// The same from text in memory; `file` is for messages.
HeadMotion parseHeadMotion(std::string_view text, const std::string& file, MotionAxes axes);

}  // namespace binosplat
