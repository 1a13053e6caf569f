// Order statistics.
#include "app/bench/statistics.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

double median(std::vector<double> values) {
    if (values.empty()) { return 0.0; }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    const double upper = *middle;
    return values.size() % 2 == 1 ? upper : 0.5 * (upper + *std::max_element(values.begin(), middle));
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) { return 0.0; }
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::ranges::nth_element(values, place);
    return *place;
}

}  // namespace binosplat
