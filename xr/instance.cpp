// Finding the runtime and the headset.
#include "xr/instance.h"

#include "engine/platform.h"
#include "xr/bindings.h"
#include "xr/extensions/eye_gaze.h"
#include "xr/extensions/foveated_inset.h"
#include "xr/extensions/hand_tracking.h"
#include "xr/extensions/local_floor.h"
#include "xr/extensions/passthrough.h"
#include "xr/extensions/user_presence.h"
#include "xr/extensions/vulkan_enable2.h"
#include "xr/runtime_place.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace binosplat::xr {
namespace {

[[noreturn]] void refuse(const std::string& what, XrResult result) {
    const std::string line = fmt::format("{} ({}); {}", what, nameOf(result), runtimeHint());
    if (result == XR_ERROR_RUNTIME_FAILURE) { throw RuntimeFailed(ExitCode::kNoDevice, line); }
    throw Error(ExitCode::kNoDevice, line);
}

std::vector<XrExtensionProperties> listExtensions() {
    std::uint32_t count = 0;
    XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
    if (XR_FAILED(result)) {
        refuse(fmt::format("no OpenXR runtime found: looked for {}", whereRuntimeIs()), result);
    }
    std::vector<XrExtensionProperties> extensions(count, {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0});
    result = BINOSPLAT_XR(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, extensions.data()));
    extensions.resize(count);
    return extensions;
}

// Used if the runtime has them.
std::vector<const char*> wantedExtensions(const InstanceOptions& options) {
    std::vector<const char*> wanted{kLocalFloorExtension, XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME,
                                    XR_EXT_HAND_TRACKING_EXTENSION_NAME, kUserPresenceExtension,
                                    XR_FB_PASSTHROUGH_EXTENSION_NAME};
    if (options.depth) { wanted.push_back(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME); }
    if (options.eye_tracking) { wanted.push_back(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME); }
    for (const ProfileBindings& profile : allProfileBindings()) {
        if (profile.extension != nullptr) { wanted.push_back(profile.extension); }
    }
    if (options.foveated_inset) {
        wanted.push_back(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
        // The inset's place tells where the eyes look.
        if (options.eye_tracking) { wanted.push_back(XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME); }
    }
    if (options.visibility_mask) { wanted.push_back(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME); }
    return wanted;
}

XrResult getSystem(XrInstance instance, XrSystemId& system) {
    auto wanted = structure<XrSystemGetInfo>(XR_TYPE_SYSTEM_GET_INFO);
    wanted.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    return xrGetSystem(instance, &wanted, &system);
}

}  // namespace

Instance::Instance(const InstanceOptions& options) {
    // The loader prints to stderr if it finds nothing; one line of ours says it better.
    if (environment("XR_LOADER_DEBUG").empty()) { setEnvironment("XR_LOADER_DEBUG", "none"); }
    create(options);
    findSystem(options);
    readSystem();
    readViews();
    readBlendModes();
}

void Instance::create(const InstanceOptions& options) {
    const std::vector<XrExtensionProperties> available = listExtensions();
    const auto enable = [&](const char* name) {
        const auto isIt = [&](const XrExtensionProperties& extension) {
            return std::strcmp(extension.extensionName, name) == 0;
        };
        if (std::ranges::any_of(available, isIt)) { extensions_.insert(name); }
    };
    enable(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME);
    if (extensions_.empty()) {
        refuse("the OpenXR runtime lacks XR_KHR_vulkan_enable2", XR_ERROR_EXTENSION_NOT_PRESENT);
    }
    std::ranges::for_each(wantedExtensions(options), enable);
    std::vector<const char*> names;
    for (const std::string& name : extensions_) { names.push_back(name.c_str()); }

    auto info = structure<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
    std::strcpy(info.applicationInfo.applicationName, "binosplat");
    std::strcpy(info.applicationInfo.engineName, "binosplat");
    info.applicationInfo.applicationVersion = info.applicationInfo.engineVersion = 1;
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
    info.enabledExtensionNames = names.data();
    XrInstance made = XR_NULL_HANDLE;
    const XrResult result = xrCreateInstance(&info, &made);
    if (XR_FAILED(result)) {
        refuse(fmt::format("the OpenXR runtime does not start: looked for {}", whereRuntimeIs()), result);
    }
    instance_.reset(made);
}

