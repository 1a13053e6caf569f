// XR_RUNTIME_JSON, unless the program runs as administrator, or the registry, where a runtime's own settings put it.
#include "xr/runtime_place.h"

#include "engine/platform.h"

namespace binosplat::xr {

// Windows Mixed Reality's own runtime has no Vulkan.
const char* const kRuntimeHint =
    "choose one: SteamVR, Settings > OpenXR > Set SteamVR as OpenXR runtime (also for Windows Mixed Reality, whose own has no Vulkan); "
    "Meta Quest Link, Settings > General > OpenXR Runtime; or try `binosplat view SCENE --simulate`";

std::string whereRuntimeIs() {
    const std::string chosen = environment("XR_RUNTIME_JSON"),
                      registered = "ActiveRuntime in HKEY_LOCAL_MACHINE\\SOFTWARE\\Khronos\\OpenXR\\1 of the registry";
    if (chosen.empty()) { return registered; }
    if (!runsAsAdministrator()) { return "XR_RUNTIME_JSON=" + chosen; }
    return registered + " (the loader leaves XR_RUNTIME_JSON out of account in a program that runs as administrator)";
}

}  // namespace binosplat::xr
