#include "xr/simulated/profiles.h"

#include <algorithm>
#include <array>

namespace simulated {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view kProfilePrefix = "/interaction_profiles/";
constexpr std::string_view kHands[] = {"/user/hand/left", "/user/hand/right"};
constexpr std::string_view kHead[] = {"/user/head"};
constexpr std::string_view kGamepad[] = {"/user/gamepad"};
constexpr std::string_view kUserPaths[] = {"/user/hand/left", "/user/hand/right", "/user/head", "/user/gamepad", "/user/treadmill"};

constexpr std::string_view kSimple[] = {"/input/select/click", "/input/menu/click", "/input/grip/pose", "/input/aim/pose",
                                        "/output/haptic"};
constexpr std::string_view kDaydream[] = {"/input/select/click",   "/input/trackpad/x", "/input/trackpad/y", "/input/trackpad/click",
                                          "/input/trackpad/touch", "/input/grip/pose",  "/input/aim/pose"};
constexpr std::string_view kVive[] = {"/input/system/click",   "/input/squeeze/click", "/input/menu/click", "/input/trigger/click",
                                      "/input/trigger/value",  "/input/trackpad/x",    "/input/trackpad/y", "/input/trackpad/click",
                                      "/input/trackpad/touch", "/input/grip/pose",     "/input/aim/pose",   "/output/haptic"};
constexpr std::string_view kVivePro[] = {"/input/system/click", "/input/volume_up/click", "/input/volume_down/click",
                                         "/input/mute_mic/click"};
constexpr std::string_view kMotion[] = {"/input/menu/click",     "/input/squeeze/click",    "/input/trigger/value", "/input/thumbstick/x",
                                        "/input/thumbstick/y",   "/input/thumbstick/click", "/input/trackpad/x",    "/input/trackpad/y",
                                        "/input/trackpad/click", "/input/trackpad/touch",   "/input/grip/pose",     "/input/aim/pose",
                                        "/output/haptic"};
constexpr std::string_view kXbox[] = {"/input/menu/click",
                                      "/input/view/click",
                                      "/input/a/click",
                                      "/input/b/click",
                                      "/input/x/click",
                                      "/input/y/click",
                                      "/input/dpad_down/click",
                                      "/input/dpad_right/click",
                                      "/input/dpad_up/click",
                                      "/input/dpad_left/click",
                                      "/input/shoulder_left/click",
                                      "/input/shoulder_right/click",
                                      "/input/thumbstick_left/click",
                                      "/input/thumbstick_right/click",
                                      "/input/trigger_left/value",
                                      "/input/trigger_right/value",
                                      "/input/thumbstick_left/x",
                                      "/input/thumbstick_left/y",
                                      "/input/thumbstick_right/x",
                                      "/input/thumbstick_right/y",
                                      "/output/haptic_left",
                                      "/output/haptic_right",
                                      "/output/haptic_left_trigger",
                                      "/output/haptic_right_trigger"};
constexpr std::string_view kGo[] = {"/input/system/click",   "/input/trigger/click", "/input/back/click",
                                    "/input/trackpad/x",     "/input/trackpad/y",    "/input/trackpad/click",
                                    "/input/trackpad/touch", "/input/grip/pose",     "/input/aim/pose"};
constexpr std::string_view kTouch[] = {"/input/squeeze/value",    "/input/trigger/value",   "/input/trigger/touch",
                                       "/input/thumbstick/x",     "/input/thumbstick/y",    "/input/thumbstick/click",
                                       "/input/thumbstick/touch", "/input/thumbrest/touch", "/input/grip/pose",
                                       "/input/aim/pose",         "/output/haptic"};
constexpr std::string_view kTouchLeft[] = {"/input/x/click", "/input/x/touch", "/input/y/click", "/input/y/touch", "/input/menu/click"};
constexpr std::string_view kTouchRight[] = {"/input/a/click", "/input/a/touch", "/input/b/click", "/input/b/touch", "/input/system/click"};
constexpr std::string_view kIndex[] = {"/input/system/click",  "/input/system/touch",     "/input/a/click",          "/input/a/touch",
                                       "/input/b/click",       "/input/b/touch",          "/input/squeeze/value",    "/input/squeeze/force",
                                       "/input/trigger/click", "/input/trigger/value",    "/input/trigger/touch",    "/input/thumbstick/x",
                                       "/input/thumbstick/y",  "/input/thumbstick/click", "/input/thumbstick/touch", "/input/trackpad/x",
                                       "/input/trackpad/y",    "/input/trackpad/force",   "/input/trackpad/touch",   "/input/grip/pose",
                                       "/input/aim/pose",      "/output/haptic"};

constexpr std::array<Profile, 9> kProfiles{{
    {"/interaction_profiles/oculus/touch_controller", "Touch controller", kHands, kTouch, kTouchLeft, kTouchRight},
    {"/interaction_profiles/valve/index_controller", "Index controller", kHands, kIndex, {}, {}},
    {"/interaction_profiles/microsoft/motion_controller", "Motion controller", kHands, kMotion, {}, {}},
    {"/interaction_profiles/htc/vive_controller", "Vive controller", kHands, kVive, {}, {}},
    {"/interaction_profiles/khr/simple_controller", "Simple controller", kHands, kSimple, {}, {}},
    {"/interaction_profiles/oculus/go_controller", "Go controller", kHands, kGo, {}, {}},
    {"/interaction_profiles/google/daydream_controller", "Daydream controller", kHands, kDaydream, {}, {}},
    {"/interaction_profiles/htc/vive_pro", "Vive Pro headset", kHead, kVivePro, {}, {}},
    {"/interaction_profiles/microsoft/xbox_controller", "Xbox controller", kGamepad, kXbox, {}, {}},
}};

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
    const auto found = std::find_if(kProfiles.begin(), kProfiles.end(), [&](const Profile& profile) { return profile.path == path; });
    return found == kProfiles.end() ? nullptr : &*found;
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

bool hasComponent(const Profile& profile, std::string_view user_path, std::string_view component) {
    const Names of_side = user_path == "/user/hand/left" ? profile.left_components : profile.right_components;
    return holds(profile.user_paths, user_path) && (holds(profile.components, component) || holds(of_side, component));
}

bool allowsBinding(const Profile& profile, std::string_view binding) {
    const std::string_view user_path = userPathOf(binding);
    if (!holds(profile.user_paths, user_path)) return false;
    const std::string_view component = binding.substr(user_path.size());
    const Names of_side = user_path == "/user/hand/left" ? profile.left_components : profile.right_components;
    return hasComponent(profile, user_path, component) || isParentIn(profile.components, component) || isParentIn(of_side, component);
}

bool isUserPath(std::string_view path) { return holds(kUserPaths, path); }

std::string_view userPathOf(std::string_view binding) {
    for (const std::string_view user_path : kUserPaths) {
        if (binding.starts_with(user_path) && binding.size() > user_path.size() && binding[user_path.size()] == '/') return user_path;
    }
    return {};
}

}  // namespace simulated
