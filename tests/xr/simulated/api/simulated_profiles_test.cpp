// Every input and output of every interaction profile on the simulated runtime, moved by XR_EXT_conformance_automation and read back.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "xr/simulated/api/profiles.h"

#include <cmath>

TEST_SUITE_BEGIN("simulated_profiles");

namespace simulated_profiles_test {

using namespace binosplat::test;

namespace {

using simulated::Profile;

struct Bound {
    std::string path;
    XrActionType type;
    XrAction action = XR_NULL_HANDLE;
};

XrActionType typeOf(simulated::ComponentKind kind) {
    switch (kind) {
        case simulated::ComponentKind::kBoolean:
            return XR_ACTION_TYPE_BOOLEAN_INPUT;
        case simulated::ComponentKind::kFloat:
            return XR_ACTION_TYPE_FLOAT_INPUT;
        case simulated::ComponentKind::kPose:
            return XR_ACTION_TYPE_POSE_INPUT;
        default:
            return XR_ACTION_TYPE_VIBRATION_OUTPUT;
    }
}

// Of 1.1, with the extension that the profile may need; without one for older names of the palm and the finger tips.
simulated::Enabled enabledFor(const Profile& profile) {
    simulated::Enabled enabled{true, {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME}};
    if (!enabled.meets(profile.depends)) enabled.extensions.insert(std::string(profile.depends));
    return enabled;
}

std::vector<Bound> bindingsOf(const Profile& profile, std::string_view user_path) {
    std::vector<Bound> bindings;
    const simulated::Enabled enabled = enabledFor(profile);
    for (const simulated::Component& component : profile.components) {
        if (simulated::findComponent(profile, user_path, component.path, enabled) != &component) continue;
        const std::string path = std::string(user_path).append(component.path);
        bindings.push_back({path, typeOf(component.kind)});
        if (path.ends_with("/x")) bindings.push_back({path.substr(0, path.size() - 2), XR_ACTION_TYPE_VECTOR2F_INPUT});
    }
    return bindings;
}

std::vector<const char*> namesOf(const simulated::Enabled& enabled) {
    std::vector<const char*> names;
    for (const std::string& name : enabled.extensions) names.push_back(name.c_str());
    return names;
}

struct Played : HeadlessSession {
    XrPath profile_path, user_path;
    XrActionSet set = XR_NULL_HANDLE;
    std::vector<Bound> bindings;

    Played(const Profile& profile, std::string_view user)
        : HeadlessSession(k1_1, namesOf(enabledFor(profile))),
          profile_path(path(std::string(profile.path).c_str())),
          user_path(path(std::string(user).c_str())),
          bindings(bindingsOf(profile, user)) {
        XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO, nullptr, "all", "All", 0};
        REQUIRE(xr<PFN_xrCreateActionSet>("xrCreateActionSet")(instance, &info, &set) == XR_SUCCESS);
        std::vector<XrActionSuggestedBinding> suggested;
        for (Bound& bound : bindings) {
            bound.action = makeAction(bound.type, suggested.size());
            suggested.push_back({bound.action, path(bound.path.c_str())});
        }
        const XrInteractionProfileSuggestedBinding suggestion{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr, profile_path,
                                                              static_cast<std::uint32_t>(suggested.size()), suggested.data()};
        REQUIRE(xr<PFN_xrSuggestInteractionProfileBindings>("xrSuggestInteractionProfileBindings")(instance, &suggestion) == XR_SUCCESS);
        const XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1, &set};
        REQUIRE(xr<PFN_xrAttachSessionActionSets>("xrAttachSessionActionSets")(session, &attach) == XR_SUCCESS);
        begin();
    }

