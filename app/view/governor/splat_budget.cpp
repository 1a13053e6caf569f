// Changes the number of splats in steps of an eighth.
#include "app/view/governor/splat_budget.h"

#include <algorithm>

namespace binosplat {

namespace {

constexpr int kFrames = 40;
constexpr double kTooLong = 0.9, kToSpare = 0.6;

}  // namespace

bool SplatBudget::measure(double gpu_ms, double period_ms, std::uint64_t shown) {
    gpu_ms_ += gpu_ms;
    period_ms_ += period_ms;
    if (++frames_ < kFrames) { return false; }
    const double share = period_ms_ > 0.0 ? gpu_ms_ / period_ms_ : 0.0;
    gpu_ms_ = period_ms_ = 0.0;
    frames_ = 0;
    const std::uint64_t before = splats_, least = std::min(kLeast, most_);
    if (share > kTooLong) { splats_ = std::max(least, std::min(splats_, std::max(shown, least)) / 8 * 7); }
    // At most twice the view's needs, so that lowering it has an effect.
    if (share < kToSpare && splats_ / 2 <= shown) { splats_ = std::min(most_, splats_ / 8 * 9); }
    return splats_ != before;
}

}  // namespace binosplat
