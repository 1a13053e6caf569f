// Section 6.4 of the specification: the input and output paths of each interaction profile.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace simulated {

// A component's type in the registry.
enum class ComponentKind { kBoolean, kFloat, kPose, kVibration };

// `depends` is in the registry's notation: names of versions and extensions, where + is and, and a comma is
// or; empty: always.
struct Component {
    ComponentKind kind;
    std::string_view path;            // "/input/trigger/value"
    std::string_view user_path = {};  // empty: all of the profile's
    std::string_view depends = {};
};

struct Profile {
    std::string_view path;
    std::string_view title;
    std::span<const std::string_view> user_paths;
    std::span<const Component> components;
    std::string_view depends = {};
};

// The version and extensions of an instance.
struct Enabled {
    // API 1.1, not 1.0.
    bool is_1_1 = false;
    std::set<std::string, std::less<>> extensions;

    [[nodiscard]] bool meets(std::string_view depends) const;
};

// In the simulated controllers' order of preference; profiles that they cannot simulate come last.
std::span<const Profile> listProfiles();
// Null if the core has no such profile.
const Profile* findProfile(std::string_view path);
// A profile of hand-held controllers, by its path after /interaction_profiles/; null if there is none.
const Profile* findHandProfile(std::string_view name);
// The names of all such profiles, for messages.
std::string listHandProfiles();
// True if "/user/hand/left/input/trigger/value", or a parent of components such as ".../input/trigger", may
// be bound in this profile.
bool allowsBinding(const Profile& profile, std::string_view binding, const Enabled& enabled);
// Null if the profile has no such component at this user path, with this version and these extensions.
const Component* findComponent(const Profile& profile, std::string_view user_path, std::string_view path,
                               const Enabled& enabled);

// The extension or version that this path needs in the profile, if only that is missing; otherwise empty.
std::string_view findNeeded(const Profile& profile, std::string_view binding);

// /user/hand/left, /user/hand/right, /user/head, /user/gamepad, /user/treadmill, and /user/eyes_ext of
// XR_EXT_eye_gaze_interaction.
bool isUserPath(std::string_view path);
// "/user/hand/left" is 0, right 1, head 2, gamepad 3, eyes 4 (script.h's InputDevice); none for others.
std::optional<std::size_t> deviceOf(std::string_view user_path);
// The user path that a binding starts with; empty if none.
std::string_view userPathOf(std::string_view binding);

}  // namespace simulated
