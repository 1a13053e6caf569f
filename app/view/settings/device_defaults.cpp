// Chosen by what drivers report.
#include "app/view/settings/device_defaults.h"

#include "app/view/governor/splat_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace binosplat {

namespace {

constexpr std::uint64_t kGibibyte = std::uint64_t{1} << 30, kSmallBelow = 8 * kGibibyte;
// A million splats take 96 MB for the scene and 60 to 120 for lists, so a gibibyte holds one million; the
// rest of the memory belongs to everyone else.
constexpr std::uint64_t kSplatsPerGibibyte = 1'000'000;

}  // namespace

DeviceDefaults defaultsOf(std::string_view device_name, bool is_integrated, std::uint64_t memory_bytes) {
    constexpr std::array<std::string_view, 3> kNames{"Turnip", "Panfrost", "Mali"};
    const bool is_named = std::ranges::any_of(
        kNames, [&](std::string_view name) { return device_name.find(name) != std::string_view::npos; });
    if (!is_integrated || (!is_named && memory_bytes >= kSmallBelow)) { return {}; }
    return {.quality = Quality::kFast,
            .resolution_scale = 0.7,
            .refresh_rate = 72.0,
            .sh_degree = 2,
            .most_splats = std::max(SplatBudget::kLeast, memory_bytes / kGibibyte * kSplatsPerGibibyte)};
}

std::string describeDefaults(const DeviceDefaults& defaults) {
    if (defaults == DeviceDefaults{}) { return ""; }
    return fmt::format(
        "quality {}, resolution-scale {:g}, refresh-rate {:g} where offered, sh-degree {}, splat-budget {} "
        "at most",
        kQualityNames[static_cast<int>(defaults.quality)], defaults.resolution_scale, defaults.refresh_rate,
        *defaults.sh_degree, defaults.most_splats);
}

}  // namespace binosplat
