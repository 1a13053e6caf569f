// An eye's picture warped from the one that it showed before, and the tiles of both eyes that are rendered
// again.
//
//   warp_history    what the history shows, block by block, and the error to expect of each tile
//   warp_pixels  the pixels of other blocks one by one
//   mark_changed where the scene differs from what the history saw
//   price        what it costs to mend that, with one budget for all eyes
//   select       the tiles to render
#pragma once

#include "engine/passes/pass_kernels.h"
#include "engine/passes/warp_buffers.h"
#include "engine/passes/warp_view.h"

#include <span>

namespace binosplat {

// The inputs of one eye's passes.
struct HistoryInputs {
    const FrameBuffers& buffers;
    const WarpBuffers& warp;
    int index;  // of FrameState::targets
    Role role;
    const Picture& source;
    const Picture& target;
    gpu::DeviceAddress<gpu::uint> shown, source_shown;  // masks of the shown tiles; null: all
    // The eye's gaze is known; otherwise all tiles count alike.
    bool gaze;
};

// The eye `now` and the one whose picture is its history, for the device. `near`: nothing nearer is visible,
// in scene units.
gpu::HistoryView historyViewOf(const Eye& now, const Eye& history, double near, const glm::vec3& background);

// The target's colours, words and tiles.
void recordFromHistory(PassKernels& kernels, Commands& commands, const HistoryInputs& in);
// Between the two: marks where the scene has changed since the history was made.
void recordChanged(PassKernels& kernels, Commands& commands, const HistoryInputs& in,
                   gpu::DeviceAddress<gpu::ChangedRect> rects, gpu::uint count);
// Chooses the tiles of all `eyes`, one target after the other, that are rendered again; `at_once` of them at
// the same time. The first one's WarpView has the budget, a share of all eyes' work. `most_pairs`: the
// capacity of their list.
void recordChoice(PassKernels& kernels, Commands& commands, std::span<const HistoryInputs> eyes,
                  gpu::uint at_once, gpu::uint most_pairs);

}  // namespace binosplat
