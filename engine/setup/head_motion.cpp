// Head motion: converts recorded axes to the camera's, and interpolates poses between samples.
#include "engine/setup/head_motion.h"

#include "engine/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace binosplat {

Pose poseFromRecording(const glm::dvec3& position, const glm::dquat& orientation, MotionAxes axes) {
    // F is the diagonal matrix that takes recorded axes to the camera's: p becomes F p and R becomes F R F.
    // OpenXR's F = (1, -1, -1) is a half turn about x, which turns the axis of R. Unity's F = (1, -1, 1) is a
    // reflection, which also reverses the sense of R.
    if (axes == MotionAxes::kOpenXr) {
        return {glm::dquat(orientation.w, orientation.x, -orientation.y, -orientation.z),
                {position.x, -position.y, -position.z}};
    }
    return {glm::dquat(orientation.w, -orientation.x, orientation.y, -orientation.z),
            {position.x, -position.y, position.z}};
}

HeadMotion::HeadMotion(std::vector<HeadSample> samples, std::string note)
    : samples_(std::move(samples)), note_(std::move(note)) {
    assert(!samples_.empty() && samples_.front().time_s == 0.0);
}

Pose HeadMotion::poseAt(double time_s) const {
    assert(!std::isnan(time_s));
    const auto after = std::ranges::upper_bound(samples_, time_s, {}, &HeadSample::time_s);
    if (after == samples_.begin()) { return samples_.front().world_from_head; }
    if (after == samples_.end()) { return samples_.back().world_from_head; }
    const auto before = std::prev(after);
    const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
    const Pose &a = before->world_from_head, &b = after->world_from_head;
    return {glm::normalize(glm::slerp(a.orientation, b.orientation, share)),
            glm::mix(a.position, b.position, share)};
}

HeadMotion HeadMotion::startingAt(double from_s) const {
    std::vector<HeadSample> samples{{0.0, poseAt(from_s)}};
    for (const HeadSample& sample : samples_) {
        if (sample.time_s > from_s) { samples.push_back({sample.time_s - from_s, sample.world_from_head}); }
    }
    return HeadMotion(std::move(samples), note_);
}

std::vector<double> frameTimes(const HeadMotion& motion, const MotionSegment& segment,
                               const std::string& file) {
    constexpr double kMostFrames = 1e6;  // numbers of six digits
    constexpr double kRounding = 1e-6;   // of a frame: a sample exactly at a frame counts despite rounding
    std::vector<double> times_s;
    if (!segment.rate_hz) {
        for (const HeadSample& sample : motion.samples()) {
            if (!segment.seconds || sample.time_s < *segment.seconds) { times_s.push_back(sample.time_s); }
        }
        check(static_cast<double>(times_s.size()) <= kMostFrames,
              "{}: holds {} poses, must be at most {:.0f}", file, times_s.size(), kMostFrames);
        return times_s;
    }
    double frames = std::floor(motion.duration_s() * *segment.rate_hz + kRounding) + 1.0;
    if (segment.seconds) {
        frames = std::min(frames, std::ceil(*segment.seconds * *segment.rate_hz - kRounding));
    }
    check(frames <= kMostFrames, "{}: makes {:.0f} frames of --rate {}, must be at most {:.0f}", file, frames,
          *segment.rate_hz, kMostFrames);
    for (double i = 0.0; i < frames; ++i) { times_s.push_back(i / *segment.rate_hz); }
    return times_s;
}

HeadMotion readHeadMotion(const std::filesystem::path& path, MotionAxes axes, const MotionSegment& segment) {
    HeadMotion motion = readHeadMotion(path, axes);
    check(segment.from_s <= motion.duration_s(),
          "{}: --from is {}, must be at most {}, where the recording ends", path.string(), segment.from_s,
          motion.duration_s());
    return segment.from_s > 0.0 ? motion.startingAt(segment.from_s) : motion;
}

Pose HeadMotion::cameraAt(double time_s, const Pose& world_from_start, double units_per_metre) const {
    Pose start_from_camera = compose(inverse(samples_.front().world_from_head), poseAt(time_s));
    start_from_camera.position *= units_per_metre;
    return compose(world_from_start, start_from_camera);
}

}  // namespace binosplat
