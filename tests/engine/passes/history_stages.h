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

// How a HistoryWalk keeps its pictures, if nothing else is wanted.
inline FrameSettings walkSettings(bool half_floats = false, const glm::dvec3& background = {0.1, 0.2, 0.3}) {
    FrameSettings settings = makeSettings(Mode::kTemporal);
    settings.half_floats = half_floats;
    settings.background = background;
    return settings;
}

// Frames of a head that walks and turns a little, with their full renders beside them. `cant`: of the right
// eye.
class HistoryWalk {
public:
    HistoryWalk(Gpu& gpu, ViewedScene view, const FrameSettings& settings = walkSettings(), double cant = 0.0)
        : gpu_(gpu),
          view_(std::move(view)),
          settings_(settings),
          cant_(cant),
          frame_(gpu.context(), view_.scene),
          full_(StereoFrame::beside(frame_)) {}

    FrameResult go(double step) { return go(step, view_.eye); }
    FrameResult go(double step, const Eye& start) {
        eyes_ = walkedEyes(start, step);
        eyes_[kRight] = turned(eyes_[kRight], cant_);
        return frame_.render(eyes_, settings_);
    }
    FrameResult go(double step, double budget, std::uint32_t measured_part = gpu::kMeasuredParts) {
        settings_.stereo.budget = budget;
        settings_.measured_part = measured_part;
        return go(step);
    }
    std::array<Image, 2> shown() { return picturesOf(frame_); }
    // Full renders of the last frame's eyes.
    std::array<Image, 2> full() {
        FrameSettings settings = settings_;
        settings.mode = Mode::kShared;
        settings.keep_history = settings.half_periphery = false;
        full_->render(eyes_, settings);
        return picturesOf(*full_);
    }
    double psnr() { return psnrDb(shown(), full()); }
    EyeOnDevice read(std::size_t eye) { return readEye(gpu_, frame_, static_cast<int>(eye), eyes_[eye]); }
    [[nodiscard]] StereoFrame& frame() { return frame_; }
    [[nodiscard]] const std::array<Eye, 2>& eyes() const { return eyes_; }

private:
    Gpu& gpu_;
    ViewedScene view_;
    FrameSettings settings_;
    double cant_;
    KeptFrame frame_;
    std::unique_ptr<StereoFrame> full_;
    std::array<Eye, 2> eyes_;
};

}  // namespace binosplat::test
