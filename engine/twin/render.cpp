// All passes for one eye, in frame order.
#include "engine/twin/reference.h"

#include <chrono>
#include <utility>

namespace binosplat::reference {
namespace {

// Runs one pass and notes how long it took.
template <typename Work>
auto timePass(const Settings& settings, Pass pass, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    if (settings.seconds != nullptr) {
        settings.seconds[pass] =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return result;
}

}  // namespace

Picture render(const Scene& scene, const Eye& eye, const Settings& asked) {
    Settings settings = asked;
    settings.is_light = scene.is_linear;
    const auto visible = timePass(settings, kCull, [&] { return cull(scene, {&eye, 1}, settings); });
    const auto compacted =
        timePass(settings, kCompact, [&] { return compact(scene, visible, eye, settings); });
    const auto order = timePass(settings, kSortDepth, [&] { return sortDepth(compacted, settings); });
    const auto splats = timePass(settings, kProject, [&] { return project(scene, order, eye, settings); });
    auto pairs = timePass(settings, kBin, [&] { return bin(splats, eye.size_px, settings); });
    const auto ranges = timePass(settings, kSortTiles, [&] {
        sortTiles(pairs, settings);
        return tileRanges(pairs, eye.size_px);
    });
    return timePass(settings, kRasterize, [&] { return rasterize(splats, pairs, ranges, eye, settings); });
}

}  // namespace binosplat::reference
