// Frames that are reprojected from earlier ones, and what the device knows about them, from which the twin
// continues.
#pragma once

#include "engine/twin/history.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

namespace binosplat::test {

inline constexpr double kErrorSteps = 0x1p20;

inline reference::HistoryTile tileOf(const gpu::HistoryTile& tile) {
    reference::HistoryTile twin{tile.cost, tile.age, {}, {}, {}, static_cast<double>(tile.lost)};
    for (int q = 0; q < 4; ++q) {
        twin.growth[static_cast<std::size_t>(q)] = static_cast<double>(tile.growth[q]);
        twin.errors[static_cast<std::size_t>(q)] = static_cast<double>(tile.errors[q]);
        twin.grown[static_cast<std::size_t>(q)] = tile.grown[q] / kErrorSteps;
        twin.unseen[static_cast<std::size_t>(q)] = tile.unseen >> (8 * q) & 0xff;
    }
    twin.squared_gradient = tile.squared_gradient / kErrorSteps;
    return twin;
}

// An eye's picture, and what the choice among its tiles left.
struct EyeOnDevice {
    reference::History history;
    std::vector<gpu::uint> kinds, errors, costs;
};

inline EyeOnDevice readEye(Gpu& gpu, StereoFrame& frame, int index, const Eye& eye) {
    const Picture& picture = frame.picture(index);
    EyeOnDevice read{{eye, {}, {}, {}}, {}, {}, {}};
    const std::size_t pixels = std::size_t{eye.size_px.x} * eye.size_px.y;
    for (const gpu::vec4& colour : picture.half_floats
                                       ? unpackHalves(gpu.readBack<gpu::uvec2>(picture.colours, pixels))
                                       : gpu.readBack<gpu::vec4>(picture.colours, pixels)) {
        read.history.rgba.emplace_back(colour);
    }
    for (const gpu::uint word : gpu.readBack<gpu::uint>(picture.words, pixels)) {
        const reference::Arrival held = unpackArrival(word);
        read.history.pixels.push_back(
            word == 0 ? std::nullopt
                      : std::optional(reference::MovingPixel{held.inverse_depth, held.spread}));
    }
    const std::size_t count = tileCount(eye.size_px);
    for (const gpu::HistoryTile& tile : gpu.readBack<gpu::HistoryTile>(picture.tiles, count)) {
        read.history.tiles.push_back(tileOf(tile));
    }
    if (const WarpBuffers* chosen = frame.chosenTiles(index)) {
        const auto array = [&](gpu::DeviceAddress<gpu::uint> at) {
            return gpu.readBack<gpu::uint>(
                chosen->tiles(), count,
                at.value - chosen->tileKinds().value + WarpBuffers::tileKindsOffset());
        };
        read.kinds = array(chosen->tileKinds());
        read.errors = array(chosen->tileErrors());
        read.costs = array(chosen->tileCosts());
    }
    return read;
}

// How a HistoryWalk keeps its pictures.
struct WalkSettings {
    std::array<std::vector<std::uint8_t>, 2> hidden = {};  // each eye's tiles, as in FrameSettings
    glm::dvec3 background{0.1, 0.2, 0.3};
    bool half_floats = false;
    double cant = 0.0;  // of the right eye, about its up axis
};

// Frames of a head that walks and turns a little, made as `temporal` makes them.
class HistoryWalk {
public:
    HistoryWalk(Gpu& gpu, const ViewedScene& view, WalkSettings settings = {})
        : gpu_(gpu),
          view_(view),
          settings_(std::move(settings)),
          scene_(gpu.context(), view.scene),
          frame_(gpu.context(), scene_) {}

    FrameResult go(double step, double budget, std::uint32_t measured_part = gpu::kMeasuredParts) {
        eyes_ = walkedEyes(view_.eye, step);
        eyes_[kRight] = turned(eyes_[kRight], settings_.cant);
        FrameSettings settings = settingsOf(Mode::kTemporal, budget);
        settings.measured_part = measured_part;
        return frame_.render(eyes_, settings);
    }
    // Full renders of the last frame's eyes.
    std::array<Image, 2> full() {
        KeptFrame frame(gpu_.context(), scene_);
        frame.render(eyes_, settingsOf(Mode::kShared, 0.0));
        return picturesOf(frame);
    }
    EyeOnDevice read(std::size_t eye) { return readEye(gpu_, frame_, static_cast<int>(eye), eyes_[eye]); }
    // The left eye's.
    Image readDepth() { return frame_.readDominantDepth(); }
    [[nodiscard]] const std::array<Eye, 2>& eyes() const { return eyes_; }

private:
    [[nodiscard]] FrameSettings settingsOf(Mode mode, double budget) const {
        FrameSettings settings = makeSettings(mode);
        settings.stereo.budget = budget;
        settings.hidden_tiles = {settings_.hidden[0], settings_.hidden[1]};
        settings.background = settings_.background;
        settings.half_floats = settings_.half_floats;
        return settings;
    }

    Gpu& gpu_;
    const ViewedScene& view_;
    WalkSettings settings_;
    GpuScene scene_;
    KeptFrame frame_;
    std::array<Eye, 2> eyes_;
};

// How far the device's warp is from the twin's.
struct WarpDifferences {
    std::size_t pixels = 0, other_depths = 0, other_spreads = 0, tiles = 0, other_tiles = 0;
    std::size_t quarters = 0, other_grown = 0, other_errors = 0, other_growth = 0, other_gradients = 0;
    double grown = 0.0, twin_grown = 0.0, squares = 0.0;
};

// Compares what the device made of the frame before, with nothing rendered again, with what the twin makes of
// it.
inline void compareWarped(WarpDifferences& differences, const EyeOnDevice& made, reference::History twin) {
    for (std::size_t i = 0; i < twin.rgba.size(); ++i) {
        const glm::dvec4 off = made.history.rgba[i] - twin.rgba[i];
        differences.squares += glm::dot(off, off) / 4.0;
        const auto &a = made.history.pixels[i], &b = twin.pixels[i];
        // All depths of a block change by the ratio of its middle's.
        const bool same =
            a.has_value() == b.has_value() && (!a || isNear(a->inverse_depth, b->inverse_depth, 1e-3, 1e-6));
        differences.other_depths += !same;
        differences.other_spreads += a && b && a->spread != b->spread;
    }
    differences.pixels += twin.rgba.size();
    for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
        const reference::HistoryTile &a = made.history.tiles[t], &b = twin.tiles[t];
        for (std::size_t q = 0; q < 4; ++q) {
            differences.other_growth += !isNear(a.growth[q], b.growth[q], 1e-5, 1e-8);
            // A pixel's error is rounded down to steps.
            differences.other_grown += !isNear(a.grown[q], b.grown[q], 0.02, 66.0 / kErrorSteps);
            differences.grown += a.grown[q];
            differences.twin_grown += b.grown[q];
        }
        differences.other_gradients +=
            !isNear(a.squared_gradient, b.squared_gradient, 0.02, 264.0 / kErrorSteps);
        differences.other_tiles += !(a.cost == b.cost && a.age == b.age && a.unseen == b.unseen);
    }
    reference::growErrors(twin.tiles);
    for (std::size_t t = 0; t < twin.tiles.size(); ++t) {
        for (std::size_t q = 0; q < 4; ++q) {
            differences.other_errors +=
                !isNear(made.history.tiles[t].errors[q], twin.tiles[t].errors[q], 0.02, 6e-4);
        }
    }
    differences.tiles += twin.tiles.size();
    differences.quarters += 4 * twin.tiles.size();
}

}  // namespace binosplat::test
