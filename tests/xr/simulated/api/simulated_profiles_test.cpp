// Every input of every interaction profile, moved and read back, and what can be bound in which version;
// without a loader.
#include "tests/script.h"
#include "tests/xr/simulated/api/simulated_direct.h"
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/api/profiles.h"

SUITE(simulated_profiles) {

using simulated::Profile;

struct Bound {
    std::string path;
    XrActionType type;
    XrAction action = XR_NULL_HANDLE;
};

XrActionType typeOf(simulated::ComponentKind kind) {
    using enum simulated::ComponentKind;
    return kind == kBoolean ? XR_ACTION_TYPE_BOOLEAN_INPUT
           : kind == kFloat ? XR_ACTION_TYPE_FLOAT_INPUT
           : kind == kPose  ? XR_ACTION_TYPE_POSE_INPUT
                            : XR_ACTION_TYPE_VIBRATION_OUTPUT;
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
        const auto reading = [](const auto& state) {
            const bool is_active = state.isActive != 0, has_changed = state.changedSinceLastSync != 0;
            if constexpr (requires { state.currentState.x; }) {
                const auto [x, y] = state.currentState;
                return Reading{is_active, has_changed, state.lastChangeTime, x, y};
            } else {
                const auto x = static_cast<float>(state.currentState);
                return Reading{is_active, has_changed, state.lastChangeTime, x, 0};
            }
        };
        if (bound.type == XR_ACTION_TYPE_POSE_INPUT) {
            return {pose(bound.action, user_path).isActive != 0, false, 0, 0, 0};
        }
        return bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT ? reading(boolean(bound.action, user_path))
               : bound.type == XR_ACTION_TYPE_FLOAT_INPUT ? reading(number(bound.action, user_path))
                                                          : reading(vector(bound.action, user_path));
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

XrActionType typeOf(const std::string& path) {
    const auto has = [&](const char* part) { return path.find(part) != std::string::npos; };
    if (has("haptic")) { return XR_ACTION_TYPE_VIBRATION_OUTPUT; }
    if (has("pinch_ext/value")) { return XR_ACTION_TYPE_FLOAT_INPUT; }
    return has("/pose") || has("gaze_ext") || has("grip_surface") ? XR_ACTION_TYPE_POSE_INPUT
                                                                  : XR_ACTION_TYPE_BOOLEAN_INPUT;
}

SCRIPT(simulated_profiles, "xr/simulated/api/simulated_profiles") {
    const simulated::Folder folder;
    std::unique_ptr<DirectInstance> made;
    const auto begin = [&](const std::string& line, const std::string&) {
        const std::vector<std::string> words = wordsIn(line);
        Extensions extensions;
        for (std::size_t i = 1; i < words.size(); ++i) { extensions.push_back(words[i].c_str()); }
        made.reset();
        made = std::make_unique<DirectInstance>(words[0] == "1.1" ? k1_1 : k1_0, extensions);
        return Outcome{0, "", ""};
    };
    ScriptHost host{begin, folder.path};
    for (const auto& [verb, result] :
         {std::pair("takes", XR_SUCCESS), std::pair("refuses", XR_ERROR_PATH_UNSUPPORTED)}) {
        host.verbs[verb] = [&, expected = result](const std::string& line) {
            const std::vector<std::string> words = wordsIn(line);
            for (std::size_t i = 1; i < words.size(); ++i) {
                INFO(words[i]);
                CHECK(made->suggest("/interaction_profiles/" + words[0], "/user/" + words[i],
                                    typeOf(words[i])) == expected);
            }
        };
    }
    runScript(host);
}

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
                    doctest::Approx(-std::sin(std::numbers::pi / 8))));
        CHECK(location.pose.orientation.w == doctest::Approx(std::cos(std::numbers::pi / 8)));
    }
}

}  // SUITE(simulated_profiles)
