// How frames differ.
#include "engine/frame/history.h"

#include <algorithm>
#include <cmath>

namespace binosplat {
namespace {

// From one frame to the next the contents of lists change by less than their spare capacity, unless an eye
// moves or turns farther than this, or its angles change by more than this share. Heads move at up to 3 m/s
// and turn at up to 400 degrees/s: at 72 frames per second that is 4 cm and 5.6 degrees. Snap turns are 15
// degrees and more.
constexpr double kJumpMetres = 0.2;
constexpr double kJumpDegrees = 6.0;
constexpr double kJumpZoom = 0.1;
// From farther away a history is worse than the other eye would be, which is 6 cm away: docs/tried.md, *Reuse
// over time*. The share is of the distance between the eyes, however large the scene is.
constexpr double kFarthestHistoryMetres = 0.05, kFarthestHistoryShare = 0.8;
// Beyond this a history is too coarse, or much finer than needed.
constexpr double kMostZoom = 2.0;
// While frames are rendered in full, nothing is known about what would have to be rendered again: less and
// less is assumed, by half in a second at 90 Hz, so that reprojecting is tried again.
constexpr double kShareFades = 0.9923;
// With more work than this, as a multiple of the cost of reprojecting, a lower bound or budget pays, and
// lists for both pictures would be long.
constexpr double kMostFull = 2.0;

bool moves(const Pose& from, const Pose& to, double farthest) {
    const bool turns =
        std::abs(glm::dot(from.orientation, to.orientation)) < std::cos(0.5 * glm::radians(kJumpDegrees));
    return turns || glm::distance(from.position, to.position) > farthest;
}

}  // namespace

FrameShape shapeOf(std::span<const Eye> eyes, const FrameSettings& settings) {
    FrameShape shape{.mode = settings.mode,
                     .dominant = settings.mode == Mode::kMono ? 0 : settings.dominant,
                     .per_eye = settings.per_eye,
                     .half_floats = settings.half_floats,
                     .keep_depth = settings.keep_depth,
                     .keep_both_depths = settings.keep_both_depths,
                     .keep_moments = settings.keep_moments,
                     .keep_classes = settings.keep_classes,
                     .center_rois = settings.stereo.center_rois,
                     .half_periphery = hasCoarseTiles(settings, eyes.size())};
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        shape.memory_px[e] = glm::max(settings.most_px, eyes[e].size_px);
    }
    return shape;
}

bool jumps(std::span<const Eye> before, std::span<const Eye> eyes, double units_per_metre) {
    if (eyes.size() != before.size()) { return true; }
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const Intrinsics &lens = before[e].intrinsics, &other_lens = eyes[e].intrinsics;
        const bool zooms =
            std::abs(other_lens.fx - lens.fx) + std::abs(other_lens.fy - lens.fy) > kJumpZoom * lens.fx;
        if (zooms ||
            moves(before[e].world_from_camera, eyes[e].world_from_camera, kJumpMetres * units_per_metre)) {
            return true;
        }
    }
    return false;
}

double farthestHistory(std::span<const Eye> eyes, double units_per_metre) {
    const double between =
        glm::distance(eyes.front().world_from_camera.position, eyes.back().world_from_camera.position);
    return std::max(kFarthestHistoryMetres * units_per_metre, kFarthestHistoryShare * between);
}

bool canComeFrom(const Eye& history, const Eye& eye, double farthest) {
    const double zoom_x = eye.intrinsics.fx / history.intrinsics.fx,
                 zoom_y = eye.intrinsics.fy / history.intrinsics.fy;
    const bool zooms = std::min(zoom_x, zoom_y) < 1.0 / kMostZoom || std::max(zoom_x, zoom_y) > kMostZoom;
    return !zooms && !moves(history.world_from_camera, eye.world_from_camera, farthest);
}

MovingPays::Asked MovingPays::askedBy(std::span<const Eye> eyes, const FrameSettings& settings) {
    const int dominant = settings.mode == Mode::kMono ? 0 : settings.dominant;
    return {stereoSettingsOf(settings), dominant, eyes[0].size_px,
            settings.hidden_tiles[static_cast<std::size_t>(dominant)].size()};
}

void HistoryPays::ask(const Asked& asked) {
    if (asked == asked_) { return; }
    forget();
    asked_ = asked;
}

void HistoryPays::learn(const Asked& asked, double full, std::optional<double> rendered, double tiles) {
    if (asked != asked_) { return; }
    full_ = full;
    share_ = rendered ? *rendered / std::max(full, 1.0) : kShareFades * share_;
    const double cost = asked_.stereo.move_cost * tiles,
                 least = pays_ ? cost : cost * (1.0 + 1.0 / gpu::kResumePart);
    pays_ = full > kMostFull * cost || (1.0 - share_) * full >= least;
}

}  // namespace binosplat
