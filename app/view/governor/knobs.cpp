// A regression over the settings that were in use.
#include "app/view/governor/knobs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace binosplat {

namespace {

// The work that a bound takes grows by 4 to 12 % per dB. A higher bound is assumed to cost the most, a lower
// one to save the least. Errors fall by this much per dB.
constexpr double kWorkUpPerDb = 0.1, kWorkDownPerDb = 0.05, kErrorDbPerDb = 0.6, kMostWorkPerDb = 0.2;
// Before anything is measured: an indoor picture, and the error of `temporal` within a bound.
constexpr double kUsualLoss = 1e-4, kUsualBelowBoundDb = 14.0;
// A guess at the shares of a frame's time. A few visits cannot determine all four, and leave the others near
// this guess.
constexpr std::array<double, 4> kUsualShares{0.1, 0.15, 0.45, 0.5};
constexpr double kTrustInUsual = 0.0005;
constexpr std::size_t kMostVisits = 8, kMostFrames = 9;
// By half in four seconds.
constexpr double kLeastWeight = 0.05, kForgottenPerSecond = 0.84;
constexpr int kFitRounds = 24;  // starting from the previous frame's
constexpr double kSmoothing = 0.15, kLossSmoothing = 0.05;
// The head may soon move again as before, so work and errors fall slowly, by half in ten seconds.
constexpr double kFadingPerSecond = 0.933;
// All visits take longer, or all take less time, if the scene or the device's clock rate has changed.
constexpr double kChangedTime = 0.12;
constexpr std::size_t kSeenForChange = 3, kLastingChange = 12;

// The lower of the two middle values, since disturbances make frames slower.
double lowerMedianOf(std::deque<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void pushNew(std::deque<double>& values, double value) {
    values.push_back(value);
    if (values.size() > kMostFrames) { values.pop_front(); }
}

// The loss at half of a resolution is 7 / scale^3 times this.
double lossOf(double half_loss, double scale) { return half_loss * scale * scale * scale / 7.0; }

double follow(double value, double now, double seconds) {
    return now > value ? value + kSmoothing * (now - value)
                       : std::max(now, value * std::pow(kFadingPerSecond, seconds));
}

}  // namespace

KnobModel::Terms KnobModel::termsOf(double scale, double work) {
    const double pixels = scale * scale;
    return {1.0, pixels, work, pixels * work};
}

double KnobModel::sumOf(const Terms& terms, const Terms& shares) {
    return std::inner_product(terms.begin(), terms.end(), shares.begin(), 0.0);
}

double KnobModel::workAt(double bound_db) const {
    const double up_db = bound_db - visits_.back().knobs.bound_db;
    const double per_db = up_db > 0.0 ? std::max(work_per_db_, kWorkUpPerDb) : kWorkDownPerDb;
    return std::min(work_ * std::exp(per_db * up_db), 1.0);
}

void KnobModel::add(const Knobs& knobs, const KnobFrame& frame) {
    if (!knows()) {
        work_ = frame.work;
        warp_error_ = frame.warp_error > 0.0 ? frame.warp_error
                                             : std::pow(10.0, -0.1 * (knobs.bound_db + kUsualBelowBoundDb));
        loss_ = kUsualLoss;
    } else if (visits_.back().knobs != knobs) {
        work_ = workAt(knobs.bound_db);
        warp_error_ *= std::pow(10.0, 0.1 * kErrorDbPerDb * (visits_.back().knobs.bound_db - knobs.bound_db));
    }
    of_kind_ = full_ == frame.is_full ? of_kind_ + 1 : 1;
    full_ = frame.is_full;
    enter(knobs, full_);
    noteChange(frame);
    for (Visit& visit : visits_) {
        visit.weight = std::max(visit.weight * std::pow(kForgottenPerSecond, frame.seconds), kLeastWeight);
    }
    Visit& now = visits_.back();
    pushNew(now.all_ms, frame.ms);
    pushNew(now.all_work, frame.work);
    now.ms = lowerMedianOf(now.all_ms);
    now.work = lowerMedianOf(now.all_work);
    now.weight = 1.0;
    if (!full_ && visits_.size() > 1 && !visits_[visits_.size() - 2].is_full &&
        now.all_ms.size() == kSeenForChange) {
        learnWork(visits_[visits_.size() - 2], now);
    }
    if (!full_) { work_ = knows_work_ ? follow(work_, frame.work, frame.seconds) : frame.work; }
    knows_work_ = knows_work_ || !full_;
    if (frame.warp_error > 0.0) { warp_error_ = follow(warp_error_, frame.warp_error, frame.seconds); }
    // Once losses have been measured, a frame without one had no loss on its few tiles.
    if (!full_ && (frame.half_loss > 0.0 || losses_ > 0)) {
        loss_ += std::max(1.0 / ++losses_, kLossSmoothing) * (lossOf(frame.half_loss, knobs.scale) - loss_);
    }
    fit();
}

bool KnobModel::mayBeChanging() const {
    const bool had_other_kind =
        std::ranges::any_of(visits_, [&](const Visit& visit) { return visit.is_full != full_; });
    return changed_ >= kSeenForChange || (had_other_kind && of_kind_ < kLastingChange);
}

void KnobModel::learnWork(const Visit& before, const Visit& now) {
    const double up_db = now.knobs.bound_db - before.knobs.bound_db;
    if (up_db == 0.0 || !(now.work > 0.0) || !(before.work > 0.0)) { return; }
    work_per_db_ = std::clamp(std::log(now.work / before.work) / up_db, 0.0, kMostWorkPerDb);
}

void KnobModel::enter(const Knobs& knobs, bool is_full) {
    const auto isThis = [&](const Visit& visit) { return visit.knobs == knobs && visit.is_full == is_full; };
    if (knows() && isThis(visits_.back())) { return; }
    settling_ = kMostFrames;
    doubted_ratio_ = changed_ >= kSeenForChange ? changed_ratio_ : 1.0;
    changed_ = 0;
    shares_before_ = shares_;
    const auto before = std::ranges::find_if(visits_, isThis);
    if (before == visits_.end()) {
        visits_.push_back({knobs, is_full});
        if (visits_.size() > kMostVisits) { visits_.erase(visits_.begin()); }
        return;
    }
    std::rotate(before, before + 1, visits_.end());
    visits_.back().all_ms.assign(kSeenForChange, visits_.back().ms);
    visits_.back().all_work.assign(kSeenForChange, visits_.back().work);
}

void KnobModel::scaleTimes(double ratio, std::size_t visits) {
    for (Visit& visit : std::span(visits_).first(visits)) {
        visit.ms *= ratio;
        for (double& ms : visit.all_ms) { ms *= ratio; }
    }
}

void KnobModel::noteChange(const KnobFrame& frame) {
    const Visit& now = visits_.back();
    const auto ratioTo = [&](const Terms& shares, double ms, double work) {
        return ms / sumOf(termsOf(now.knobs.scale, work), shares);
    };
    if (now.all_ms.size() == kSeenForChange && doubted_ratio_ != 1.0) {
        const double seen = std::log(ratioTo(shares_before_, now.ms, now.work)),
                     doubted = std::log(doubted_ratio_);
        if (std::abs(seen - doubted) < std::abs(seen)) { scaleTimes(doubted_ratio_, visits_.size() - 1); }
        doubted_ratio_ = 1.0;
    }
    if (now.all_ms.size() < kSeenForChange) { return; }
    // The fit follows the present frames, and would hide a change that comes slowly.
    const double ratio = ratioTo(settling_ > 0 ? shares_ : settled_, frame.ms, frame.work);
    if (std::abs(std::log(ratio)) < kChangedTime) {
        changed_ = 0;
        return;
    }
    changed_ratio_ = changed_ == 0 ? ratio : 0.5 * (changed_ratio_ + ratio);
    if (++changed_ < kLastingChange) { return; }
    scaleTimes(changed_ratio_, visits_.size() - 1);
    settling_ = kMostFrames;
    changed_ = 0;
}

KnobModel::Terms KnobModel::usualShares() const {
    const Visit& now = visits_.back();
    Terms usual = kUsualShares;
    const double all = now.ms / sumOf(termsOf(now.knobs.scale, now.work), usual);
    for (double& share : usual) { share *= all; }
    return usual;
}

// Finds shares of at least 0 that fit the visits' times in relative terms, and stay near the usual ones where
// the visits say nothing, by coordinate descent.
void KnobModel::fit() {
    const Visit& now = visits_.back();
    const Terms usual = usualShares();
    if (visits_.size() == 1 && now.all_ms.size() == 1) { shares_ = usual; }
    for (int round = 0; round < kFitRounds; ++round) {
        for (std::size_t i = 0; i < shares_.size(); ++i) {
            double square = kTrustInUsual / (usual[i] * usual[i]), product = square * usual[i];
            for (const Visit& visit : visits_) {
                const Terms terms = termsOf(visit.knobs.scale, visit.work);
                const double rest = visit.ms - (sumOf(terms, shares_) - terms[i] * shares_[i]);
                const double weight = (&visit == &now ? 4.0 : visit.weight) / (visit.ms * visit.ms);
                square += weight * terms[i] * terms[i];
                product += weight * terms[i] * rest;
            }
            shares_[i] = std::max(product / square, 0.0);
        }
    }
    // The present frames are reliable.
    const double expected = sumOf(termsOf(now.knobs.scale, now.work), shares_);
    for (double& share : shares_) { share *= now.ms / expected; }
    if (settling_ == 0) { return; }
    settled_ = shares_;
    --settling_;
}

double KnobModel::expectedError(const Knobs& knobs) const {
    const double over_db = knobs.bound_db - visits_.back().knobs.bound_db;
    const double warp_error = full_ ? 0.0 : warp_error_ * std::pow(10.0, -0.1 * kErrorDbPerDb * over_db);
    return loss_ * (std::pow(knobs.scale, -3.0) - 1.0) + warp_error;
}

Knobs KnobModel::best(double most_ms, const KnobLimits& limits) const {
    return bestBy(shares_, most_ms, limits);
}

Knobs KnobModel::bestAsUsual(double ratio, const KnobLimits& limits) const {
    const Terms usual = usualShares();
    return bestBy(usual, ratio * msBy(usual, visits_.back().knobs), limits);
}

Knobs KnobModel::bestBy(const Terms& shares, double most_ms, const KnobLimits& limits) const {
    std::optional<Knobs> best;
    Knobs quickest{limits.whole, std::min(kLeastBoundDb, limits.most_bound_db)};
    const double least_scale = governedScale(limits.whole, 10.0 * limits.least_scale);
    for (double tenths = 10.0; tenths >= 10.0 * limits.least_scale - 1e-6; --tenths) {
        quickest.scale = governedScale(limits.whole, tenths);
        for (double bound_db = limits.most_bound_db; bound_db >= quickest.bound_db; --bound_db) {
            const Knobs knobs{quickest.scale, bound_db};
            // A low bound shows as streaks that the mean error hides: a smaller picture comes first.
            if (bound_db < kLeastWhileScaleGives && knobs.scale > least_scale) { continue; }
            const bool is_better = !best || expectedError(knobs) < expectedError(*best);
            if (is_better && msBy(shares, knobs) <= most_ms) { best = knobs; }
        }
    }
    return best.value_or(quickest);
}

}  // namespace binosplat
