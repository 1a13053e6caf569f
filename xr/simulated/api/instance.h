// Chapters 4 and 5: an instance, its system, and all that lives as long as they do.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "xr/simulated/api/bindings.h"
#include "xr/simulated/api/events.h"
#include "xr/simulated/api/handles.h"
#include "xr/simulated/api/messages.h"
#include "xr/simulated/api/paths.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/api/simulation.h"

namespace simulated {

struct Session;

struct Instance : Object, Enabled {
    using Handle = XrInstance;

    Paths paths;
    Events events;
    std::unique_ptr<Simulation> simulation;
    // Announced by the script; calls fail once the grace is over.
    std::optional<XrTime> lost_from;
    // The application's suggestions, by interaction profile, in the order of their latest suggestions.
    std::vector<SuggestedProfile> suggestions;
    bool has_asked_requirements = false;
    ObjectNames object_names;
    // The device of xrGetVulkanGraphicsDevice(2)KHR and its VkInstance, and the source of each VkInstance's
    // functions.
    VkPhysicalDevice graphics_device = VK_NULL_HANDLE;
    VkInstance graphics_instance = VK_NULL_HANDLE;
    std::map<VkInstance, PFN_vkGetInstanceProcAddr> vulkan_loaders;
    Session* session = nullptr;

    ~Instance() override {
        endChildren(*this);
        Simulation::end(std::move(simulation));
    }

    [[nodiscard]] bool has(const Profile& profile) const { return meets(profile.depends); }
    // /user/eyes_ext exists only with the extension.
    [[nodiscard]] bool hasUserPath(std::string_view path) const {
        return isUserPath(path) &&
               (path != "/user/eyes_ext" || extensions.contains(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME));
    }
    // Features in the core since 1.1, and in 1.0 with an extension.
    [[nodiscard]] bool has1_1Or(const char* extension) const {
        return is_1_1 || extensions.contains(extension);
    }
    // The system's for an instance that the application made without this runtime. XR_ERROR_RUNTIME_FAILURE
    // if there is none.
    [[nodiscard]] PFN_vkGetInstanceProcAddr vulkanLoaderOf(VkInstance vulkan_instance) const;
};

// XR_ERROR_INSTANCE_LOST.
void checkNotLost(const Instance& instance);
constexpr XrResult successOf(const Instance&, XrResult success) { return success; }

constexpr XrSystemId kSystemId = 1;
constexpr std::uint32_t kMostLayers = XR_MIN_COMPOSITION_LAYERS_SUPPORTED;
constexpr std::uint32_t kMostSwapchainPixels = 16384;

// XR_ERROR_SYSTEM_INVALID.
void checkSystem(XrSystemId system);

}  // namespace simulated
