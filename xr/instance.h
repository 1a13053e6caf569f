// The OpenXR runtime and the headset behind it.
#pragma once

#include "engine/gpu/context.h"
#include "xr/troubles.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace binosplat::xr {

// The runtime is there, and fails to begin (XR_ERROR_RUNTIME_FAILURE); why, it may have said itself.
class RuntimeFailed : public Error {
public:
    using Error::Error;
};

struct InstanceOptions {
    bool visibility_mask = true;  // some runtimes have nothing behind the function that they offer
    bool eye_tracking = false;    // whether the wearer lets this program see where the eyes look
    // Asked again and again, with a pause of its own, while the runtime knows of a headset that is not there yet. Without it there is no
    // wait.
    std::function<void(const std::string& runtime)> wait_for_headset;
};

class Instance {
public:
    // Asks for API 1.0 and XR_KHR_vulkan_enable2; takes XR_KHR_composition_layer_depth, XR_KHR_visibility_mask, XR_EXT_local_floor,
    // XR_FB_display_refresh_rate, XR_EXT_hand_tracking, on request XR_EXT_eye_gaze_interaction, and those of controllers where they are.
    // Throws Error (exit code 3, one line that says what was looked for) where there is no runtime or no headset, and what
    // `wait_for_headset` throws.
    explicit Instance(const InstanceOptions& options = {});
    // After a session is lost, which may mean that the headset was unplugged: finds it anew, or another one in its place, for a session on
    // `context`. False while there is none. Throws Lost, InstanceLost, and Error (exit code 3) where the headset is on another graphics
    // device now.
    bool findHeadset(const Context& context);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    [[nodiscard]] XrInstance handle() const { return instance_; }
    [[nodiscard]] XrSystemId system() const { return system_; }
    // "Monado: Rift S", for people.
    [[nodiscard]] const std::string& description() const { return description_; }
    [[nodiscard]] bool takesDepth() const { return takes_depth_; }
    [[nodiscard]] bool hasVisibilityMask() const { return has_visibility_mask_; }
    [[nodiscard]] bool hasLocalFloor() const { return has_local_floor_; }
    [[nodiscard]] bool hasRefreshRates() const { return has_refresh_rates_; }
    // It has XR_EXT_hand_tracking, and this headset finds hands.
    [[nodiscard]] bool tracksHands() const { return tracks_hands_; }
    // It has XR_EXT_eye_gaze_interaction, this headset sees where eyes look, and that was asked for.
    [[nodiscard]] bool tracksEyes() const { return tracks_eyes_; }
    // Of those that controllers need.
    [[nodiscard]] bool hasExtension(const std::string& name) const { return controller_extensions_.contains(name); }
    // How many pixels an eye should have, the larger of both: the methods want eyes of one size. And the most it can have.
    [[nodiscard]] glm::uvec2 recommendedSizePx() const { return recommended_size_px_; }
    [[nodiscard]] glm::uvec2 maxSizePx() const { return max_size_px_; }
    // How layers meet the world: opaque where the headset has it, else what it likes best; or so that the room shows behind them, where it
    // has that.
    [[nodiscard]] XrEnvironmentBlendMode blendMode(bool see_through) const {
        return see_through && see_through_ ? *see_through_ : blend_mode_;
    }
    [[nodiscard]] bool canSeeThrough() const { return see_through_.has_value(); }

    // The instance and the device that Context opens must be this runtime's. Valid as long as the instance.
    [[nodiscard]] DeviceMaker deviceMaker() const;

    [[nodiscard]] XrPath path(const char* text) const;
    // What this headset is used without.
    [[nodiscard]] Troubles& troubles() const { return troubles_; }
    // A function of an extension. Throws Error if the runtime lists the extension but lacks the function.
    template <typename Function>
    [[nodiscard]] Function function(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        checkResult(xrGetInstanceProcAddr(instance_, name, &found), name);
        return reinterpret_cast<Function>(found);
    }

private:
    void create(const InstanceOptions& options);
    void findSystem(const InstanceOptions& options);
    // What the headset of system_ has.
    void readSystem();
    void readViews();
    // What the runtime wants to be asked of Vulkan, for each headset.
    [[nodiscard]] XrVersion leastVulkan() const;
    [[nodiscard]] VkPhysicalDevice graphicsDevice(VkInstance vulkan_instance) const;

    XrInstance instance_ = XR_NULL_HANDLE;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    std::string runtime_name_, description_;
    bool knows_hands_ = false, knows_eyes_ = false;  // the runtime, with some headset or other
    bool takes_depth_ = false, has_visibility_mask_ = false, has_local_floor_ = false, has_refresh_rates_ = false, tracks_hands_ = false,
         tracks_eyes_ = false;
    std::set<std::string> controller_extensions_;
    glm::uvec2 recommended_size_px_{0, 0}, max_size_px_{0, 0};
    XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    std::optional<XrEnvironmentBlendMode> see_through_;
    mutable Troubles troubles_;  // of all sessions
};

}  // namespace binosplat::xr
