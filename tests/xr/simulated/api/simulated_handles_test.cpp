// Objects of the simulated runtime, ended in every order: children go with their parents, the others stay.
#include "tests/xr/simulated/api/simulated_direct.h"

#include <algorithm>
#include <array>

TEST_SUITE_BEGIN("simulated_handles");

namespace simulated_handles_test {

using namespace binosplat::test;

namespace {

// What there is to be destroyed; the session's own come after it.
enum Kind { kMessenger, kSet, kAction, kSession, kReferenceSpace, kActionSpace, kTracker };
constexpr int kKinds = 7;

constexpr int kNobody = -1;
constexpr int parentOf(int kind) {
    if (kind == kAction) return kSet;
    return kind > kSession ? kSession : kNobody;
}

XrBool32 hear(XrDebugUtilsMessageSeverityFlagsEXT, XrDebugUtilsMessageTypeFlagsEXT, const XrDebugUtilsMessengerCallbackDataEXT*, void*) {
    return XR_FALSE;
}

struct Everything : HeadlessSession {
    XrDebugUtilsMessengerEXT messenger = XR_NULL_HANDLE;
    XrActionSet set = XR_NULL_HANDLE;
    XrAction action = XR_NULL_HANDLE;
    XrSpace reference_space = XR_NULL_HANDLE, action_space = XR_NULL_HANDLE;
    XrHandTrackerEXT tracker = XR_NULL_HANDLE;

    explicit Everything(bool attaches) : HeadlessSession(k1_1, {XR_EXT_DEBUG_UTILS_EXTENSION_NAME, XR_EXT_HAND_TRACKING_EXTENSION_NAME}) {
        const XrDebugUtilsMessengerCreateInfoEXT messenger_info{
            XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,  nullptr, XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT, hear,    nullptr};
        REQUIRE(xr<PFN_xrCreateDebugUtilsMessengerEXT>("xrCreateDebugUtilsMessengerEXT")(instance, &messenger_info, &messenger) ==
                XR_SUCCESS);
        const XrActionSetCreateInfo set_info{XR_TYPE_ACTION_SET_CREATE_INFO, nullptr, "set", "Set", 0};
        REQUIRE(xr<PFN_xrCreateActionSet>("xrCreateActionSet")(instance, &set_info, &set) == XR_SUCCESS);
        const XrActionCreateInfo action_info{XR_TYPE_ACTION_CREATE_INFO, nullptr, "grip", XR_ACTION_TYPE_POSE_INPUT, 0, nullptr, "Grip"};
        REQUIRE(xr<PFN_xrCreateAction>("xrCreateAction")(set, &action_info, &action) == XR_SUCCESS);
        const XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &set};
        if (attaches) REQUIRE(xr<PFN_xrAttachSessionActionSets>("xrAttachSessionActionSets")(session, &attach) == XR_SUCCESS);
        reference_space = space(XR_REFERENCE_SPACE_TYPE_STAGE);
        const XrActionSpaceCreateInfo space_info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, action, XR_NULL_PATH, kIdentity};
        REQUIRE(xr<PFN_xrCreateActionSpace>("xrCreateActionSpace")(session, &space_info, &action_space) == XR_SUCCESS);
        const XrHandTrackerCreateInfoEXT tracker_info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr, XR_HAND_LEFT_EXT,
                                                      XR_HAND_JOINT_SET_DEFAULT_EXT};
        REQUIRE(xr<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT")(session, &tracker_info, &tracker) == XR_SUCCESS);
        begin();
    }

    XrResult destroy(int kind) const {
        switch (kind) {
            case kMessenger:
                return xr<PFN_xrDestroyDebugUtilsMessengerEXT>("xrDestroyDebugUtilsMessengerEXT")(messenger);
            case kSet:
                return xr<PFN_xrDestroyActionSet>("xrDestroyActionSet")(set);
            case kAction:
                return xr<PFN_xrDestroyAction>("xrDestroyAction")(action);
            case kSession:
                return xr<PFN_xrDestroySession>("xrDestroySession")(session);
            case kReferenceSpace:
                return xr<PFN_xrDestroySpace>("xrDestroySpace")(reference_space);
            case kActionSpace:
                return xr<PFN_xrDestroySpace>("xrDestroySpace")(action_space);
            default:
                return xr<PFN_xrDestroyHandTrackerEXT>("xrDestroyHandTrackerEXT")(tracker);
        }
    }

    // What is left is used: it must not look at what is gone.
    void use(const std::array<bool, kKinds>& is_gone) const {
        XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
        CHECK(XR_SUCCEEDED(xr<PFN_xrPollEvent>("xrPollEvent")(instance, &event)));
        if (!is_gone[kSession]) CHECK(XR_SUCCEEDED(sync()));
        XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
        if (!is_gone[kReferenceSpace] && !is_gone[kActionSpace])
            CHECK(xr<PFN_xrLocateSpace>("xrLocateSpace")(action_space, reference_space, 1'000'000'000, &location) == XR_SUCCESS);
    }
};

}  // namespace

TEST_CASE("objects end in every order, each once, and with their parents") {
    for (const bool attaches : {false, true}) {
        std::array<int, kKinds> order{kMessenger, kSet, kAction, kSession, kReferenceSpace, kActionSpace, kTracker};
        int number = 0;
        do {
            // A share of the 5040 orders; 37 is prime, so that none of the objects keeps a place.
            if (number++ % 37 != 0) continue;
            const Everything made(attaches);
            std::array<bool, kKinds> is_gone{};
            for (const int kind : order) {
                const bool is_left = !is_gone[static_cast<std::size_t>(kind)];
                CHECK(made.destroy(kind) == (is_left ? XR_SUCCESS : XR_ERROR_HANDLE_INVALID));
                for (int other = 0; other < kKinds; ++other)
                    if (other == kind || parentOf(other) == kind) is_gone[static_cast<std::size_t>(other)] = true;
                made.use(is_gone);
                CHECK(made.destroy(kind) == XR_ERROR_HANDLE_INVALID);
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

}  // namespace simulated_handles_test
