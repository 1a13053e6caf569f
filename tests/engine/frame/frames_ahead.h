// Frames that are not waited for, of the built-in room.
#pragma once

#include "tests/engine/frame/frame_runs.h"

namespace binosplat::test::ahead {

// An eye that looks away from everything.
inline Eye awayFrom(const Eye& eye) { return turned(eye, 3.1); }

// A head that moves on and turns, a little each frame.
inline std::array<Eye, 2> eyesAt(const Eye& middle, int step) {
    Eye eye = turned(middle, 0.02 * step);
    eye.world_from_camera.position.x += 0.01 * step;
    return stereoPair(eye, 0.063);
}

inline Eye ofSize(Eye eye, glm::uvec2 size_px) {
    eye.size_px = size_px;
    eye.intrinsics = intrinsicsFromFovX(glm::radians(70.0), size_px);
    return eye;
}

struct Atelier : Gpu {
    const ViewedScene view = viewBuiltin("builtin:atelier", {96, 96}, 8000);
    const GpuScene scene{context(), view.scene};
};

// Lists that begin without capacity, and eyes that, without moving, see the whole room or nothing of it.
inline constexpr FrameOptions kNoRoom{.first_capacity = {1, 1}, .threads_per_cell = 0};
inline FrameSettings seeing() { return makeSettings(Mode::kShared); }
inline FrameSettings blind() {
    FrameSettings settings = seeing();
    settings.near = 1e4;
    return settings;
}
// Renders this many frames without waiting; returns the last report.
inline FrameResult goAhead(StereoFrame& frame, const std::array<Eye, 2>& eyes, const FrameSettings& settings,
                           int frames) {
    FrameResult last{};
    for (int i = 0; i < frames; ++i) {
        if (auto result = frame.renderAhead(eyes, settings)) { last = std::move(*result); }
    }
    return last;
}

}  // namespace binosplat::test::ahead
