// The OpenXR runtime and the headset behind it.
#pragma once

#include "engine/gpu/context.h"
#include "xr/own.h"
#include "xr/troubles.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace binosplat::xr {

inline constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;

// The runtime exists but fails to start (XR_ERROR_RUNTIME_FAILURE); it may have printed the reason itself.
class RuntimeFailed : public Error {
public:
    using Error::Error;
};

struct InstanceOptions {
    bool depth = true;            // the program has depth for the runtime
    bool visibility_mask = true;  // some runtimes offer the function but crash in it
    bool eye_tracking = false;    // the wearer allows this program to see the gaze
    bool foveated_inset = false;  // the program can draw insets, see extensions/foveated_inset.h
    // Called repeatedly, with a pause of its own, while the runtime knows of a headset that is not there yet.
    // Without it there is no wait.
    std::function<void(const std::string& runtime)> wait_for_headset;
};

class Instance {
public:
    // Asks for API 1.0 and XR_KHR_vulkan_enable2; uses the extensions of extensions/ and bindings.h that are
    // available. Throws Error (exit code 3, one line with what was looked for) if there is no runtime or no
    // headset, and rethrows from `wait_for_headset`.
    explicit Instance(const InstanceOptions& options = {});
    // After a session is lost, which may mean that the headset was unplugged: finds it again, or another one
    // in its place, for a session on `context`. False while there is none. Throws Lost, InstanceLost, and
    // Error (exit code 3) if the headset is now on another graphics device.
    bool findHeadset(const Context& context);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    [[nodiscard]] XrInstance handle() const { return instance_.get(); }
    [[nodiscard]] XrSystemId system() const { return system_; }
    // "Monado: Rift S", for people.
    [[nodiscard]] const std::string& description() const { return description_; }
    // True if it is enabled: the runtime has it, and it was wanted.
    [[nodiscard]] bool hasExtension(std::string_view name) const { return extensions_.contains(name); }
    [[nodiscard]] bool takesDepth() const {
        return hasExtension(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
    }
    // The extension is enabled, and this headset finds hands.
    [[nodiscard]] bool tracksHands() const { return tracks_hands_; }
    // The extension is enabled, and this headset tracks the gaze.
    [[nodiscard]] bool tracksEyes() const { return tracks_eyes_; }
    // See findsMovingInset().
    [[nodiscard]] bool movesInsets() const { return moves_insets_; }
    // The recommended pixels of an eye, the larger of both, since the methods need eyes of one size; and the
    // maximum.
    [[nodiscard]] glm::uvec2 recommendedSizePx() const { return recommended_size_px_; }
    [[nodiscard]] glm::uvec2 maxSizePx() const { return max_size_px_; }
    // How layers are blended with the world: opaque if the headset can, otherwise its preference; if
    // `see_through`, with the room visible behind them, if it can. Where the room is a layer of its own, see
    // Passthrough, they stay opaque.
    [[nodiscard]] XrEnvironmentBlendMode blendMode(bool see_through) const {
        return see_through && see_through_ && !hasPassthrough() ? *see_through_ : blend_mode_;
    }
    [[nodiscard]] bool canSeeThrough() const { return see_through_.has_value() || passes_through_; }
    // The room is shown by a layer: the extension is enabled, this headset has cameras, and its pictures do
    // not cover the room by their alpha.
    [[nodiscard]] bool hasPassthrough() const {
        return passes_through_ && see_through_ != XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND;
    }

    [[nodiscard]] XrPath path(const char* text) const;
    // Fills an extension's XrSystem...Properties, whose type is set, for the current headset.
    void readProperties(void* of_extension) const;
    // The optional features that this headset is used without.
    [[nodiscard]] Troubles& troubles() const { return troubles_; }
    // A function of an extension. Throws Error if the runtime lists the extension but lacks the function.
    template <typename Function>
    [[nodiscard]] Function function(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        checkResult(xrGetInstanceProcAddr(handle(), name, &found), name);
        return reinterpret_cast<Function>(found);
    }

private:
    void create(const InstanceOptions& options);
    void findSystem(const InstanceOptions& options);
    // Read the features of the headset system_.
    void readSystem();
    void readViews();
    void readBlendModes();

    OwnedInstance instance_;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    std::string runtime_name_, description_;
    std::set<std::string, std::less<>> extensions_;
    bool tracks_hands_ = false, tracks_eyes_ = false, moves_insets_ = false, passes_through_ = false;
    glm::uvec2 recommended_size_px_{0, 0}, max_size_px_{0, 0};
    XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    std::optional<XrEnvironmentBlendMode> see_through_;
    mutable Troubles troubles_;  // of all sessions
};

}  // namespace binosplat::xr