    XrAction makeAction(XrActionType type, std::size_t number) const {
        XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
        std::strcpy(info.actionName, ("action_" + std::to_string(number)).c_str());
        std::strcpy(info.localizedActionName, ("Action " + std::to_string(number)).c_str());
        info.actionType = type;
        info.countSubactionPaths = 1;
        info.subactionPaths = &user_path;
        XrAction action = XR_NULL_HANDLE;
        REQUIRE(xr<PFN_xrCreateAction>("xrCreateAction")(set, &info, &action) == XR_SUCCESS);
        return action;
    }
    void switchTo(bool active) const {
        REQUIRE(xr<PFN_xrSetInputDeviceActiveEXT>("xrSetInputDeviceActiveEXT")(session, profile_path, user_path, active) == XR_SUCCESS);
        sync();
    }
    void sync() const {
        const XrActiveActionSet active{set, XR_NULL_PATH};
        const XrActionsSyncInfo info{XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
        REQUIRE(xr<PFN_xrSyncActions>("xrSyncActions")(session, &info) == XR_SUCCESS);
    }
    void move(const Bound& bound, float value) const {
        const XrPath source = path(bound.path.c_str());
        if (bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT) {
            const auto setBool = xr<PFN_xrSetInputDeviceStateBoolEXT>("xrSetInputDeviceStateBoolEXT");
            REQUIRE(setBool(session, user_path, source, value > 0) == XR_SUCCESS);
        } else if (bound.type == XR_ACTION_TYPE_FLOAT_INPUT) {
            const auto setFloat = xr<PFN_xrSetInputDeviceStateFloatEXT>("xrSetInputDeviceStateFloatEXT");
            REQUIRE(setFloat(session, user_path, source, value) == XR_SUCCESS);
        } else if (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT) {
            const auto setVector = xr<PFN_xrSetInputDeviceStateVector2fEXT>("xrSetInputDeviceStateVector2fEXT");
            REQUIRE(setVector(session, user_path, source, {value, -value}) == XR_SUCCESS);
        }
        sync();
    }

    XrSpace spaceOf(const Bound& bound) const {
        const XrActionSpaceCreateInfo info{XR_TYPE_ACTION_SPACE_CREATE_INFO, nullptr, bound.action, user_path, kIdentity};
        XrSpace made = XR_NULL_HANDLE;
        REQUIRE(xr<PFN_xrCreateActionSpace>("xrCreateActionSpace")(session, &info, &made) == XR_SUCCESS);
        return made;
    }

    struct Reading {
        bool is_active, has_changed;
        XrTime changed_at;
        float x, y;
    };
    template <class State, class Function>
    State get(const char* function, const Bound& bound, XrStructureType type) const {
        State state{type};
        const XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO, nullptr, bound.action, user_path};
        REQUIRE(xr<Function>(function)(session, &info, &state) == XR_SUCCESS);
        return state;
    }
    Reading read(const Bound& bound) const {
        const auto boolean = [&] {
            const auto state =
                get<XrActionStateBoolean, PFN_xrGetActionStateBoolean>("xrGetActionStateBoolean", bound, XR_TYPE_ACTION_STATE_BOOLEAN);
            return Reading{state.isActive != 0, state.changedSinceLastSync != 0, state.lastChangeTime, state.currentState ? 1.0f : 0.0f, 0};
        };
        const auto number = [&] {
            const auto state =
                get<XrActionStateFloat, PFN_xrGetActionStateFloat>("xrGetActionStateFloat", bound, XR_TYPE_ACTION_STATE_FLOAT);
            return Reading{state.isActive != 0, state.changedSinceLastSync != 0, state.lastChangeTime, state.currentState, 0};
        };
        const auto vector = [&] {
            const auto state =
                get<XrActionStateVector2f, PFN_xrGetActionStateVector2f>("xrGetActionStateVector2f", bound, XR_TYPE_ACTION_STATE_VECTOR2F);
            return Reading{state.isActive != 0, state.changedSinceLastSync != 0, state.lastChangeTime, state.currentState.x,
                           state.currentState.y};
        };
        switch (bound.type) {
            case XR_ACTION_TYPE_BOOLEAN_INPUT:
                return boolean();
            case XR_ACTION_TYPE_FLOAT_INPUT:
                return number();
            case XR_ACTION_TYPE_VECTOR2F_INPUT:
                return vector();
            default:
                return {
                    get<XrActionStatePose, PFN_xrGetActionStatePose>("xrGetActionStatePose", bound, XR_TYPE_ACTION_STATE_POSE).isActive !=
                        0,
                    false, 0, 0, 0};
        }
    }
};

}  // namespace

