// OpenXR's handles, each with an owner that destroys it.
#pragma once

#include <openxr/openxr.h>

#include <memory>
#include <type_traits>

namespace binosplat::xr {

template <auto kDestroy>
struct Destroy {
    void operator()(auto handle) const { kDestroy(handle); }
};

template <typename Handle, typename Destroyer>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroyer>;

using OwnedInstance = Owned<XrInstance, Destroy<xrDestroyInstance>>;
using OwnedSpace = Owned<XrSpace, Destroy<xrDestroySpace>>;
using OwnedActionSet = Owned<XrActionSet, Destroy<xrDestroyActionSet>>;

}  // namespace binosplat::xr
