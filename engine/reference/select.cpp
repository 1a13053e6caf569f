// 8g: the tiles of the greatest expected errors.
#include "engine/reference/stereo.h"

#include <algorithm>
#include <numeric>

namespace binosplat::reference {

std::vector<TileKind> select(std::span<const double> errors, std::size_t budget_tiles) {
    std::vector<std::size_t> order(errors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
    std::vector<TileKind> kinds(errors.size(), TileKind::kNone);
    for (std::size_t i = 0; i < std::min(budget_tiles, order.size()) && errors[order[i]] > 0.0; ++i) {
        kinds[order[i]] = TileKind::kPredicted;
    }
    return kinds;
}

}  // namespace binosplat::reference
