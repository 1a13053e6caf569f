// A frame's report: its counters, and which steps it did not need.
#pragma once

#include "engine/frame/capacity.h"

namespace binosplat {

struct FrameFacts {
    const Context& context;
    const GpuScene& scene;
    const FrameMemory& memory;
    const FramePlan& plan;
    const FrameState& state;
    const Commands& commands;
};

FrameResult reportFrame(const FrameFacts& frame, std::uint64_t mark);

}  // namespace binosplat
