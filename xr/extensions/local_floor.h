// XR_EXT_local_floor: a space on the floor, below the wearer. Its names are those of OpenXR 1.1; older
// headers lack them.
#pragma once

#include <openxr/openxr.h>

namespace binosplat::xr {

inline constexpr const char* kLocalFloorExtension = "XR_EXT_local_floor";
inline constexpr auto kLocalFloorSpace = static_cast<XrReferenceSpaceType>(1000426000);

}  // namespace binosplat::xr
