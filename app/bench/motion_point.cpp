// The costs of a frame of each method, and the distance of its pictures from full renders.
#include "app/bench/motion_point.h"

#include "app/bench/statistics.h"
#include "app/scores/metrics.h"
#include "app/scores/visible_errors.h"
#include "engine/picture/turned.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace binosplat {

namespace {

constexpr std::size_t kRecentTwoPasses = 3;

double pairsOf(const FrameResult& frame) {
    double pairs = 0.0;
    for (const TargetCounters& target : frame.counters.targets) {
        pairs += static_cast<double>(target.tile_pairs);
    }
    return pairs;
}

// Pixels in visible tiles that were not rendered, of pictures that are made from others.
std::uint64_t pixelsWarped(const FrameResult& frame) {
    if (!frame.counters.warped) { return 0; }
    const WarpedCounters& warped = *frame.counters.warped;
    const std::uint64_t tiles = warped.tiles_shown - std::min(warped.tiles_shown, warped.tiles_patched);
    return std::min(frame.counters.targets.size() * frame.counters.targets[0].pixels, 256 * tiles);
}

// R, G and B of a - b.
Image subtract(const Image& a, const Image& b) {
    Image difference{a.size_px, 3, {}};
    difference.values.reserve(3 * a.pixelCount());
    for (std::size_t pixel = 0; pixel < a.pixelCount(); ++pixel) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            difference.values.push_back(a.values[pixel * static_cast<std::size_t>(a.channels) + channel] -
                                        b.values[pixel * static_cast<std::size_t>(b.channels) + channel]);
        }
    }
    return difference;
}

// Mean |a - b|; 0 if there is nothing to compare with.
double meanChange(const Image& a, const Image& b) {
    if (a.size_px != b.size_px || a.pixelCount() == 0) { return 0.0; }
    const Image difference = subtract(a, b);
    double sum = 0.0;
    for (const float value : difference.values) { sum += std::abs(static_cast<double>(value)); }
    return sum / static_cast<double>(difference.values.size());
}

// Empty unless the method bounds the errors of tiles that it keeps.
std::optional<BoundedTiles> boundedTilesOf(const VisibleErrors& visible, StereoFrame& frame,
                                           const BenchMethod& method) {
    const double bound_db = method.stereo.warp.error_bound_db;
    if (!hasHistory(method.stereo.mode) || !(bound_db > 0.0) || method.resolution < 1.0) {
        return std::nullopt;
    }
    const std::span<const float> squares(visible.tile_squares);
    const std::size_t of_one = squares.size() / 2;
    BoundedTiles both;
    for (const int eye : {kLeft, kRight}) {
        both += findBoundedTiles(squares.subspan(static_cast<std::size_t>(eye) * of_one, of_one),
                                 frame.readTileKinds(eye), frame.picture(eye).size_px, bound_db);
    }
    return both;
}

// For the pixels of both eyes in which `now` differs from `still`.
struct Moved {
    double share = 0.0;
    std::optional<double> mean_square;
};
Moved compareMoved(const std::array<Image, 2>& pictures, const std::array<Image, 2>& now,
                   const std::array<Image, 2>& still) {
    double squares = 0.0;
    std::size_t moved = 0, pixels = 0;
    for (std::size_t e = 0; e < now.size(); ++e) {
        const Image change = subtract(now[e], still[e]), error = subtract(pictures[e], now[e]);
        for (std::size_t pixel = 0; pixel < now[e].pixelCount(); ++pixel, ++pixels) {
            const auto channels = [&](const Image& of) { return std::span(of.values).subspan(3 * pixel, 3); };
            if (std::ranges::none_of(channels(change), [](float c) {
                    return std::abs(static_cast<double>(c)) >= kLeastMoved;
                })) {
                continue;
            }
            ++moved;
            for (const float c : channels(error)) {
                squares += static_cast<double>(c) * static_cast<double>(c);
            }
        }
    }
    if (moved == 0) { return {}; }
    return {static_cast<double>(moved) / static_cast<double>(pixels),
            squares / (3.0 * static_cast<double>(moved))};
}

}  // namespace

void setTimes(MotionFrame& frame, const FrameResult& result) {
    frame.total_ms = result.gpu_total_ms;
    frame.stage_ms = stagesOf(frame.mode, result.gpu_ms);
    frame.pass_ms = byLabel(result.gpu_ms);
}

