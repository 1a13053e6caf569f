// Statistics of repeated measurements.
#pragma once

#include <vector>

namespace binosplat {

double median(std::vector<double> values);
// The least value that `share` of the values do not exceed (nearest rank); 0 if there are none.
double percentile(std::vector<double> values, double share);

}  // namespace binosplat
