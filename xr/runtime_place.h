// The places where OpenXR's loader looks for the runtime, by operating system: runtime_place_posix.cpp or
// runtime_place_windows.cpp.
#pragma once

#include <string>

namespace binosplat::xr {

// For messages.
std::string whereRuntimeIs();

// Advice for users without a runtime, or with one that does not fit.
std::string runtimeHint();

}  // namespace binosplat::xr
