// Amounts whose unit the user chooses.
#pragma once

#include "engine/setup/settings.h"

#include <cstdint>

namespace binosplat {

inline constexpr std::uint64_t kMaxSplats = std::uint64_t{1} << 31;

// How much of a scene to keep.
struct Keep {
    double amount = 1.0;
    enum Unit { kShare, kSplats, kBytes } unit = kShare;
};
// A share, a number of splats, or a size such as 50MB.
Keep readKeep(const Setting& setting);

// How long a frame may take.
struct FrameTime {
    double amount = 0.0;  // 0: as long as it takes
    enum Unit { kMs, kShareOfTwoPass } unit = kMs;
    bool operator==(const FrameTime&) const = default;
};
// A number of ms, or a share of the time of `two-pass`, such as 70%.
FrameTime readFrameTime(const Setting& setting);

}  // namespace binosplat
