// Finds the floor.
#include "xr/floor.h"

#include "xr/extensions/local_floor.h"
#include "xr/spaces.h"

#include <algorithm>
#include <vector>

namespace binosplat::xr {
namespace {

bool hasStage(const Instance& instance, XrSession session) {
    std::vector<XrReferenceSpaceType> offered;
    instance.troubles().tryFor("the stage's floor", [&] {
        offered = listAll<XrReferenceSpaceType>(
            [&](auto... step) { BINOSPLAT_XR(xrEnumerateReferenceSpaces(session, step...)); });
    });
    return std::ranges::find(offered, XR_REFERENCE_SPACE_TYPE_STAGE) != offered.end();
}

}  // namespace

Floor::Floor(const Instance& instance, XrSession session) : instance_(instance) {
    const auto tryType = [&](XrReferenceSpaceType type) {
        instance.troubles().tryFor("a floor", [&] { space_ = makeSpace(session, type); });
    };
    if (hasStage(instance, session)) { tryType(XR_REFERENCE_SPACE_TYPE_STAGE); }
    if (!space_ && instance.hasExtension(kLocalFloorExtension)) { tryType(kLocalFloorSpace); }
}

std::optional<double> Floor::belowMetres(XrSpace space, XrTime time) {
    if (!space_) { return std::nullopt; }
    auto location = structure<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    const auto locate = [&] { BINOSPLAT_XR(xrLocateSpace(space_.get(), space, time, &location)); };
    if (!instance_.troubles().tryFor("a floor", locate)) { space_.reset(); }
    if ((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0) { return std::nullopt; }
    return -static_cast<double>(location.pose.position.y);
}

}  // namespace binosplat::xr