TEST_CASE("every input of every profile is read as it is moved, each by itself, and only while its device is there") {
    for (const Profile& profile : simulated::listProfiles()) {
        for (const std::string_view user : profile.user_paths) {
            INFO(std::string(profile.path), " ", std::string(user));
            const Played played(profile, user);
            played.switchTo(false);
            for (const Bound& bound : played.bindings) {
                if (bound.type == XR_ACTION_TYPE_VIBRATION_OUTPUT) continue;
                const Played::Reading off = played.read(bound);
                CHECK_MESSAGE(!off.is_active, bound.path);
                CHECK_MESSAGE((off.x == 0 && off.y == 0 && off.changed_at == 0 && !off.has_changed), bound.path);
            }
            played.switchTo(true);
            for (const Bound& bound : played.bindings) {
                if (bound.type == XR_ACTION_TYPE_VIBRATION_OUTPUT) continue;
                CHECK_MESSAGE(played.read(bound).is_active, bound.path);
                if (bound.type == XR_ACTION_TYPE_POSE_INPUT) continue;
                const float value = bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT ? 1.0f : 0.75f;
                played.move(bound, value);
                const Played::Reading moved = played.read(bound);
                CHECK_MESSAGE(moved.x == value, bound.path);
                CHECK_MESSAGE(moved.y == (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT ? -value : 0.0f), bound.path);
                CHECK_MESSAGE((moved.has_changed && moved.changed_at > 0), bound.path);
                // Nothing else of its type moves with it.
                for (const Bound& other : played.bindings) {
                    if (&other == &bound || other.type != bound.type) continue;
                    CHECK_MESSAGE(played.read(other).x == 0, bound.path << " moves " << other.path);
                }
                played.sync();
                const Played::Reading held = played.read(bound);
                CHECK_MESSAGE((held.x == value && !held.has_changed && held.changed_at == moved.changed_at), bound.path);
                played.move(bound, 0);
                const Played::Reading released = played.read(bound);
                CHECK_MESSAGE((released.x == 0 && released.y == 0 && released.has_changed), bound.path);
                CHECK_MESSAGE(released.changed_at > moved.changed_at, bound.path);
            }
        }
    }
}

TEST_CASE("every pose of every profile is where it is put") {
    constexpr float kHalf = 0.70710678f;
    for (const Profile& profile : simulated::listProfiles()) {
        for (const std::string_view user : profile.user_paths) {
            const Played played(profile, user);
            const XrSpace stage = played.space(XR_REFERENCE_SPACE_TYPE_STAGE);
            played.switchTo(true);
            for (const Bound& bound : played.bindings) {
                if (bound.type != XR_ACTION_TYPE_POSE_INPUT) continue;
                INFO(std::string(profile.path), " ", bound.path);
                const XrPosef wanted{{0, kHalf, 0, kHalf}, {1, 2, 3}};
                REQUIRE(played.xr<PFN_xrSetInputDeviceLocationEXT>("xrSetInputDeviceLocationEXT")(
                            played.session, played.user_path, played.path(bound.path.c_str()), stage, wanted) == XR_SUCCESS);
                played.sync();
                XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
                REQUIRE(played.xr<PFN_xrLocateSpace>("xrLocateSpace")(played.spaceOf(bound), stage, 1'000'000'000, &location) ==
                        XR_SUCCESS);
                CHECK((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0);
                const XrPosef& found = location.pose;
                CHECK(found.position.x == doctest::Approx(1));
                CHECK(found.position.y == doctest::Approx(2));
                CHECK(found.position.z == doctest::Approx(3));
                CHECK(std::abs(found.orientation.y * kHalf + found.orientation.w * kHalf) == doctest::Approx(1));
            }
        }
    }
}

TEST_CASE("what a path depends on is read as the registry writes it: + is and, a comma is or") {
    const simulated::Enabled older{false, {"A", "B"}}, newer{true, {}};
    CHECK(older.meets(""));
    CHECK(older.meets("A"));
    CHECK_FALSE(older.meets("C"));
    CHECK(older.meets("A+B"));
    CHECK_FALSE(older.meets("A+C"));
    CHECK(older.meets("C,B"));
    CHECK(older.meets("C+A,B"));
    CHECK(older.meets("B,C+A"));
    CHECK_FALSE(older.meets("A+C,XR_VERSION_1_1"));
    CHECK(newer.meets("A+C,XR_VERSION_1_1"));
}

}  // namespace simulated_profiles_test
