// Turns results into names and exceptions.
#include "xr/check.h"

#include <openxr/openxr_reflection.h>

#include <string_view>

namespace binosplat::xr {

std::string nameOf(XrResult result) {
    switch (result) {
#define BINOSPLAT_CASE(name, value) \
    case name:                      \
        return #name;
        XR_LIST_ENUM_XrResult(BINOSPLAT_CASE)
#undef BINOSPLAT_CASE
            default : return fmt::format("result {}", static_cast<int>(result));
    }
}

XrResult checkResult(XrResult result, const char* call) {
    if (XR_SUCCEEDED(result)) { return result; }
    const std::string_view text(call);
    const std::string message =
        fmt::format("OpenXR: {} failed: {}", text.substr(0, text.find('(')), nameOf(result));
    // The second one means that the headset was unplugged after it was found.
    if (result == XR_ERROR_SESSION_LOST || result == XR_ERROR_SYSTEM_INVALID) { throw Lost(message); }
    if (result == XR_ERROR_INSTANCE_LOST) { throw InstanceLost(message); }
    if (result == XR_ERROR_OUT_OF_MEMORY) {
        throw Error(ExitCode::kBadInput, message + ", not enough memory for this scene and picture size");
    }
    throw Error(ExitCode::kNoDevice, message);
}

}  // namespace binosplat::xr
