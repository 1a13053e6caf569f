// Makes kernels with small frames that are never drawn.
#include "app/view/scenes/kernels_ahead.h"

#include "app/options/modes.h"
#include "engine/error.h"

#include <algorithm>
#include <array>
#include <future>
#include <vector>

namespace binosplat {

namespace {

// The governor's shares of the resolution, in each direction; if axes stay, pictures are wider.
constexpr std::array kShares{1.25, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4};

std::array<Eye, 2> smallEyes(std::uint32_t width_px, bool canted) {
    Eye middle{};
    middle.size_px = {width_px, 16};  // kernels depend only on a picture's width
    middle.intrinsics = intrinsicsFromFovX(1.5, middle.size_px);
    std::array<Eye, 2> eyes = stereoPair(middle, 0.063);
    if (canted) {
        eyes[kRight].world_from_camera.orientation = glm::angleAxis(0.1, glm::dvec3(0.0, 1.0, 0.0));
    }
    return eyes;
}

// Of the widths with the same steps (see resample) two are enough: one that history blocks fill, one that
// they do not.
std::vector<std::uint32_t> widthsOf(std::uint32_t width_px) {
    std::vector<std::uint32_t> widths, steps;
    for (const double share : kShares) {
        const auto width = std::max(static_cast<std::uint32_t>(share * width_px), 16u);
        const std::uint32_t its =
            std::min((width + gpu::kArrivalsStep - 1) / gpu::kArrivalsStep, gpu::kMostRowSteps + 1);
        if (std::ranges::find(steps, its) != steps.end()) { continue; }
        steps.push_back(its);
        const std::uint32_t filled =
            (width + gpu::kHistoryColumns - 1) / gpu::kHistoryColumns * gpu::kHistoryColumns;
        widths.insert(widths.end(), {filled, filled - 1});
    }
    return widths;
}

// Makes the kernels of a method in all its variants, for eyes like these.
void makeKernelsOf(StereoFrame& small, const FrameSettings& settings, std::span<const Eye> eyes) {
    const auto seen = settings.mode == Mode::kMono ? eyes.first(1) : eyes;
    small.makeKernels(seen, settings);
    FrameSettings other = settings;
    if (settings.mode == Mode::kPaper) {
        other.stereo.center_rois = !settings.stereo.center_rois;
    } else if (settings.mode == Mode::kPredicted || hasHistory(settings.mode)) {
        other.gazes = {Gaze{}, Gaze{}};
    } else if (settings.mode == Mode::kShared) {
        other.order = settings.order == Order::kDepth ? Order::kDistance : Order::kDepth;
    } else {
        return;
    }
    small.makeKernels(seen, other);
}

// A frame of this shape, without a picture's height.
struct Shape {
    std::uint32_t width_px = 0;
    bool canted = false, hides = false;
};

std::vector<Shape> shapesOf(const FramesAhead& ahead) {
    std::vector<Shape> shapes;
    for (const bool canted : {false, true}) {
        for (const bool hides : {false, true}) {
            for (const std::uint32_t width_px : widthsOf(ahead.size_px.x)) {
                shapes.push_back({width_px, canted, hides});
            }
        }
    }
    return shapes;
}

void makeKernelsOf(const Shape& shape, StereoFrame& small, const CameraOptions& camera,
                   const FramesAhead& ahead) {
    FrameSettings settings = frameSettings(camera, ahead.stereo, kWearersOrder);
    settings.half_floats = true;
    settings.keep_history = true;
    settings.keep_depth = settings.keep_both_depths = ahead.with_depth;
    settings.keep_classes = ahead.tint;
    if (shape.hides) {
        const glm::uvec2 tiles = tilesOf({shape.width_px, 16});
        std::vector<std::uint8_t> hidden(std::size_t{tiles.x} * tiles.y, 0);
        hidden[0] = 1;
        settings.hidden_tiles = {hidden, hidden};
    }
    makeKernelsOf(small, settings, smallEyes(shape.width_px, shape.canted));
}

}  // namespace

bool FramesAhead::isLike(const FramesAhead& other) const {
    // These change while a slider is dragged, and are parameters of kernels; any foveation needs the same
    // kernels.
    const auto withoutNumbers = [](StereoOptions options) {
        options.warp.budget = 0.0;
        options.warp.margin_px = 0;
        options.foveation_deg = options.foveation_deg > 0.0 ? 1.0 : 0.0;
        options.axes = {};
        return options;
    };
    return size_px == other.size_px && with_depth == other.with_depth && tint == other.tint &&
           withoutNumbers(stereo) == withoutNumbers(other.stereo);
}

void makeKernelsAhead(const Context& context, PassKernels& kernels, const GpuScene& scene,
                      const CameraOptions& camera, const FramesAhead& ahead,
                      const std::function<void()>& between) {
    const std::vector<Shape> shapes = shapesOf(ahead);
    std::atomic<std::size_t> taken = 0;
    // Two threads begin at either end, where most kernels differ.
    const auto make = [&](bool from_end) {
        // Never drawn.
        StereoFrame small(context, scene, kernels, {.first_capacity = {1, 1}, .threads_per_cell = 0});
        for (std::size_t done = 0; taken++ < shapes.size(); ++done) {
            between();
            makeKernelsOf(shapes[from_end ? shapes.size() - 1 - done : done], small, camera, ahead);
        }
    };
    try {
        std::future<void> others = std::async(std::launch::async, make, true);
        make(false);
        others.get();
    } catch (const Error&) {}  // reported when a frame needs it
}

KernelMaker::KernelMaker(const Context& context, PassKernels& kernels, const GpuScene& scene,
                         CameraOptions camera, FramesAhead ahead)
    : ahead_(std::move(ahead)), thread_([this, &context, &kernels, &scene, where = std::move(camera)] {
          struct Cancelled {};
          try {
              makeKernelsAhead(context, kernels, scene, where, ahead_, [this] {
                  if (cancelled_) { throw Cancelled(); }
              });
          } catch (const Cancelled&) { gave_up_ = true; } catch (const std::exception&) {
          }
          done_ = true;
      }) {}

KernelMaker::~KernelMaker() {
    cancelled_ = true;
    thread_.join();
}

}  // namespace binosplat