void Instance::findSystem(const InstanceOptions& options) {
    auto runtime = structure<XrInstanceProperties>(XR_TYPE_INSTANCE_PROPERTIES);
    BINOSPLAT_XR(xrGetInstanceProperties(handle(), &runtime));
    runtime_name_ = runtime.runtimeName;
    XrResult result = getSystem(handle(), system_);
    while (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE && options.wait_for_headset) {
        options.wait_for_headset(runtime_name_);
        result = getSystem(handle(), system_);
    }
    if (XR_FAILED(result)) {
        refuse(fmt::format("no headset: the OpenXR runtime {} offers none", runtime_name_), result);
    }
}

bool Instance::findHeadset(const Context& context) {
    // These events were for a session that is gone; only the end of the runtime itself still matters.
    for (;;) {
        auto event = structure<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
        if (BINOSPLAT_XR(xrPollEvent(handle(), &event)) == XR_EVENT_UNAVAILABLE) { break; }
        if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) { throw InstanceLost(kGoingAway); }
    }
    const XrResult result = getSystem(handle(), system_);
    // Some runtimes report a missing headset as the latter.
    if (result == XR_ERROR_FORM_FACTOR_UNAVAILABLE || result == XR_ERROR_RUNTIME_FAILURE) { return false; }
    checkResult(result, "xrGetSystem");
    readSystem();
    readViews();
    readBlendModes();
    requireSameDevice(*this, context);
    return true;
}

void Instance::readSystem() {
    auto properties = structure<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
    BINOSPLAT_XR(xrGetSystemProperties(handle(), system_, &properties));
    tracks_hands_ = findsHands(*this);
    tracks_eyes_ = findsGaze(*this);
    moves_insets_ = findsMovingInset(*this);
    passes_through_ = findsPassthrough(*this);
    description_ = fmt::format("{}: {}", runtime_name_, properties.systemName);
}

void Instance::readProperties(void* of_extension) const {
    // One at a time: OpenXR's own validation layer refuses a chain of two.
    auto properties = structure<XrSystemProperties>(XR_TYPE_SYSTEM_PROPERTIES);
    properties.next = of_extension;
    BINOSPLAT_XR(xrGetSystemProperties(handle(), system_, &properties));
}

void Instance::readViews() {
    std::uint32_t count = 0;
    const XrResult result = xrEnumerateViewConfigurationViews(handle(), system_, kStereo, 0, &count, nullptr);
    // unplugged
    if (result == XR_ERROR_SYSTEM_INVALID) { checkResult(result, "xrEnumerateViewConfigurationViews"); }
    if (XR_FAILED(result)) { refuse(fmt::format("{} does not show two eyes", description_), result); }
    std::vector<XrViewConfigurationView> views(count,
                                               {XR_TYPE_VIEW_CONFIGURATION_VIEW, nullptr, 0, 0, 0, 0, 0, 0});
    BINOSPLAT_XR(xrEnumerateViewConfigurationViews(handle(), system_, kStereo, count, &count, views.data()));
    recommended_size_px_ = glm::uvec2(0);
    max_size_px_ = glm::uvec2(UINT32_MAX);
    for (const XrViewConfigurationView& view : views) {
        recommended_size_px_ = glm::max(recommended_size_px_, glm::uvec2(view.recommendedImageRectWidth,
                                                                         view.recommendedImageRectHeight));
        max_size_px_ = glm::min(max_size_px_, glm::uvec2(view.maxImageRectWidth, view.maxImageRectHeight));
    }
}

void Instance::readBlendModes() {
    const auto modes = listAll<XrEnvironmentBlendMode>([&](auto... step) {
        BINOSPLAT_XR(xrEnumerateEnvironmentBlendModes(handle(), system_, kStereo, step...));
    });
    const auto has = [&](XrEnvironmentBlendMode mode) {
        return std::ranges::find(modes, mode) != modes.end();
    };
    blend_mode_ = has(XR_ENVIRONMENT_BLEND_MODE_OPAQUE) || modes.empty() ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE
                                                                         : modes.front();
    see_through_.reset();
    for (const XrEnvironmentBlendMode mode :
         {XR_ENVIRONMENT_BLEND_MODE_ADDITIVE, XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND}) {
        if (has(mode)) { see_through_ = mode; }
    }
}

XrPath Instance::path(const char* text) const {
    XrPath path = XR_NULL_PATH;
    BINOSPLAT_XR(xrStringToPath(handle(), text, &path));
    return path;
}

}  // namespace binosplat::xr
