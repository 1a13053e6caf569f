// XR_RUNTIME_JSON, unless the program runs as administrator, or else the registry, where the runtime's own
// settings put it.
#include "xr/runtime_place.h"

#include "engine/platform.h"

namespace binosplat::xr {

// Also set by --simulate; the loader ignores it in a program that runs as administrator.
static bool isChoiceIgnored() { return !environment("XR_RUNTIME_JSON").empty() && runsAsAdministrator(); }

std::string runtimeHint() {
    if (isChoiceIgnored()) {
        return "start the program without administrator rights, or set that value to " +
               environment("XR_RUNTIME_JSON");
    }
    // Windows Mixed Reality's own runtime does not support Vulkan.
    return "choose one: SteamVR, Settings > OpenXR > Set SteamVR as OpenXR runtime (also for Windows Mixed "
           "Reality, whose own has no "
           "Vulkan); Meta Quest Link, Settings > General > OpenXR Runtime; or try `binosplat view SCENE "
           "--simulate`";
}

std::string whereRuntimeIs() {
    const std::string chosen = environment("XR_RUNTIME_JSON"),
                      registered =
                          "ActiveRuntime in HKEY_LOCAL_MACHINE\\SOFTWARE\\Khronos\\OpenXR\\1 of the registry";
    if (chosen.empty()) { return registered; }
    return isChoiceIgnored() ? registered +
                                   " (the loader leaves XR_RUNTIME_JSON out of account in a program that "
                                   "runs as administrator)"
                             : "XR_RUNTIME_JSON=" + chosen;
}

}  // namespace binosplat::xr
