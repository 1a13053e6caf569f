// How far the floor is below the wearer, if the runtime knows.
#pragma once

#include "xr/instance.h"

#include <optional>

namespace binosplat::xr {

class Floor {
public:
    // Uses the stage's floor, or else XR_EXT_local_floor.
    Floor(const Instance& instance, XrSession session);

    // The distance of the floor below the origin of `space` in metres; empty if the runtime does not know it.
    [[nodiscard]] std::optional<double> belowMetres(XrSpace space, XrTime time);

private:
    const Instance& instance_;
    OwnedSpace space_;  // somewhere on the floor; null: the runtime has none
};

}  // namespace binosplat::xr
