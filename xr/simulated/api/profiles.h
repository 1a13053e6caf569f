// Section 6.4 of the specification: which input and output paths each interaction profile of the core, 1.0 and 1.1, has.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace simulated {

// kNone: only an extension has it.
enum class Since { k1_0, k1_1, kNone };

struct Profile {
    std::string_view path;
    std::string_view title;
    std::span<const std::string_view> user_paths;
    std::span<const std::string_view> components;
    std::span<const std::string_view> left_components, right_components;
    // Before that, with this extension, if there is one.
    Since since = Since::k1_0;
    std::string_view extension = {};
};

// What of all hands' paths an instance has: grip_surface came with 1.1 (and XR_KHR_maintenance1), palm_ext is XR_EXT_palm_pose's name for
// it; XR_EXT_hand_interaction knows the finger tips of whatever hand holds something.
struct Vocabulary {
    bool has_grip_surface = false;
    bool has_palm_ext = false;
    bool has_finger_tips = false;
};

// In the order in which the simulated controllers like to play them; those that they cannot play come last.
std::span<const Profile> allProfiles();
// Null if the core has no such profile.
const Profile* findProfile(std::string_view path);
// Of controllers held in the hands, by what follows /interaction_profiles/; null if there is none.
const Profile* findHandProfile(std::string_view name);
// All of these names, for messages.
std::string handProfiles();
// Whether "/user/hand/left/input/trigger/value", or a parent of components such as ".../input/trigger", may be bound in this profile.
bool allowsBinding(const Profile& profile, std::string_view binding, const Vocabulary& words);
bool hasComponent(const Profile& profile, std::string_view user_path, std::string_view component, const Vocabulary& words);

// /user/hand/left, /user/hand/right, /user/head, /user/gamepad, /user/treadmill, and /user/eyes_ext of XR_EXT_eye_gaze_interaction.
bool isUserPath(std::string_view path);
// "/user/hand/left" is 0, right 1, head 2, gamepad 3, eyes 4 (script.h's InputDevice); none for others.
std::optional<std::size_t> deviceOf(std::string_view user_path);
// The user path that a binding starts with; empty if none.
std::string_view userPathOf(std::string_view binding);

}  // namespace simulated
