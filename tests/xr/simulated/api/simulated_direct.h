// The runtime without a loader between: for what Debian's loader, of API 1.0, keeps to itself.
#pragma once

#include "tests/xr/simulated/api/simulated_fixture.h"
#include "xr/simulated/openxr_later.h"

#include <dlfcn.h>

namespace binosplat::test {

// The loader's interface, version 1.
struct LoaderInfo {
    int type = 1;
    std::uint32_t version = 1;
    std::size_t size = sizeof(LoaderInfo);
    std::uint32_t least_interface = 1, most_interface = 1;
    XrVersion least_api = XR_MAKE_VERSION(1, 0, 0), most_api = XR_MAKE_VERSION(1, 0x3FF, 0xFFF);
};
struct RuntimeRequest {
    int type = 3;
    std::uint32_t version = 1;
    std::size_t size = sizeof(RuntimeRequest);
    std::uint32_t interface = 0;
    XrVersion api = 0;
    PFN_xrGetInstanceProcAddr get_instance_proc_addr = nullptr;
};
using Negotiate = XrResult (*)(const LoaderInfo*, RuntimeRequest*);

class Direct {
public:
    PFN_xrGetInstanceProcAddr get = nullptr;
    XrVersion api = 0;

    Direct() {
        library = dlopen(path().c_str(), RTLD_NOW | RTLD_LOCAL);
        REQUIRE(library != nullptr);
        const auto negotiate = reinterpret_cast<Negotiate>(dlsym(library, "xrNegotiateLoaderRuntimeInterface"));
        REQUIRE((negotiate != nullptr));
        const LoaderInfo info;
        RuntimeRequest request;
        REQUIRE(negotiate(&info, &request) == XR_SUCCESS);
        get = request.get_instance_proc_addr;
        api = request.api;
    }
    ~Direct() { dlclose(library); }
    Direct(const Direct&) = delete;
    Direct& operator=(const Direct&) = delete;

    static std::filesystem::path path() {
        return std::filesystem::path(BINOSPLAT_SIMULATED_RUNTIME).parent_path() / "libbinosplat_simulated_runtime.so";
    }

    template <class Function>
    Function function(XrInstance instance, const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        REQUIRE_MESSAGE(get(instance, name, &found) == XR_SUCCESS, name);
        return reinterpret_cast<Function>(found);
    }

private:
    void* library = nullptr;
};

inline constexpr XrVersion k1_0 = XR_MAKE_VERSION(1, 0, 0), k1_1 = XR_MAKE_VERSION(1, 1, 0);

struct DirectInstance : Headset, Direct {
    XrInstance instance = XR_NULL_HANDLE;
    XrSystemId system = XR_NULL_SYSTEM_ID;

    DirectInstance(XrVersion version, const std::vector<const char*>& extensions, const std::string& script = kQuietScript)
        : Headset(script) {
        REQUIRE(make(version, extensions) == XR_SUCCESS);
        XrSystemGetInfo info{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
        REQUIRE(xr<PFN_xrGetSystem>("xrGetSystem")(instance, &info, &system) == XR_SUCCESS);
    }
    ~DirectInstance() { xr<PFN_xrDestroyInstance>("xrDestroyInstance")(instance); }

    XrResult make(XrVersion version, const std::vector<const char*>& extensions) {
        XrInstanceCreateInfo info = instanceInfo(extensions);
        info.applicationInfo.apiVersion = version;
        return function<PFN_xrCreateInstance>(XR_NULL_HANDLE, "xrCreateInstance")(&info, &instance);
    }
    template <class Function>
    Function xr(const char* name) const {
        return function<Function>(instance, name);
    }
    bool has(const char* name) const {
        PFN_xrVoidFunction found = nullptr;
        return get(instance, name, &found) == XR_SUCCESS;
    }
    XrPath path(const char* text) const {
        XrPath made = XR_NULL_PATH;
        REQUIRE(xr<PFN_xrStringToPath>("xrStringToPath")(instance, text, &made) == XR_SUCCESS);
        return made;
    }
    // What a profile's path answers when an action of this type is bound to it.
    XrResult suggest(const char* profile, const char* binding, XrActionType type = XR_ACTION_TYPE_POSE_INPUT) const {
        XrActionSetCreateInfo set_info{XR_TYPE_ACTION_SET_CREATE_INFO};
        std::strcpy(set_info.actionSetName, "set");
        std::strcpy(set_info.localizedActionSetName, "the set");
        XrActionSet set = XR_NULL_HANDLE;
        REQUIRE(xr<PFN_xrCreateActionSet>("xrCreateActionSet")(instance, &set_info, &set) == XR_SUCCESS);
        XrActionCreateInfo action_info{XR_TYPE_ACTION_CREATE_INFO};
        std::strcpy(action_info.actionName, "action");
        std::strcpy(action_info.localizedActionName, "the action");
        action_info.actionType = type;
        XrAction action = XR_NULL_HANDLE;
        REQUIRE(xr<PFN_xrCreateAction>("xrCreateAction")(set, &action_info, &action) == XR_SUCCESS);
        const XrActionSuggestedBinding suggested{action, path(binding)};
        const XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr, path(profile), 1,
                                                        &suggested};
        const XrResult result = xr<PFN_xrSuggestInteractionProfileBindings>("xrSuggestInteractionProfileBindings")(instance, &info);
        REQUIRE(xr<PFN_xrDestroyActionSet>("xrDestroyActionSet")(set) == XR_SUCCESS);
        return result;
    }
};

struct HeadlessSession : DirectInstance {
    XrSession session = XR_NULL_HANDLE;

    HeadlessSession(XrVersion version, std::vector<const char*> extensions, const std::string& script = kQuietScript)
        : DirectInstance(version, (extensions.push_back(XR_MND_HEADLESS_EXTENSION_NAME), extensions), script) {
        const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, nullptr, 0, system};
        REQUIRE(xr<PFN_xrCreateSession>("xrCreateSession")(instance, &info, &session) == XR_SUCCESS);
    }
    std::vector<XrReferenceSpaceType> spaceTypes() const {
        XrReferenceSpaceType types[8];
        std::uint32_t count = 0;
        REQUIRE(xr<PFN_xrEnumerateReferenceSpaces>("xrEnumerateReferenceSpaces")(session, 8, &count, types) == XR_SUCCESS);
        return {types, types + count};
    }
    XrResult makeSpace(XrReferenceSpaceType type, XrSpace& space) const {
        const XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, type, kIdentity};
        return xr<PFN_xrCreateReferenceSpace>("xrCreateReferenceSpace")(session, &info, &space);
    }
    XrSpace space(XrReferenceSpaceType type) const {
        XrSpace made = XR_NULL_HANDLE;
        REQUIRE(makeSpace(type, made) == XR_SUCCESS);
        return made;
    }
    std::vector<XrSessionState> states() const {
        std::vector<XrSessionState> found;
        const auto poll = xr<PFN_xrPollEvent>("xrPollEvent");
        for (XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER}; poll(instance, &event) == XR_SUCCESS;
             event = {XR_TYPE_EVENT_DATA_BUFFER}) {
            if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED)
                found.push_back(reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state);
        }
        return found;
    }
    XrResult sync() const {
        const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 0, nullptr};
        return xr<PFN_xrSyncActions>("xrSyncActions")(session, &info);
    }
    void begin() const {
        const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
        REQUIRE(xr<PFN_xrBeginSession>("xrBeginSession")(session, &info) == XR_SUCCESS);
    }
};

}  // namespace binosplat::test
