// The supported controllers.
#include "xr/bindings.h"

namespace binosplat::xr {
namespace {

constexpr const char *kTrigger = "input/trigger/value", *kSqueeze = "input/squeeze/value", *kGrip = "input/squeeze/click",
                     *kStick = "input/thumbstick", *kPress = "input/thumbstick/click", *kHaptic = "output/haptic";
constexpr std::array<const char*, 2> kUpperButtons{"input/y/click", "input/b/click"}, kLowerButtons{"input/x/click", "input/a/click"},
    kMenus{"input/menu/click", "input/menu/click"}, kNone{nullptr, nullptr};

constexpr ProfileBindings kProfiles[] = {
    {"khr/simple_controller", nullptr, "input/select/click", nullptr, nullptr, nullptr, nullptr, kMenus, kNone, kHaptic},
    {"oculus/touch_controller", nullptr, kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons, kLowerButtons, kHaptic},
    // Its squeeze value is 1 as soon as the fingers close; a grab is pressure, so its force counts.
    {"valve/index_controller",
     nullptr,
     kTrigger,
     "input/squeeze/force",
     kStick,
     nullptr,
     kPress,
     {"input/b/click", "input/b/click"},
     {"input/a/click", "input/a/click"},
     kHaptic},
    {"microsoft/motion_controller", nullptr, kTrigger, kGrip, kStick, nullptr, kPress, kMenus, kNone, kHaptic},
    {"htc/vive_controller", nullptr, kTrigger, kGrip, "input/trackpad", "input/trackpad/click", nullptr, kMenus, kNone, kHaptic},
    {"hp/mixed_reality_controller", "XR_EXT_hp_mixed_reality_controller", kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"samsung/odyssey_controller", "XR_EXT_samsung_odyssey_controller", kTrigger, kGrip, kStick, nullptr, kPress, kMenus, kNone, kHaptic},
    {"htc/vive_cosmos_controller", "XR_HTC_vive_cosmos_controller_interaction", kTrigger, kGrip, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"htc/vive_focus3_controller", "XR_HTC_vive_focus3_controller_interaction", kTrigger, kGrip, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"bytedance/pico_neo3_controller", "XR_BD_controller_interaction", kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"bytedance/pico4_controller", "XR_BD_controller_interaction", kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"facebook/touch_controller_pro", "XR_FB_touch_controller_pro", kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    {"meta/touch_controller_plus", "XR_META_touch_controller_plus", kTrigger, kSqueeze, kStick, nullptr, kPress, kUpperButtons,
     kLowerButtons, kHaptic},
    // Bare hands: pinching while pointing clicks, a fist grabs.
    {"ext/hand_interaction_ext", "XR_EXT_hand_interaction", "input/aim_activate_ext/value", "input/grasp_ext/value", nullptr, nullptr,
     nullptr, kNone, kNone, nullptr},
    {"microsoft/hand_interaction", "XR_MSFT_hand_interaction", "input/select/value", kSqueeze, nullptr, nullptr, nullptr, kNone, kNone,
     nullptr},
};

}  // namespace

std::span<const ProfileBindings> allProfileBindings() { return kProfiles; }

}  // namespace binosplat::xr
