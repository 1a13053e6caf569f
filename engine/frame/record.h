// Records a plan.
#pragma once

#include "engine/baselines/warp_passes.h"
#include "engine/frame/capacity.h"
#include "engine/passes/history_passes.h"

namespace binosplat {

// Everything that recording works with.
struct FrameRecorder {
    PassKernels& kernels;
    const GpuScene& scene;
    FrameMemory& memory;
    // If the recording is going to be submitted, and so brings the scene's changes: those that the histories
    // know, see GpuScene.
    std::optional<std::uint64_t> changes_known;
    bool brings_changes = true;

    // The whole frame, from Commands::begin on.
    void record(Commands& commands, const FramePlan& plan, bool times_passes = true,
                const std::function<void(Commands&)>& before = {}) const;
    // Only the culling: how many splats the lists need.
    void recordCulling(Commands& commands, const FramePlan& plan) const;
    // The end of that: what the device reports is copied to `readback`.
    void recordReport(Commands& commands, const Buffer& readback) const {
        commands.copy(memory.lists().state, readback, sizeof(FrameState));
    }

private:
    void begin(Commands& commands, bool times_passes) const;
    // Writes FrameState.
    void describeFrame(Commands& commands, const FramePlan& plan) const;
    // Tells the device where a target is, and what becomes of it.
    void describe(const FramePlan& plan, int index, TargetState& state) const;
    void recordWarp(Commands& commands, const FramePlan& plan, int index) const;
    void recordChoice(Commands& commands, const FramePlan& plan) const;
    void recordChanged(Commands& commands, const FramePlan& plan,
                       std::span<const HistoryInputs> pictures) const;
    [[nodiscard]] MovingWords wordsOf(const FramePlan& plan, int warped) const;
    [[nodiscard]] HistoryInputs historyOf(const FramePlan& plan, int index) const;
    [[nodiscard]] EyesOfList eyesOf(const FramePlan& plan, const ListPlan& list) const;
    // The target, and those that are rendered with it.
    [[nodiscard]] Targets targetsOf(const FramePlan& plan, int index) const;
    void recordPictures(Commands& commands, const FramePlan& plan, int index) const;
};

}  // namespace binosplat
