// XR_RUNTIME_JSON, or active_runtime.json of the user or the system.
#include "xr/runtime_place.h"

#include "engine/platform.h"

namespace binosplat::xr {

std::string runtimeHint() {
    return "start one (Monado, SteamVR, WiVRn) or try `binosplat view SCENE --simulate`";
}

std::string whereRuntimeIs() {
    const std::string chosen = environment("XR_RUNTIME_JSON");
    return !chosen.empty() ? "XR_RUNTIME_JSON=" + chosen : "openxr/1/active_runtime.json";
}

}  // namespace binosplat::xr
