// A regression over the knobs that were in use.
#include "app/view/governor/knobs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace binosplat {

namespace {

// The work that a bound takes grows by 4 to 12 % a dB: a higher one may cost the most, a lower one save the least. Errors fall so much a
// dB.
constexpr double kWorkUpPerDb = 0.1, kWorkDownPerDb = 0.05, kErrorDbPerDb = 0.6;
// Before anything is measured: a picture of a room, and what `temporal` is off by within a bound.
constexpr double kUsualLoss = 2e-4, kUsualBelowBoundDb = 14.0;
// A guess at the shares of a frame's time. Few visits cannot tell all four apart, and leave the others near it.
constexpr std::array<double, 4> kUsualShares{0.1, 0.15, 0.45, 0.5};
constexpr double kTrustInUsual = 0.0005;
constexpr std::size_t kMostVisits = 8;
constexpr int kFitRounds = 24;  // from the frame before's on
constexpr double kSmoothing = 0.15;
// The head may move again as it did lately: work and errors fall slowly, by half in ten seconds at 90 Hz.
constexpr double kFading = 0.99923;
// All visits take longer, or all less, when the scene or the device's clock has changed.
constexpr double kChangedTime = 0.12;
constexpr int kSeenForChange = 3;

double follow(double value, double now) { return now > value ? value + kSmoothing * (now - value) : std::max(now, value * kFading); }

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
    return std::min(work_ * std::exp((up_db > 0.0 ? kWorkUpPerDb : kWorkDownPerDb) * up_db), 1.0);
}

void KnobModel::add(const Knobs& knobs, const KnobFrame& frame) {
    const double pixels = knobs.scale * knobs.scale;
    if (!knows()) {
        work_ = frame.work;
        warp_error_ = frame.warp_error > 0.0 ? frame.warp_error : std::pow(10.0, -0.1 * (knobs.bound_db + kUsualBelowBoundDb));
        loss_ = frame.half_loss > 0.0 ? frame.half_loss * pixels / 3.0 : kUsualLoss;
    } else if (visits_.back().knobs != knobs) {
        work_ = workAt(knobs.bound_db);
        warp_error_ *= std::pow(10.0, 0.1 * kErrorDbPerDb * (visits_.back().knobs.bound_db - knobs.bound_db));
    }
    const auto before = std::ranges::find(visits_, knobs, &Visit::knobs);
    if (before == visits_.end()) {
        visits_.push_back({knobs, frame.ms, frame.work, 0});
        if (visits_.size() > kMostVisits) { visits_.erase(visits_.begin()); }
    } else if (before + 1 != visits_.end()) {
        std::rotate(before, before + 1, visits_.end());
        visits_.back().frames = std::min(visits_.back().frames, kSeenForChange);
    }
    noteChange(frame);
    Visit& now = visits_.back();
    const double weight = 1.0 / std::min(++now.frames, 8);
    now.ms += weight * (frame.ms - now.ms);
    now.work += weight * (frame.work - now.work);
    work_ = follow(work_, frame.work);
    if (frame.warp_error > 0.0) { warp_error_ = follow(warp_error_, frame.warp_error); }
    if (frame.half_loss > 0.0) { loss_ += kSmoothing * (frame.half_loss * pixels / 3.0 - loss_); }
    fit();
}

void KnobModel::noteChange(const KnobFrame& frame) {
    const Visit& now = visits_.back();
    if (now.frames < kSeenForChange) { return; }
    const double ratio = frame.ms / sumOf(termsOf(now.knobs.scale, frame.work), shares_);
    if (std::abs(std::log(ratio)) < kChangedTime) {
        changed_ = 0;
        return;
    }
    changed_ratio_ = changed_ == 0 ? ratio : 0.5 * (changed_ratio_ + ratio);
    if (++changed_ < kSeenForChange) { return; }
    for (Visit& visit : visits_) { visit.ms *= changed_ratio_; }
    changed_ = 0;
}

// Shares of at least 0 that fit the visits' times, relatively, and stay near the usual ones where the visits do not say: coordinate
// descent.
void KnobModel::fit() {
    const Visit& now = visits_.back();
    Terms usual = kUsualShares;
    const double all = now.ms / sumOf(termsOf(now.knobs.scale, now.work), usual);
    for (double& share : usual) { share *= all; }
    if (visits_.size() == 1 && now.frames == 1) { shares_ = usual; }
    for (int round = 0; round < kFitRounds; ++round) {
        for (std::size_t i = 0; i < shares_.size(); ++i) {
            double square = kTrustInUsual / (usual[i] * usual[i]), product = square * usual[i];
            for (const Visit& visit : visits_) {
                const Terms terms = termsOf(visit.knobs.scale, visit.work);
                const double rest = visit.ms - (sumOf(terms, shares_) - terms[i] * shares_[i]);
                const double weight = (&visit == &now ? 4.0 : 1.0) / (visit.ms * visit.ms);
                square += weight * terms[i] * terms[i];
                product += weight * terms[i] * rest;
            }
            shares_[i] = std::max(product / square, 0.0);
        }
    }
    // The present frames are right.
    const double expected = sumOf(termsOf(now.knobs.scale, now.work), shares_);
    for (double& share : shares_) { share *= now.ms / expected; }
}

double KnobModel::expectedMs(const Knobs& knobs) const { return sumOf(termsOf(knobs.scale, workAt(knobs.bound_db)), shares_); }

double KnobModel::expectedError(const Knobs& knobs) const {
    const double over_db = knobs.bound_db - visits_.back().knobs.bound_db;
    return loss_ * (1.0 / (knobs.scale * knobs.scale) - 1.0) + warp_error_ * std::pow(10.0, -0.1 * kErrorDbPerDb * over_db);
}

Knobs KnobModel::best(double most_ms, const KnobLimits& limits) const {
    std::optional<Knobs> best;
    Knobs quickest{limits.least_scale * limits.whole, std::min(kLastBoundDb, limits.most_bound_db)};
    const auto consider = [&](const Knobs& knobs) {
        if (expectedMs(knobs) > most_ms || (best && expectedError(knobs) >= expectedError(*best))) { return; }
        best = knobs;
    };
    for (double tenths = 10.0; tenths >= 10.0 * limits.least_scale - 1e-6; --tenths) {
        const double scale = std::round(10.0 * limits.whole * tenths) / 100.0;
        for (double bound_db = limits.most_bound_db; bound_db >= std::min(kLeastBoundDb, limits.most_bound_db); --bound_db) {
            consider({scale, bound_db});
        }
        quickest.scale = scale;
    }
    for (double bound_db = kLeastBoundDb - 1.0; !best && bound_db >= quickest.bound_db; --bound_db) {
        consider({quickest.scale, bound_db});
    }
    return best.value_or(quickest);
}

}  // namespace binosplat
