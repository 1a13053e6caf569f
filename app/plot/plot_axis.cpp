// An axis of a plot.
#include "app/plot/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace binosplat {

bool PlotAxis::shows(double value) const {
    return std::isfinite(value) && (scale_ == Scale::kLinear || value > 0.0);
}

void PlotAxis::include(double value) {
    low_ = empty_ ? value : std::min(low_, value);
    high_ = empty_ ? value : std::max(high_, value);
    empty_ = false;
}

void PlotAxis::round() {
    if (empty_) { low_ = 1.0, high_ = 10.0; }
    if (scale_ == Scale::kLog) {
        roundLog();
    } else {
        roundLinear();
    }
    low_ = ticks_.front(), high_ = ticks_.back();
    // Beyond three decades, powers of ten are enough; beyond nine, every second, third ... of them.
    const double decades = scale_ == Scale::kLog ? std::log10(high_ / low_) : 0.0;
    if (decades > 3.0) {
        constexpr double kMostDecades = 9.0;  // with a label each
        const double step = std::ceil(decades / kMostDecades);
        std::erase_if(ticks_, [&](double tick) {
            const double steps = std::log10(tick) / step;
            return std::abs(steps - std::round(steps)) * step > 1e-6;
        });
    }
}

// From one of 1, 2 or 5 times a power of ten to another: the last below and the first above; a single value
// gets a margin on both sides.
void PlotAxis::roundLog() {
    const int first = static_cast<int>(std::floor(std::log10(low_))) - 1,
              last = static_cast<int>(std::ceil(std::log10(high_))) + 1;
    std::vector<double> all;
    for (int decade = first; decade <= last; ++decade) {
        for (double digit : {1.0, 2.0, 5.0}) { all.push_back(digit * std::pow(10.0, decade)); }
    }
    constexpr double kSlack = 1.0 + 1e-9;
    const auto above =
        std::ranges::find_if(all, [&](double tick) { return tick * kSlack >= high_ && tick > low_; });
    auto below = above;
    while (*below > low_ * kSlack || below == above) { --below; }
    ticks_.assign(below, above + 1);
}

// Four to eight equal steps of 1, 2 or 5 times a power of ten.
void PlotAxis::roundLinear() {
    const double range = std::max(high_ - low_, 1e-3 * std::max(std::abs(low_), 1e-3));
    const double power = std::pow(10.0, std::floor(std::log10(range / 4.0)));
    double step = power;
    for (double digit : {2.0, 5.0, 10.0}) {
        if (range / step > 8.0) { step = digit * power; }
    }
    const double first = std::floor(low_ / step + 1e-9),
                 last = std::max(std::ceil(high_ / step - 1e-9), first + 1.0);
    for (double i = first; i <= last; i += 1.0) { ticks_.push_back(i * step); }
}

double PlotAxis::share(double value) const {
    return scale_ == Scale::kLog ? std::log(value / low_) / std::log(high_ / low_)
                                 : (value - low_) / (high_ - low_);
}

std::string shortNumber(double value) {
    if (value >= 1e12) { return fmt::format("{:.3g}", value); }
    if (value >= 1e9) { return fmt::format("{:.3g}G", value / 1e9); }
    if (value >= 1e6) { return fmt::format("{:.3g}M", value / 1e6); }
    if (value >= 1e3) { return fmt::format("{:.3g}k", value / 1e3); }
    return fmt::format("{:.3g}", value);
}

}  // namespace binosplat
