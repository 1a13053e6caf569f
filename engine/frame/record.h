// Recording a plan.
#pragma once

#include "engine/frame/room.h"

namespace binosplat {

// What recording works with.
struct FrameRecorder {
    Passes& passes;
    WarpPasses& warp_passes;
    const GpuScene& scene;
    FrameRoom& room;

    // The whole frame, from Commands::begin on.
    void record(Commands& commands, const FramePlan& plan) const;
    // How many splats its lists need, alone.
    void recordCulling(Commands& commands, const FramePlan& plan) const;
    // Likewise how it ends: what the device reports goes to `readback`.
    void recordReport(Commands& commands, const Buffer& readback) const { commands.copy(room.lists().state, readback, sizeof(FrameState)); }

private:
    void begin(Commands& commands, const FramePlan& plan) const;
    void recordWarp(Commands& commands, const FramePlan& plan, int index) const;
    void recordPicture(Commands& commands, const FramePlan& plan, int index) const;
    [[nodiscard]] Target targetOf(const FramePlan& plan, int index) const;
};

}  // namespace binosplat
