// Where OpenXR's loader looks for the runtime, which the operating system says: runtime_place_posix.cpp or runtime_place_windows.cpp.
#pragma once

#include <string>

namespace binosplat::xr {

// For messages.
std::string whereRuntimeIs();

// What one can do without a runtime, or with one that does not fit.
extern const char* const kRuntimeHint;

}  // namespace binosplat::xr
