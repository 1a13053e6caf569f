// Searches in the tables of profile_tables.h.
#include "xr/simulated/api/profiles.h"

#include <algorithm>

#include "xr/simulated/api/profile_tables.h"

namespace simulated {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view kProfilePrefix = "/interaction_profiles/";
constexpr std::string_view kUserPaths[] = {"/user/hand/left", "/user/hand/right", "/user/head",
                                           "/user/gamepad",   "/user/eyes_ext",   "/user/treadmill"};

bool holds(Names names, std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); }

// "/input/trigger" stands for its components; "/input" and "/output" stand for nothing.
bool isParentIn(Names names, std::string_view parent) {
    if (!parent.starts_with("/input/")) return false;
    return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
        return name.starts_with(parent) && name.size() > parent.size() && name[parent.size()] == '/';
    });
}

}  // namespace

std::span<const Profile> allProfiles() { return kProfiles; }

const Profile* findProfile(std::string_view path) {
    const auto found =
        std::find_if(std::begin(kProfiles), std::end(kProfiles), [&](const Profile& profile) { return profile.path == path; });
    return found == std::end(kProfiles) ? nullptr : &*found;
}

const Profile* findHandProfile(std::string_view name) {
    const Profile* const found = findProfile(std::string(kProfilePrefix).append(name));
    return found != nullptr && found->user_paths.front().starts_with("/user/hand/") ? found : nullptr;
}

std::string handProfiles() {
    std::string names;
    for (const Profile& profile : kProfiles) {
        if (profile.user_paths.front().starts_with("/user/hand/"))
            names.append(names.empty() ? "" : ", ").append(profile.path.substr(kProfilePrefix.size()));
    }
    return names;
}

bool hasComponent(const Profile& profile, std::string_view user_path, std::string_view component, const Vocabulary& words) {
    if (!holds(profile.user_paths, user_path)) return false;
    const Names of_side = user_path == "/user/hand/left" ? profile.left_components : profile.right_components;
    if (holds(profile.components, component) || holds(of_side, component)) return true;
    if (profile.user_paths.front() != kHands[0]) return false;
    return (component == "/input/grip_surface/pose" && words.has_grip_surface) ||
           (component == "/input/palm_ext/pose" && words.has_palm_ext) ||
           ((component == "/input/pinch_ext/pose" || component == "/input/poke_ext/pose") && words.has_finger_tips);
}

bool allowsBinding(const Profile& profile, std::string_view binding, const Vocabulary& words) {
    const std::string_view user_path = userPathOf(binding);
    if (!holds(profile.user_paths, user_path)) return false;
    const std::string_view component = binding.substr(user_path.size());
    const Names of_side = user_path == "/user/hand/left" ? profile.left_components : profile.right_components;
    return hasComponent(profile, user_path, component, words) || isParentIn(profile.components, component) ||
           isParentIn(of_side, component) ||
           (component.starts_with("/input/") && hasComponent(profile, user_path, std::string(component) + "/pose", words));
}

std::optional<std::size_t> deviceOf(std::string_view user_path) {
    // All but the last, in this order.
    for (std::size_t i = 0; i + 1 < std::size(kUserPaths); ++i) {
        if (kUserPaths[i] == user_path) return i;
    }
    return std::nullopt;
}

bool isUserPath(std::string_view path) { return holds(kUserPaths, path); }

std::string_view userPathOf(std::string_view binding) {
    for (const std::string_view user_path : kUserPaths) {
        if (binding.starts_with(user_path) && binding.size() > user_path.size() && binding[user_path.size()] == '/') return user_path;
    }
    return {};
}

}  // namespace simulated
