// Searches in the tables of profile_tables.h.
#include "xr/simulated/api/profiles.h"

#include <algorithm>

#include "xr/simulated/api/profile_tables.h"

namespace simulated {
namespace {

constexpr std::string_view kProfilePrefix = "/interaction_profiles/";
constexpr std::string_view kUserPaths[] = {"/user/hand/left", "/user/hand/right", "/user/head",
                                           "/user/gamepad",   "/user/eyes_ext",   "/user/treadmill"};

bool holds(std::span<const std::string_view> names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

bool isThere(const Component& component, std::string_view user_path, const Enabled& enabled) {
    return (component.user_path.empty() || component.user_path == user_path) &&
           enabled.meets(component.depends);
}

// "/input/trigger" stands for its components; "/input" and "/output" stand for nothing.
bool isParent(std::string_view parent, std::string_view path) {
    return parent.starts_with("/input/") && path.starts_with(parent) && path.size() > parent.size() &&
           path[parent.size()] == '/';
}

}  // namespace

std::span<const Profile> listProfiles() { return kProfiles; }

const Profile* findProfile(std::string_view path) {
    const auto found = std::find_if(std::begin(kProfiles), std::end(kProfiles),
                                    [&](const Profile& profile) { return profile.path == path; });
    return found == std::end(kProfiles) ? nullptr : &*found;
}

const Profile* findHandProfile(std::string_view name) {
    const Profile* const found = findProfile(std::string(kProfilePrefix).append(name));
    return found != nullptr && found->user_paths.front().starts_with("/user/hand/") ? found : nullptr;
}

std::string listHandProfiles() {
    std::string names;
    for (const Profile& profile : kProfiles) {
        if (profile.user_paths.front().starts_with("/user/hand/")) {
            names.append(names.empty() ? "" : ", ").append(profile.path.substr(kProfilePrefix.size()));
        }
    }
    return names;
}

bool Enabled::meets(std::string_view depends) const {
    const auto has = [&](std::string_view name) {
        return name == "XR_VERSION_1_1" ? is_1_1 : extensions.contains(name);
    };
    bool meets = true;
    while (!depends.empty()) {
        const std::size_t end = depends.find_first_of("+,");
        meets = meets && has(depends.substr(0, end));
        if (end == std::string_view::npos) { break; }
        if (depends[end] == ',') {
            if (meets) { return true; }
            meets = true;
        }
        depends.remove_prefix(end + 1);
    }
    return meets;
}

const Component* findComponent(const Profile& profile, std::string_view user_path, std::string_view path,
                               const Enabled& enabled) {
    if (!holds(profile.user_paths, user_path)) { return nullptr; }
    const auto found = std::ranges::find_if(profile.components, [&](const Component& one) {
        return one.path == path && isThere(one, user_path, enabled);
    });
    return found == profile.components.end() ? nullptr : &*found;
}

bool allowsBinding(const Profile& profile, std::string_view binding, const Enabled& enabled) {
    const std::string_view user_path = userPathOf(binding);
    if (!holds(profile.user_paths, user_path)) { return false; }
    const std::string_view path = binding.substr(user_path.size());
    return std::ranges::any_of(profile.components, [&](const Component& one) {
        return isThere(one, user_path, enabled) && (one.path == path || isParent(path, one.path));
    });
}

std::string_view findNeeded(const Profile& profile, std::string_view binding) {
    const std::string_view user_path = userPathOf(binding), path = binding.substr(user_path.size());
    const auto found = std::ranges::find_if(profile.components, [&](const Component& one) {
        return one.path == path && (one.user_path.empty() || one.user_path == user_path);
    });
    return found == profile.components.end() || !holds(profile.user_paths, user_path) ? std::string_view()
                                                                                      : found->depends;
}

std::optional<std::size_t> deviceOf(std::string_view user_path) {
    // All but the last, in this order.
    for (std::size_t i = 0; i + 1 < std::size(kUserPaths); ++i) {
        if (kUserPaths[i] == user_path) { return i; }
    }
    return std::nullopt;
}

bool isUserPath(std::string_view path) { return holds(kUserPaths, path); }

std::string_view userPathOf(std::string_view binding) {
    for (const std::string_view user_path : kUserPaths) {
        if (binding.starts_with(user_path) && binding.size() > user_path.size() &&
            binding[user_path.size()] == '/') {
            return user_path;
        }
    }
    return {};
}

}  // namespace simulated
