// The supported controllers.
#include "xr/bindings.h"

#include <cctype>
#include <string_view>
#include <utility>

namespace binosplat::xr {
namespace {

constexpr const char *kTrigger = "input/trigger/value", *kSqueeze = "input/squeeze/value",
                     *kGrip = "input/squeeze/click", *kStick = "input/thumbstick", *kPad = "input/trackpad",
                     *kPadPress = "input/trackpad/click", *kPress = "input/thumbstick/click",
                     *kHaptic = "output/haptic";
constexpr std::array<const char*, 2> kUpperButtons{"input/y/click", "input/b/click"},
    kLowerButtons{"input/x/click", "input/a/click"}, kMenus{"input/menu/click", "input/menu/click"},
    kNone{nullptr, nullptr}, kB{"input/b/click", "input/b/click"}, kA{"input/a/click", "input/a/click"},
    kSecondary{"input/secondary/click", "input/secondary/click"},
    kPrimary{"input/primary/click", "input/primary/click"}, kBack{"input/back/click", "input/back/click"},
    kPenFront{"input/cluster_front_logitech/click", "input/cluster_front_logitech/click"},
    kFrameMenus{"input/view/click", "input/menu/click"},
    kFrameLower{"input/dpad_down/click", "input/a/click"};

constexpr ProfileBindings kProfiles[] = {
    {"khr/simple_controller", nullptr, "input/select/click", nullptr, nullptr, nullptr, nullptr, kMenus,
     kNone, kHaptic},
    {"oculus/touch_controller", nullptr, kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    // Its squeeze value is 1 as soon as the fingers close; a grab is pressure, so its force counts.
    {"valve/index_controller", nullptr, kTrigger, "input/squeeze/force", kStick, nullptr, kPress, kB, kA,
     kHaptic},
    {"microsoft/motion_controller", nullptr, kTrigger, kGrip, kStick, nullptr, kPress, kMenus, kNone,
     kHaptic},
    {"htc/vive_controller", nullptr, kTrigger, kGrip, kPad, kPadPress, nullptr, kMenus, kNone, kHaptic},
    {"hp/mixed_reality_controller", "XR_EXT_hp_mixed_reality_controller", kTrigger, kSqueeze, kStick, nullptr,
     kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"samsung/odyssey_controller", "XR_EXT_samsung_odyssey_controller", kTrigger, kGrip, kStick, nullptr,
     kPress, kMenus, kNone, kHaptic},
    {"htc/vive_cosmos_controller", "XR_HTC_vive_cosmos_controller_interaction", kTrigger, kGrip, kStick,
     nullptr, kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"htc/vive_focus3_controller", "XR_HTC_vive_focus3_controller_interaction", kTrigger, kGrip, kStick,
     nullptr, kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"bytedance/pico_neo3_controller", "XR_BD_controller_interaction", kTrigger, kSqueeze, kStick, nullptr,
     kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"bytedance/pico4_controller", "XR_BD_controller_interaction", kTrigger, kSqueeze, kStick, nullptr,
     kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"facebook/touch_controller_pro", "XR_FB_touch_controller_pro", kTrigger, kSqueeze, kStick, nullptr,
     kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"meta/touch_controller_plus", "XR_META_touch_controller_plus", kTrigger, kSqueeze, kStick, nullptr,
     kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"bytedance/pico_ultra_controller_bd", "XR_BD_ultra_controller_interaction", kTrigger, kSqueeze, kStick,
     nullptr, kPress, kUpperButtons, kLowerButtons, kHaptic},
    {"bytedance/pico_g3_controller", "XR_BD_controller_interaction", kTrigger, nullptr, kStick, nullptr,
     kPress, kMenus, kNone, nullptr},
    {"varjo/xr-4_controller", "XR_VARJO_xr4_controller_interaction", kTrigger, kGrip, kStick, nullptr, kPress,
     kB, kA, kHaptic},
    {"ml/ml2_controller", "XR_ML_ml2_controller_interaction", kTrigger, "input/shoulder/click", kPad,
     kPadPress, nullptr, kMenus, kNone, kHaptic},
    {"yvr/touch_controller_yvr", "XR_YVR_controller_interaction", kTrigger, kGrip, kStick, nullptr, kPress,
     kUpperButtons, kLowerButtons, kHaptic},
    {"oppo/mr_controller_oppo", "XR_OPPO_controller_interaction", kTrigger, kSqueeze, kStick, nullptr, kPress,
     kUpperButtons, kLowerButtons, kHaptic},
    {"huawei/controller", "XR_HUAWEI_controller_interaction", kTrigger, nullptr, kPad, kPadPress, nullptr,
     kBack, kNone, kHaptic},
    // The runtime decides which buttons a person finds there.
    {"khr/generic_controller", "XR_KHR_generic_controller", kTrigger, kSqueeze, kStick, nullptr, kPress,
     kSecondary, kPrimary, kHaptic},
    // The registry does not have it yet: by the table of Valve's OpenXR utilities for Unity.
    {"valve/frame_controller_valve", "XR_VALVE_frame_controller_interaction", kTrigger, kSqueeze, kStick,
     nullptr, kPress, kFrameMenus, kFrameLower, kHaptic},
    // A pen, held like one: its middle button senses how hard it is pressed; its tip is for surfaces.
    {"logitech/mx_ink_stylus_logitech", "XR_LOGITECH_mx_ink_stylus_interaction",
     "input/cluster_middle_logitech/force", "input/cluster_back_logitech/click", nullptr, nullptr, nullptr,
     kPenFront, kNone, kHaptic},
    // Bare hands: pinching while pointing clicks, a fist grabs.
    {"ext/hand_interaction_ext", "XR_EXT_hand_interaction", "input/aim_activate_ext/value",
     "input/grasp_ext/value", nullptr, nullptr, nullptr, kNone, kNone, nullptr},
    {"microsoft/hand_interaction", "XR_MSFT_hand_interaction", "input/select/value", kSqueeze, nullptr,
     nullptr, nullptr, kNone, kNone, nullptr},
};

}  // namespace

std::span<const ProfileBindings> allProfileBindings() { return kProfiles; }

const ProfileBindings& usualBindings() { return kProfiles[1]; }

std::string inputName(const char* path) {
    static constexpr std::pair<std::string_view, std::string_view> kOwnNames[] = {
        {"thumbstick", "stick"},
        {"trackpad", "pad"},
        {"aim_activate_ext", "pinch"},
        {"grasp_ext", "fist"},
        {"dpad_down", "D-pad down"},
        {"cluster_front_logitech", "front button"},
        {"primary", "primary button"},
        {"secondary", "secondary button"},
        {"cluster_middle_logitech", "middle button"},
        {"cluster_back_logitech", "back button"}};
    std::string_view name(path);
    name.remove_prefix(name.find('/') + 1);
    name = name.substr(0, name.find('/'));
    for (const auto& [part, own] : kOwnNames) {
        if (name == part) { return std::string(own); }
    }
    if (name == "select" && std::string_view(path).ends_with("value")) { return "pinch"; }
    return name.size() == 1
               ? std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(name[0]))))
               : std::string(name);
}

}  // namespace binosplat::xr
