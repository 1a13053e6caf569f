// What a bench with head motion says about the frames of one method.
#pragma once

#include "app/bench/motion_results.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// The share of all tiles whose PSNR tells how bad the worst ones are.
inline constexpr double kWorstTiles = 0.001;

// All frames of one method at one point, in order of time.
struct Sequence {
    std::string point, method;
    std::vector<const MotionFrame*> frames;
};
std::vector<Sequence> sequencesOf(const MotionRun& run);

template <typename Value>
std::vector<double> valuesOf(const std::vector<const MotionFrame*>& frames, Value&& value) {
    std::vector<double> values;
    for (const MotionFrame* frame : frames) { values.push_back(std::invoke(value, *frame)); }
    return values;
}

// Those whose errors count.
std::vector<const MotionFrame*> steadyFrames(const Sequence& sequence);
double runSquare(const Sequence& sequence);
// Of the worse eye.
std::vector<double> steadySquares(const Sequence& sequence);
// Without the first frame, which has no predecessor.
std::vector<double> flickerOf(const Sequence& sequence);

// What shows of the errors, over the steady frames: means, the worst frame's bad tiles, and the worst tiles
// of all.
struct Visible {
    double bad = 0.0, worst_bad = 0.0, worst_tiles = 0.0, edge = 0.0, seam = 0.0, rival = 0.0;
};
Visible visibleOf(const Sequence& sequence);
// Through a headset's lenses.
std::optional<Visible> seenOf(const Sequence& sequence);

// Over the steady frames: of the tiles that were not rendered, the share that is far under the bound, and the
// worst frame's share.
struct UnderBound {
    BoundedTiles tiles;
    double worst_share = 0.0;
};
std::optional<UnderBound> underBoundOf(const Sequence& sequence);

// Mean squared errors of the pixels that the scene's motion changed, for frames with any; and like
// runSquare(), over all these pixels.
std::vector<double> movedSquares(const Sequence& sequence);
double movedRunSquare(const Sequence& sequence);

}  // namespace binosplat