MotionPoint::MotionPoint(const Context& context, const GpuScene& scene, const RunOptions& run,
                         const BenchPlan& plan, std::string name, const FrameTime& frame_time)
    : camera_(run.camera),
      shared_(plainMethod(Mode::kShared, run)),
      two_pass_(plainMethod(Mode::kTwoPass, run)),
      frames_(context, scene),
      name_(std::move(name)) {
    for (const BenchMethod& method : plan.methods) {
        if (method.stereo.mode == Mode::kMono) { continue; }
        MethodHistory& sequence = sequences_.emplace_back(MethodHistory{method, {}});
        const bool can_be_governed = method.stereo.mode == Mode::kTemporal && method.resolution == 1.0;
        if (can_be_governed) { sequence.frame_time = method.frame_time.value_or(frame_time); }
        if (sequence.frame_time.amount > 0.0) { sequence.governor.emplace(); }
    }
    if (run.stereo.axes == Axes::kStay) { axes_.emplace(glm::radians(kAxesMarginDegrees)); }
}

MotionPoint::Posed MotionPoint::posed(const Cameras& cameras) {
    Posed pose{cameras, cameras};
    if (axes_) { std::ranges::copy(axes_->follow(cameras.eyes), pose.pictures.eyes.begin()); }
    return pose;
}

MethodFrames::Rendered MotionPoint::render(const Posed& pose, const BenchMethod& method, bool keep_history,
                                           const std::optional<GovernedSettings>& chosen) {
    return frames_.render(pose.pictures, camera_, method, false, keep_history, axes_ ? &pose.views : nullptr,
                          chosen);
}

Image MotionPoint::show(const Posed& pose, const MethodFrames::Rendered& rendered, int eye) const {
    const auto e = static_cast<std::size_t>(eye);
    Image picture = rendered.readPicture(eye);
    return axes_ ? showTurned(picture, pose.pictures.eyes[e], pose.views.eyes[e]) : picture;
}

void MotionPoint::chooseAs(const MotionPoint& timed) {
    for (std::size_t i = 0; i < sequences_.size(); ++i) { sequences_[i].chosen = timed.sequences_[i].chosen; }
}

void MotionPoint::timeTwoPass(const Posed& pose) {
    if (std::ranges::none_of(sequences_, [](const MethodHistory& sequence) {
            return sequence.governor && sequence.frame_time.unit == FrameTime::kShareOfTwoPass;
        })) {
        return;
    }
    two_pass_ms_.push_back(render(pose, two_pass_, false).result.gpu_total_ms);
    if (first_two_pass_ms_ == 0.0) { first_two_pass_ms_ = two_pass_ms_.front(); }
    if (two_pass_ms_.size() > kRecentTwoPasses) { two_pass_ms_.pop_front(); }
}

std::pair<double, double> MotionPoint::timeAndLimit(const FrameTime& limit, double ms) const {
    if (limit.unit == FrameTime::kMs) { return {ms, limit.amount}; }
    // As if neither the machine nor what is in view had changed since the first pose.
    const double now_ms = median({two_pass_ms_.begin(), two_pass_ms_.end()});
    if (!(now_ms > 0.0)) { return {0.0, limit.amount}; }  // the device does not measure it
    return {ms * first_two_pass_ms_ / now_ms, limit.amount * first_two_pass_ms_};
}

MethodFrames::Rendered MotionPoint::render(const Posed& pose, MethodHistory& sequence) {
    if (!sequence.governor) { return render(pose, sequence.method, true); }
    Governor& governor = *sequence.governor;
    governor.wish(Quality::kBalanced, Mode::kTemporal, {sequence.method.stereo.warp.budget, 1.0});
    if (sequence.next == sequence.chosen.size()) { sequence.chosen.push_back(governor.settings()); }
    MethodFrames::Rendered rendered = render(pose, sequence.method, true, sequence.chosen[sequence.next++]);
    const auto [ms, most_ms] = timeAndLimit(sequence.frame_time, rendered.result.gpu_total_ms);
    governor.measure({.gpu_ms = ms,
                      .period_ms = most_ms,
                      .work = rendered.result.work_rendered,
                      .warp_error = rendered.result.warp_error,
                      .half_loss = rendered.result.half_loss,
                      .is_full = !rendered.result.counters.warped});
    return rendered;
}

