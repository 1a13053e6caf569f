// Every input of every interaction profile, moved and read back, and what can be bound in which version;
// without a loader.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "xr/simulated/api/profiles.h"

SUITE(simulated_profiles) {

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

// Version 1.1, with the extension that the profile may need, and without one for older names of the palm and
// the finger tips.
simulated::Enabled enabledFor(const Profile& profile) {
    simulated::Enabled enabled{true, {XR_EXT_CONFORMANCE_AUTOMATION_EXTENSION_NAME}};
    if (!enabled.meets(profile.depends)) { enabled.extensions.insert(std::string(profile.depends)); }
    return enabled;
}

std::vector<Bound> bindingsOf(const Profile& profile, std::string_view user_path) {
    std::vector<Bound> bindings;
    const simulated::Enabled enabled = enabledFor(profile);
    for (const simulated::Component& component : profile.components) {
        if (simulated::findComponent(profile, user_path, component.path, enabled) != &component) { continue; }
        const std::string path = std::string(user_path).append(component.path);
        bindings.push_back({path, typeOf(component.kind)});
        if (path.ends_with("/x")) {
            bindings.push_back({path.substr(0, path.size() - 2), XR_ACTION_TYPE_VECTOR2F_INPUT});
        }
    }
    return bindings;
}

Extensions namesOf(const simulated::Enabled& enabled) {
    Extensions names;
    for (const std::string& name : enabled.extensions) { names.push_back(name.c_str()); }
    return names;
}

struct Played : HeadlessSession {
    XrPath profile_path, user_path;
    XrActionSet set = makeActionSet("all");
    std::vector<Bound> bindings;

    Played(const Profile& profile, std::string_view user)
        : HeadlessSession(k1_1, namesOf(enabledFor(profile))),
          profile_path(path(std::string(profile.path))),
          user_path(path(std::string(user))),
          bindings(bindingsOf(profile, user)) {
        std::vector<XrActionSuggestedBinding> suggested;
        for (Bound& bound : bindings) {
            bound.action =
                makeAction(set, "action_" + std::to_string(suggested.size()), bound.type, {user_path});
            suggested.push_back({bound.action, path(bound.path)});
        }
        REQUIRE(suggest(std::string(profile.path), suggested) == XR_SUCCESS);
        attach({set});
        begin();
    }

    void synchronize() const { REQUIRE(sync(set) == XR_SUCCESS); }
    void switchTo(bool active) const {
        REQUIRE(XR(xrSetInputDeviceActiveEXT)(session, profile_path, user_path, active) == XR_SUCCESS);
        synchronize();
    }
    void move(const Bound& bound, float value) const {
        const XrPath source = path(bound.path);
        if (bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT) {
            REQUIRE(XR(xrSetInputDeviceStateBoolEXT)(session, user_path, source, value > 0) == XR_SUCCESS);
        } else if (bound.type == XR_ACTION_TYPE_FLOAT_INPUT) {
            REQUIRE(XR(xrSetInputDeviceStateFloatEXT)(session, user_path, source, value) == XR_SUCCESS);
        } else if (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT) {
            REQUIRE(XR(xrSetInputDeviceStateVector2fEXT)(session, user_path, source, {value, -value}) ==
                    XR_SUCCESS);
        }
        synchronize();
    }

    struct Reading {
        bool is_active, has_changed;
        XrTime changed_at;
        float x, y;
    };
    Reading read(const Bound& bound) const {
        const auto reading = [](const auto& state, float x, float y) {
            return Reading{state.isActive != 0, state.changedSinceLastSync != 0, state.lastChangeTime, x, y};
        };
        if (bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT) {
            const auto state = boolean(bound.action, user_path);
            return reading(state, state.currentState ? 1.0f : 0.0f, 0);
        }
        if (bound.type == XR_ACTION_TYPE_FLOAT_INPUT) {
            const auto state = number(bound.action, user_path);
            return reading(state, state.currentState, 0);
        }
        if (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT) {
            const auto state = vector(bound.action, user_path);
            return reading(state, state.currentState.x, state.currentState.y);
        }
        return {pose(bound.action, user_path).isActive != 0, false, 0, 0, 0};
    }

    // A quarter turn to the left, at (1, 2, 3).
    void checkPose(const Bound& bound) const {
        constexpr float kHalf = 0.70710678f;
        const XrSpace stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
        const XrPosef wanted{{0, kHalf, 0, kHalf}, {1, 2, 3}};
        REQUIRE(XR(xrSetInputDeviceLocationEXT)(session, user_path, path(bound.path), stage, wanted) ==
                XR_SUCCESS);
        synchronize();
        const XrSpaceLocation location = locate(makeActionSpace(bound.action, user_path), stage, kStart);
        CHECK((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0);
        const XrPosef& found = location.pose;
        checkNear(found.position, {1, 2, 3});
        CHECK(std::abs(found.orientation.y * kHalf + found.orientation.w * kHalf) == doctest::Approx(1));
    }
};

// Whether it can be bound in 1.0, in 1.1, and in 1.0 with an extension.
struct Binding {
    std::string profile, path, extension;
    bool of_1_0, of_1_1;

    [[nodiscard]] XrActionType type() const {
        const auto has = [&](const char* part) { return path.find(part) != std::string::npos; };
        if (has("haptic_")) { return XR_ACTION_TYPE_VIBRATION_OUTPUT; }
        if (has("pinch_ext/value")) { return XR_ACTION_TYPE_FLOAT_INPUT; }
        return has("/pose") || has("gaze_ext") || has("grip_surface") ? XR_ACTION_TYPE_POSE_INPUT
                                                                      : XR_ACTION_TYPE_BOOLEAN_INPUT;
    }
};

// One line per profile: whether its paths are accepted in "1.0" and 1.1, from "1.1" on, or never ("none"),
// and the extension.
std::vector<Binding> bindingsIn(const char* lines) {
    std::vector<Binding> bindings;
    std::istringstream stream(lines);
    for (std::string line; std::getline(stream, line);) {
        const std::vector<std::string> words = wordsIn(line);
        for (std::size_t i = 3; i < words.size(); ++i) {
            bindings.push_back(
                {words[2], words[i], words[1] == "-" ? "" : words[1], words[0] == "1.0", words[0] != "none"});
        }
    }
    return bindings;
}

// Paths of the core, paths that nothing defines, and paths of extensions, some of which became part of 1.1.
// The palm's surface is grip_surface in 1.1 and palm_ext in an extension. Finger tips are poses of every
// hand, gestures exist only in the hands' profile, and the eyes' profile has a gaze and nothing else.
constexpr const char* kBindings =
    R"(1.0 - khr/simple_controller hand/left/input/select/click hand/right/output/haptic
1.0 - google/daydream_controller hand/left/input/trackpad/touch
1.0 - htc/vive_controller hand/right/input/squeeze/click hand/right/input/trackpad
1.0 - htc/vive_pro head/input/volume_up/click
1.0 - microsoft/motion_controller hand/left/input/thumbstick/x
1.0 - microsoft/xbox_controller gamepad/input/dpad_up/click gamepad/output/haptic_left_trigger
1.0 - oculus/go_controller hand/left/input/back/click
1.0 - oculus/touch_controller hand/left/input/x/click hand/right/input/a/touch hand/left/input/thumbrest/touch
1.0 - valve/index_controller hand/left/input/squeeze/force hand/left/input/a/click
none - khr/simple_controller hand/left/input/trigger/value head/input/select/click hand/left hand/left/input
none - google/daydream_controller hand/left/output/haptic
none - htc/vive_controller hand/left/input/squeeze/value
none - htc/vive_pro hand/left/input/system/click
none - microsoft/motion_controller hand/left/input/squeeze/value
none - microsoft/xbox_controller hand/left/input/a/click gamepad/output/haptic gamepad/input/grip_surface/pose
none - oculus/go_controller hand/left/input/menu/click
none - oculus/touch_controller hand/right/input/x/click hand/left/input/a/click hand/right/input/menu/click
none - oculus/touch_controller hand/left/input/trig/value hand/left/input/trigger/click
none - valve/index_controller hand/left/input/trackpad/click
none - nobody/nothing hand/left/input/a/click
none - bytedance/pico4_controller hand/right/input/menu/click
none - meta/touch_controller_quest_1_rift_s hand/left/input/thumbrest/touch
none - htc/vive_cosmos_controller hand/left/input/thumbrest/touch
1.1 XR_EXT_hp_mixed_reality_controller hp/mixed_reality_controller hand/left/input/x/click
1.1 XR_EXT_samsung_odyssey_controller samsung/odyssey_controller hand/left/input/trackpad/click
1.1 XR_HTC_vive_cosmos_controller_interaction htc/vive_cosmos_controller hand/left/input/shoulder/click
1.1 XR_HTC_vive_focus3_controller_interaction htc/vive_focus3_controller hand/right/input/squeeze/touch
1.1 XR_ML_ml2_controller_interaction ml/ml2_controller hand/right/input/home/click
1.1 XR_BD_controller_interaction bytedance/pico_neo3_controller hand/right/input/menu/click
1.1 XR_BD_controller_interaction bytedance/pico4_controller hand/left/input/menu/click
1.1 XR_BD_controller_interaction bytedance/pico_g3_controller hand/left/input/thumbstick/click hand/right/input/thumbstick/x
1.1 - oculus/touch_controller hand/left/input/trigger/proximity hand/right/input/thumb_resting_surfaces/proximity
1.1 - meta/touch_pro_controller hand/left/input/stylus/force hand/left/output/haptic_thumb
1.1 - meta/touch_plus_controller hand/left/input/trigger/force
1.1 - meta/touch_controller_quest_2 hand/left/input/thumbrest/touch
1.1 - meta/touch_controller_quest_1_rift_s hand/left/input/trigger/proximity
1.1 - meta/touch_controller_rift_cv1 hand/left/input/thumb_resting_surfaces/proximity
1.1 XR_KHR_maintenance1 khr/simple_controller hand/left/input/grip_surface/pose hand/left/input/grip_surface
none XR_EXT_palm_pose khr/simple_controller hand/left/input/palm_ext/pose
none XR_EXT_hand_interaction khr/simple_controller hand/left/input/pinch_ext/pose hand/right/input/poke_ext/pose
none XR_EXT_hand_interaction ext/hand_interaction_ext hand/left/input/pinch_ext/value
none XR_EXT_eye_gaze_interaction ext/eye_gaze_interaction eyes_ext/input/gaze_ext/pose eyes_ext/input/gaze_ext)";

TEST_CASE(
    "every input of every profile is read as it is moved, each by itself, every pose where it is put, while "
    "its device is there") {
    for (const Profile& profile : simulated::listProfiles()) {
        for (const std::string_view user : profile.user_paths) {
            INFO(std::string(profile.path), " ", std::string(user));
            const Played played(profile, user);
            played.switchTo(false);
            for (const Bound& bound : played.bindings) {
                if (bound.type == XR_ACTION_TYPE_VIBRATION_OUTPUT) { continue; }
                const Played::Reading off = played.read(bound);
                CHECK_MESSAGE(!off.is_active, bound.path);
                CHECK_MESSAGE((off.x == 0 && off.y == 0 && off.changed_at == 0 && !off.has_changed),
                              bound.path);
            }
            played.switchTo(true);
            for (const Bound& bound : played.bindings) {
                INFO(bound.path);
                if (bound.type == XR_ACTION_TYPE_VIBRATION_OUTPUT) { continue; }
                CHECK(played.read(bound).is_active);
                if (bound.type == XR_ACTION_TYPE_POSE_INPUT) {
                    played.checkPose(bound);
                    continue;
                }
                const float value = bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT ? 1.0f : 0.75f;
                played.move(bound, value);
                const Played::Reading moved = played.read(bound);
                CHECK(these(moved.x, moved.y) ==
                      these(value, (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT ? -value : 0.0f)));
                CHECK((moved.has_changed && moved.changed_at > 0));
                // Nothing else of its type moves with it.
                for (const Bound& other : played.bindings) {
                    if (&other == &bound || other.type != bound.type) { continue; }
                    CHECK_MESSAGE(played.read(other).x == 0, other.path);
                }
                played.synchronize();
                const Played::Reading held = played.read(bound);
                CHECK((held.x == value && !held.has_changed && held.changed_at == moved.changed_at));
                played.move(bound, 0);
                const Played::Reading released = played.read(bound);
                CHECK((released.x == 0 && released.y == 0 && released.has_changed));
                CHECK(released.changed_at > moved.changed_at);
            }
        }
    }
}

TEST_CASE("each profile takes its own paths and no others, in its version, or with its extension") {
    constexpr const char* kHands = "XR_EXT_hand_interaction";
    constexpr const char* kEyes = XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME;
    const std::vector<Binding> bindings = bindingsIn(kBindings);
    const auto check = [&](XrVersion version, const Extensions& extensions, const auto& isTaken) {
        const DirectInstance made(version, extensions);
        for (const Binding& one : bindings) {
            INFO(one.profile, " ", one.path, " ", version == k1_1 ? "1.1 " : "1.0 ",
                 extensions.empty() ? "" : extensions[0]);
            const XrResult expected = isTaken(one) ? XR_SUCCESS : XR_ERROR_PATH_UNSUPPORTED;
            CHECK(made.suggest("/interaction_profiles/" + one.profile, "/user/" + one.path, one.type()) ==
                  expected);
        }
    };
    check(k1_0, {}, [](const Binding& one) { return one.of_1_0; });
    check(k1_1, {}, [](const Binding& one) { return one.of_1_1; });
    std::set<std::string> extensions;
    for (const Binding& one : bindings) {
        if (!one.extension.empty()) { extensions.insert(one.extension); }
    }
    for (const std::string& extension : extensions) {
        check(k1_0, {extension.c_str()},
              [&](const Binding& one) { return one.of_1_0 || one.extension == extension; });
    }
    for (const auto& [extension, profile, path] :
         {std::tuple(kHands, kSimple, "/user/hand/left/input/pinch_ext/value"),
          std::tuple(kEyes, "/interaction_profiles/ext/eye_gaze_interaction",
                     "/user/eyes_ext/input/aim/pose"),
          std::tuple(kEyes, "/interaction_profiles/ext/eye_gaze_interaction",
                     "/user/hand/left/input/gaze_ext/pose"),
          std::tuple(kEyes, kSimple, "/user/eyes_ext/input/gaze_ext/pose")}) {
        CHECK(DirectInstance(k1_1, {extension}).suggest(profile, path) == XR_ERROR_PATH_UNSUPPORTED);
    }
}

TEST_CASE("the palm's surface lies beside the grip, turned towards the index finger") {
    const HeadlessSession made(k1_1, {}, "controller left 0 position 1 2 3 turn 40 10\n");
    const XrActionSet set = made.makeActionSet("set");
    const std::string hands[] = {"/user/hand/left", "/user/hand/right"};
    const std::vector<XrPath> paths{made.path(hands[0]), made.path(hands[1])};
    std::vector<XrAction> actions;
    std::vector<XrActionSuggestedBinding> bindings;
    for (const std::string name : {"grip", "grip_surface"}) {
        actions.push_back(made.makeAction(set, name, XR_ACTION_TYPE_POSE_INPUT, paths));
        for (const std::string& hand : hands) {
            bindings.push_back({actions.back(), made.path(hand + "/input/" + name + "/pose")});
        }
    }
    REQUIRE(made.suggest(kSimple, bindings) == XR_SUCCESS);
    made.attach({set});
    made.begin();
    REQUIRE(made.sync(set) == XR_SUCCESS);
    for (const XrPath hand : paths) {
        const XrSpaceLocation location = made.locate(made.makeActionSpace(actions[1], hand),
                                                     made.makeActionSpace(actions[0], hand), kStart);
        CHECK(these(location.locationFlags, location.pose.position.x, location.pose.orientation.x) ==
              these(15, doctest::Approx(hand == paths[0] ? -0.02 : 0.02),
                    doctest::Approx(-std::sin(3.14159265 / 8))));
        CHECK(location.pose.orientation.w == doctest::Approx(std::cos(3.14159265 / 8)));
    }
}

TEST_CASE("what a path depends on is read as the registry writes it: + is and, a comma is or") {
    const simulated::Enabled older{false, {"A", "B"}};
    for (const char* met : {"", "A", "A+B", "C,B", "C+A,B", "B,C+A"}) {
        CHECK_MESSAGE(older.meets(met), met);
    }
    for (const char* not_met : {"C", "A+C", "A+C,XR_VERSION_1_1"}) {
        CHECK_FALSE_MESSAGE(older.meets(not_met), not_met);
    }
    CHECK(simulated::Enabled{true, {}}.meets("A+C,XR_VERSION_1_1"));
}

}  // SUITE(simulated_profiles)
