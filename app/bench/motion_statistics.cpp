// Means, worst frames and shares over a sequence.
#include "app/bench/motion_statistics.h"

#include <algorithm>

namespace binosplat {

namespace {

// If there are more frames than this, the errors of the first ones do not count: a method that reuses its
// history has none, or little, in these.
constexpr std::size_t kSettling = 10;

using VisibleOf = std::function<const VisibleErrors*(const MotionFrame&)>;
Visible visibleOf(const Sequence& sequence, const VisibleOf& errorsOf) {
    const std::vector<const MotionFrame*> frames = steadyFrames(sequence);
    const auto count = static_cast<double>(frames.size());
    Visible all;
    std::vector<float> squares;
    for (const MotionFrame* frame : frames) {
        const VisibleErrors& visible = *errorsOf(*frame);
        const double bad = visible.badShare();
        all.bad += bad / count;
        all.worst_bad = std::max(all.worst_bad, bad);
        all.edge += visible.edge / count;
        all.seam += visible.seam / count;
        all.rival += visible.rival / count;
        squares.insert(squares.end(), visible.tile_squares.begin(), visible.tile_squares.end());
    }
    all.worst_tiles = worstTiles(std::move(squares), kWorstTiles);
    return all;
}

}  // namespace

std::vector<Sequence> sequencesOf(const MotionRun& run) {
    std::vector<Sequence> sequences;
    for (const MotionFrame& frame : run.frames) {
        const auto found = std::ranges::find_if(
            sequences, [&](const Sequence& s) { return s.point == frame.point && s.method == frame.method; });
        Sequence& sequence = found != sequences.end()
                                 ? *found
                                 : sequences.emplace_back(Sequence{frame.point, frame.method, {}});
        sequence.frames.push_back(&frame);
    }
    return sequences;
}

std::vector<const MotionFrame*> steadyFrames(const Sequence& sequence) {
    const bool settles = sequence.frames.back()->number >= kSettling;
    std::vector<const MotionFrame*> frames;
    for (const MotionFrame* frame : sequence.frames) {
        if (!settles || frame->number >= kSettling) { frames.push_back(frame); }
    }
    return frames;
}

double runSquare(const Sequence& sequence) {
    double sum = 0.0, count = 0.0;
    for (const MotionFrame* frame : steadyFrames(sequence)) {
        sum += frame->mean_square[0] + frame->mean_square[1];
        count += 2.0;
    }
    return sum / count;
}

std::vector<double> steadySquares(const Sequence& sequence) {
    return valuesOf(steadyFrames(sequence), &MotionFrame::worseSquare);
}

std::vector<double> flickerOf(const Sequence& sequence) {
    std::vector<double> values = valuesOf(sequence.frames, &MotionFrame::worseFlicker);
    if (!values.empty()) { values.erase(values.begin()); }
    return values;
}

Visible visibleOf(const Sequence& sequence) {
    return visibleOf(sequence, [](const MotionFrame& frame) { return &frame.visible; });
}
std::optional<Visible> seenOf(const Sequence& sequence) {
    if (!sequence.frames[0]->seen) { return std::nullopt; }
    return visibleOf(sequence, [](const MotionFrame& frame) { return &*frame.seen; });
}

std::optional<UnderBound> underBoundOf(const Sequence& sequence) {
    std::optional<UnderBound> all;
    for (const MotionFrame* frame : steadyFrames(sequence)) {
        if (!frame->bounded) { continue; }
        if (!all) { all.emplace(); }
        all->tiles += *frame->bounded;
        all->worst_share = std::max(all->worst_share, frame->bounded->underShare());
    }
    return all;
}

std::vector<double> movedSquares(const Sequence& sequence) {
    std::vector<double> squares;
    for (const MotionFrame* frame : steadyFrames(sequence)) {
        if (frame->moved_square) { squares.push_back(*frame->moved_square); }
    }
    return squares;
}
double movedRunSquare(const Sequence& sequence) {
    double sum = 0.0, share = 0.0;
    for (const MotionFrame* frame : steadyFrames(sequence)) {
        sum += frame->moved_share * frame->moved_square.value_or(0.0);
        share += frame->moved_share;
    }
    return share > 0.0 ? sum / share : 0.0;
}

}  // namespace binosplat