void MotionPoint::warm(const Cameras& cameras) {
    const Posed pose = posed(cameras);
    for (const MethodHistory& sequence : sequences_) { render(pose, sequence.method, true); }
}

std::vector<FrameResult> MotionPoint::time(const Cameras& cameras) {
    std::vector<FrameResult> results;
    const Posed pose = posed(cameras);
    timeTwoPass(pose);
    for (MethodHistory& sequence : sequences_) { results.push_back(render(pose, sequence).result); }
    return results;
}

void MotionPoint::pass(const Cameras& cameras) {
    const Posed pose = posed(cameras);
    timeTwoPass(pose);
    for (MethodHistory& sequence : sequences_) {
        if (hasHistory(sequence.method.stereo.mode)) { render(pose, sequence); }
    }
}

void MotionPoint::rememberStill(const Cameras& cameras) {
    const Posed pose = posed(cameras);
    for (const MethodHistory& sequence : sequences_) {
        shared_.stereo.order = sequence.method.stereo.order;
        if (still_.contains(shared_.stereo.order)) { continue; }
        const MethodFrames::Rendered still = render(pose, shared_, false);
        still_[shared_.stereo.order] = {show(pose, still, kLeft), show(pose, still, kRight)};
    }
}

MotionPoint::FullRender MotionPoint::renderFull(const Posed& pose) {
    const MethodFrames::Rendered both = render(pose, shared_, false);
    FullRender full{
        {show(pose, both, kLeft), show(pose, both, kRight)}, {}, std::max(pairsOf(both.result), 1.0)};
    if (!camera_.headset.empty()) {
        if (!lens_) { lens_.emplace(pose.views); }
        full.seen = lens_->show(full.eyes);
    }
    return full;
}

void MotionPoint::play(const Cameras& cameras, std::size_t number, double time_s,
                       std::vector<MotionFrame>& result) {
    std::map<std::optional<Order>, FullRender> full_by_order;
    const Posed pose = posed(cameras);
    timeTwoPass(pose);
    for (MethodHistory& sequence : sequences_) {
        shared_.stereo.order = sequence.method.stereo.order;
        FullRender& full = full_by_order[shared_.stereo.order];
        if (full.pairs == 0.0) { full = renderFull(pose); }
        const FullRender& before = full_before_[shared_.stereo.order];
        const MethodFrames::Rendered rendered = render(pose, sequence);
        MotionFrame row;
        row.point = name_;
        row.method = sequence.method.name;
        row.mode = sequence.method.stereo.mode;
        row.exact = sequence.method.isExact();
        row.number = number;
        row.time_s = time_s;
        setTimes(row, rendered.result);
        if (sequence.governor) { row.chosen = sequence.chosen[sequence.next - 1]; }
        row.warp_error = rendered.result.warp_error;
        row.half_loss = rendered.result.half_loss;
        row.work_rendered = pairsOf(rendered.result) / full.pairs;
        std::array<Image, 2> pictures;
        for (const int eye : {kLeft, kRight}) {
            const auto e = static_cast<std::size_t>(eye);
            row.full_change += 0.5 * meanChange(full.eyes[e], before.eyes[e]);
            if (row.exact) { continue; }
            pictures[e] = show(pose, rendered, eye);
            Image error = subtract(pictures[e], full.eyes[e]);
            row.mean_square[e] = compare(pictures[e], full.eyes[e]).mean_square;
            row.flicker[e] = meanChange(error, sequence.error[e]);
            sequence.error[e] = std::move(error);
        }
        if (!row.exact) {
            row.pixels_warped = pixelsWarped(rendered.result);
            row.visible = findVisibleErrors(pictures, full.eyes);
            if (lens_) { row.seen = lens_->find(lens_->show(pictures), full.seen); }
            // If axes stay, tiles of the view are not the picture's.
            if (!sequence.governor && !axes_) {
                row.bounded = boundedTilesOf(row.visible, *rendered.frame, sequence.method);
            }
            if (const auto still = still_.find(shared_.stereo.order); still != still_.end()) {
                const Moved moved = compareMoved(pictures, full.eyes, still->second);
                row.moved_share = moved.share;
                row.moved_square = moved.mean_square;
            }
        }
        result.push_back(std::move(row));
    }
    full_before_ = std::move(full_by_order);
    still_.clear();
}

}  // namespace binosplat
