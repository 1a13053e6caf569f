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

struct Reading {
    bool is_active = false, has_changed = false;
    XrTime changed_at = 0;
    float x = 0, y = 0;

    bool operator==(const Reading&) const = default;
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
    std::vector<Bound> inputs;

    Played(const Profile& profile, std::string_view user)
        : HeadlessSession(k1_1, namesOf(enabledFor(profile))),
          profile_path(path(std::string(profile.path))),
          user_path(path(std::string(user))) {
        Bindings suggested;
        for (Bound bound : bindingsOf(profile, user)) {
            bound.action =
                makeAction(set, "action_" + std::to_string(suggested.size()), bound.type, {user_path});
            suggested.push_back({bound.action, bound.path});
            if (bound.type != XR_ACTION_TYPE_VIBRATION_OUTPUT) { inputs.push_back(bound); }
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
        const auto moved = [&](auto set_state, auto state) {
            return set_state(session, user_path, source, state);
        };
        REQUIRE(XR_SUCCESS == (bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT
                                   ? moved(XR(xrSetInputDeviceStateBoolEXT), value > 0)
                               : bound.type == XR_ACTION_TYPE_FLOAT_INPUT
                                   ? moved(XR(xrSetInputDeviceStateFloatEXT), value)
                                   : moved(XR(xrSetInputDeviceStateVector2fEXT), XrVector2f{value, -value})));
        synchronize();
    }
    Reading read(const Bound& bound) const {
        const auto reading = [](const auto& state, XrVector2f value) {
            return Reading{state.isActive != 0, state.changedSinceLastSync != 0, state.lastChangeTime,
                           value.x, value.y};
        };
        const auto readNumber = [&](const auto& state) {
            return reading(state, {static_cast<float>(state.currentState), 0});
        };
        if (bound.type == XR_ACTION_TYPE_POSE_INPUT) { return {pose(bound.action, user_path).isActive != 0}; }
        if (bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT) {
            return readNumber(boolean(bound.action, user_path));
        }
        if (bound.type == XR_ACTION_TYPE_FLOAT_INPUT) { return readNumber(number(bound.action, user_path)); }
        const XrActionStateVector2f state = vector(bound.action, user_path);
        return reading(state, state.currentState);
    }

    // A quarter turn to the left, at (1, 2, 3).
    void checkPose(const Bound& bound) const {
        constexpr float kHalf = 0.70710678f;
        const XrSpace stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
        const XrPosef wanted{{0, kHalf, 0, kHalf}, {1, 2, 3}};
        REQUIRE(XR(xrSetInputDeviceLocationEXT)(session, user_path, path(bound.path), stage, wanted) ==
                XR_SUCCESS);
        synchronize();
        const auto [type, next, flags, found] =
            locate(makeActionSpace(bound.action, user_path), stage, kStart);
        CHECK((flags & XR_SPACE_LOCATION_POSITION_VALID_BIT) != 0);
        checkNear(found.position, {1, 2, 3});
        CHECK(std::abs(found.orientation.y * kHalf + found.orientation.w * kHalf) == doctest::Approx(1));
    }
    // It moves by itself, and is held and released.
    void checkMoves(const Bound& bound) const {
        const float value = bound.type == XR_ACTION_TYPE_BOOLEAN_INPUT ? 1.0f : 0.75f;
        move(bound, value);
        const Reading moved = read(bound);
        CHECK(these(moved.x, moved.y) ==
              these(value, (bound.type == XR_ACTION_TYPE_VECTOR2F_INPUT ? -value : 0.0f)));
        CHECK((moved.has_changed && moved.changed_at > 0));
        for (const Bound& other : inputs) {
            if (other.path == bound.path || other.type != bound.type) { continue; }
            CHECK_MESSAGE(read(other).x == 0, other.path);
        }
        synchronize();
        CHECK((read(bound) == Reading{true, false, moved.changed_at, moved.x, moved.y}));
        move(bound, 0);
        const Reading released = read(bound);
        CHECK((released == Reading{true, true, released.changed_at, 0, 0}));
        CHECK(released.changed_at > moved.changed_at);
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

TEST_CASE("every input of every profile is read as it is moved, every pose where it is put") {
    for (const Profile& profile : simulated::listProfiles()) {
        for (const std::string_view user : profile.user_paths) {
            const Played played(profile, user);
            played.switchTo(false);
            for (const Bound& bound : played.inputs) {
                CHECK_MESSAGE((played.read(bound) == Reading{}), std::string(profile.path),
                              " without its device: ", bound.path);
            }
            played.switchTo(true);
            for (const Bound& bound : played.inputs) {
                INFO(std::string(profile.path), " ", bound.path);
                CHECK(played.read(bound).is_active);
                if (bound.type == XR_ACTION_TYPE_POSE_INPUT) {
                    played.checkPose(bound);
                } else {
                    played.checkMoves(bound);
                }
            }
        }
    }
}

TEST_CASE("the palm's surface lies beside the grip, turned towards the index finger") {
    const HeadlessSession made(k1_1, {}, "controller left 0 position 1 2 3 turn 40 10\n");
    const XrActionSet set = made.makeActionSet("set");
    const auto makePose = [&](const char* name) {
        return made.makeAction(set, name, XR_ACTION_TYPE_POSE_INPUT, {made.left, made.right});
    };
    const XrAction grip = makePose("grip"), surface = makePose("grip_surface");
    REQUIRE(made.suggest(kSimple, {{grip, "/user/hand/left/input/grip/pose"},
                                   {grip, "/user/hand/right/input/grip/pose"},
                                   {surface, "/user/hand/left/input/grip_surface/pose"},
                                   {surface, "/user/hand/right/input/grip_surface/pose"}}) == XR_SUCCESS);
    made.attach({set});
    made.begin();
    REQUIRE(made.sync(set) == XR_SUCCESS);
    for (const XrPath hand : {made.left, made.right}) {
        const auto [type, next, flags, pose] =
            made.locate(made.makeActionSpace(surface, hand), made.makeActionSpace(grip, hand), kStart);
        CHECK(these(flags, pose.position.x, pose.orientation.x, pose.orientation.w) ==
              these(15, doctest::Approx(hand == made.left ? -0.02 : 0.02),
                    doctest::Approx(-std::sin(std::numbers::pi / 8)),
                    doctest::Approx(std::cos(std::numbers::pi / 8))));
    }
}

}  // SUITE(simulated_profiles)
