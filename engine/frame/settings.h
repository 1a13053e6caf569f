// The settings of a frame, and its result.
#pragma once

#include "engine/baselines/warp_traffic.h"
#include "engine/frame/counters.h"
#include "engine/geometry.h"
#include "engine/gpu/commands.h"
#include "engine/mode.h"
#include "engine/passes/frame_buffers.h"
#include "engine/passes/warp_view.h"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// A program's own depths, one per pixel: depth_scale / z + depth_offset.
struct MeshDepths {
    gpu::DeviceAddress<float> depths;
    float depth_scale = 1.0f, depth_offset = 0.0f;
};

struct FrameSettings {
    Mode mode = Mode::kPredicted;
    Side dominant = kLeft;
    double near = 0.2;             // scene units
    double units_per_metre = 1.0;  // scene units in a metre of the wearer: to recognize a jump of the eyes
    glm::dvec3 background{0.0};
    // Applies to all modes; a frame of two eyes has one middle, even if nothing is shared.
    Order order = Order::kDepth;
    StereoSettings stereo;  // how one eye is made from the other; its `choice` follows from the mode
    // kPaper: each eye is culled, ordered and projected by itself, as in kTwoPass. The two sequential
    // strategies that the paper compares differ only in the second eye's picture (section 4.3), and it
    // mentions no work that the eyes share.
    bool per_eye = false;
    // Four half floats per pixel: for display, with half the bytes of pictures for files.
    bool half_floats = false;
    bool keep_depth = true;  // D of the dominant eye, for readDominantDepth
    // Also D of the affiliated eye; where that is not rendered, alpha over its inverse depth.
    bool keep_both_depths = false;
    // Instead of D: A times the depth at which blending passes a half, so that D/A is the depth of a surface.
    // For display, with half floats, in modes that reproject nothing.
    bool surface_depths = false;
    bool keep_moments = false;  // I and J of the dominant eye, for readInverseDepthMoments
    // How each pixel of the affiliated eye came about, for readPixelClasses and the report's counters.
    bool keep_classes = false;
    // By eye, hidden tiles: a byte per tile, row-major, 1 if it is hidden. They become background, cost no
    // pairs and do not count for the budget, which is a share of the others. Empty: none is; frames beside
    // each other wait where an eye's mask comes or goes, not where one hides nothing.
    std::array<std::span<const std::uint8_t>, 2> hidden_tiles = {};
    // Modes that render every tile (isInFull), by eye: splats show only where they are nearer than this.
    std::array<std::optional<MeshDepths>, 2> mesh_depths = {};
    // Recorded before anything of the frame.
    std::function<void(Commands&)> before = {};
    // kPredicted, by eye: where it looks; empty: unknown. Only the part of the affiliated eye's errors that
    // it sees counts.
    std::array<std::optional<Gaze>, 2> gazes = {};
    // kMono, kPredicted, kAlternate, kTemporal: if the gazes are known (`gazes`), tiles elsewhere are coarse,
    // unless the eyes would see the difference. Not if moments are kept.
    bool half_periphery = false;
    // kAlternate, kTemporal: more frames follow, and are made from this one; this one may be made from the
    // one before, if that had keep_history, too.
    bool keep_history = false;
    // renderAhead: a frame after a jump of the eyes, or after lists were too short, is waited for, so that it
    // is whole; otherwise it is not, and whoever shows frames may hide the few until longer lists are made.
    bool waits_for_lists = true;
    bool times_passes = true;  // for FrameResult::gpu_ms: two timestamps per pass instead of two per frame
    // kTemporal: frames also measure what half of the resolution would lose, taking turns with one part of
    // their tiles each: this is the turn. If it is the number of parts, or more, they do not.
    std::uint32_t measured_part = gpu::kMeasuredParts;
    // renderAhead: memory is made for pictures of this size, and those of frames up to it use a part of it,
    // so that the size may change without a wait. 0: each size has memory of its own.
    glm::uvec2 most_px{0, 0};
    std::uint64_t mark = 0;  // the caller's own; returned with the result
};

// Of such a mask.
std::uint32_t countHidden(std::span<const std::uint8_t> hidden_tiles);

// Its `stereo`, with the choice of tiles that follows from the mode.
StereoSettings stereoSettingsOf(const FrameSettings& settings);

struct FrameResult {
    PassTimes gpu_ms;           // of FrameSettings::times_passes
    double gpu_total_ms = 0.0;  // from the first pass to the last
    FrameCounters counters;
    Traffic stereo_bytes_per_pixel;  // of the passes that make one eye from the other, if the mode has any
    // For `temporal`, as mean squares over pixels and channels, for values of 0 to 1; 0 if unknown: the
    // expected error of its tiles that were not rendered, and what half of the resolution would lose.
    double warp_error = 0.0, half_loss = 0.0;
    // Shares of the affiliated eye's tiles, and of its work if the mode weighs it.
    double tiles_rendered = 1.0, work_rendered = 1.0;
    // The most device memory that this program ever held at a time.
    std::uint64_t peak_gpu_bytes = 0;
    std::vector<std::string> left_out;  // what this scene and mode did not need
    std::uint64_t mark = 0;             // of its settings
    // No splat touches any of its pictures, nor touched their histories.
    bool sees_nothing = false;
};

// Initial values of a frame; the defaults suit every device.
struct FrameOptions {
    FrameCapacity first_capacity{65536, 65536};
    std::uint32_t threads_per_cell = 0;  // see PassKernels
};

}  // namespace binosplat
