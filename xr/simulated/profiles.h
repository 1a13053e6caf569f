// Section 6.4 of the specification: which input and output paths each interaction profile of the core has.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace simulated {

struct Profile {
    std::string_view path;
    std::string_view title;
    std::span<const std::string_view> user_paths;
    std::span<const std::string_view> components;
    std::span<const std::string_view> left_components, right_components;
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
bool allowsBinding(const Profile& profile, std::string_view binding);
bool hasComponent(const Profile& profile, std::string_view user_path, std::string_view component);

// /user/hand/left, /user/hand/right, /user/head, /user/gamepad, /user/treadmill.
bool isUserPath(std::string_view path);
// The user path that a binding starts with; empty if none.
std::string_view userPathOf(std::string_view binding);

}  // namespace simulated
