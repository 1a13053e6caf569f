// Which paths each interaction profile has, as the registry of OpenXR 1.1.61 (xr.xml) lists them. Made by
// make_profile_tables.py, which says how; not to be edited. Vectors such as /input/thumbstick stand here as
// their parts.
#pragma once

#include "xr/simulated/api/profiles.h"

namespace simulated {

using enum ComponentKind;

inline constexpr std::string_view kHands[] = {"/user/hand/left", "/user/hand/right"};
inline constexpr std::string_view kUserHead[] = {"/user/head"};
inline constexpr std::string_view kUserGamepad[] = {"/user/gamepad"};
inline constexpr std::string_view kUserEyesExt[] = {"/user/eyes_ext"};

// clang-format off
inline constexpr Component kOculusTouchController[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kBoolean, "/input/trigger/proximity", {}, "XR_VERSION_1_1"},
    {kBoolean, "/input/thumb_resting_surfaces/proximity", {}, "XR_VERSION_1_1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kValveIndexController[] = {
    {kBoolean, "/input/system/click"}, {kBoolean, "/input/system/touch"}, {kBoolean, "/input/a/click"}, {kBoolean, "/input/a/touch"},
    {kBoolean, "/input/b/click"}, {kBoolean, "/input/b/touch"}, {kFloat, "/input/squeeze/value"}, {kFloat, "/input/squeeze/force"},
    {kBoolean, "/input/trigger/click"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kBoolean, "/input/thumbstick/touch"}, {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"}, {kFloat, "/input/trackpad/force"},
    {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMicrosoftMotionController[] = {
    {kBoolean, "/input/menu/click"}, {kBoolean, "/input/squeeze/click"}, {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"},
    {kBoolean, "/input/trackpad/click"}, {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHtcViveController[] = {
    {kBoolean, "/input/system/click"}, {kBoolean, "/input/squeeze/click"}, {kBoolean, "/input/menu/click"},
    {kBoolean, "/input/trigger/click"}, {kFloat, "/input/trigger/value"}, {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"},
    {kBoolean, "/input/trackpad/click"}, {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kKhrSimpleController[] = {
    {kBoolean, "/input/select/click"}, {kBoolean, "/input/menu/click"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kOculusGoController[] = {
    {kBoolean, "/input/system/click"}, {kBoolean, "/input/trigger/click"}, {kBoolean, "/input/back/click"}, {kFloat, "/input/trackpad/x"},
    {kFloat, "/input/trackpad/y"}, {kBoolean, "/input/trackpad/click"}, {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"},
    {kPose, "/input/aim/pose"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kGoogleDaydreamController[] = {
    {kBoolean, "/input/select/click"}, {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"}, {kBoolean, "/input/trackpad/click"},
    {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchPlusController[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip_surface/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kBoolean, "/input/thumb_resting_surfaces/proximity"}, {kBoolean, "/input/trigger/proximity"},
    {kFloat, "/input/trigger_curl/value"}, {kFloat, "/input/trigger_slide/value"}, {kFloat, "/input/trigger/force"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchProController[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip_surface/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kFloat, "/input/thumbrest/force"}, {kFloat, "/input/stylus/force"},
    {kBoolean, "/input/thumb_resting_surfaces/proximity"}, {kFloat, "/input/trigger_curl/value"}, {kFloat, "/input/trigger_slide/value"},
    {kBoolean, "/input/trigger/proximity"}, {kVibration, "/output/haptic_trigger"}, {kVibration, "/output/haptic_thumb"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchControllerQuest2[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kBoolean, "/input/trigger/proximity"}, {kBoolean, "/input/thumb_resting_surfaces/proximity"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip_surface/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchControllerQuest1RiftS[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kBoolean, "/input/trigger/proximity"}, {kBoolean, "/input/thumb_resting_surfaces/proximity"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kPose, "/input/grip_surface/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchControllerRiftCv1[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kBoolean, "/input/trigger/proximity"}, {kBoolean, "/input/thumb_resting_surfaces/proximity"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip_surface/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kBytedancePico4Controller[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/menu/click", "/user/hand/left"},
    {kBoolean, "/input/y/touch", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click"}, {kBoolean, "/input/squeeze/click"},
    {kFloat, "/input/squeeze/value"}, {kBoolean, "/input/trigger/click"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kBytedancePicoNeo3Controller[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/a/click", "/user/hand/right"}, {kBoolean, "/input/a/touch", "/user/hand/right"},
    {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click"},
    {kBoolean, "/input/menu/click"}, {kBoolean, "/input/squeeze/click"}, {kFloat, "/input/squeeze/value"},
    {kBoolean, "/input/trigger/click"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/trigger/value"},
    {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kBytedancePicoG3Controller[] = {
    {kBoolean, "/input/trigger/click"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/menu/click"}, {kPose, "/input/grip/pose"},
    {kPose, "/input/aim/pose"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHtcViveCosmosController[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/y/click", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kBoolean, "/input/shoulder/click"}, {kBoolean, "/input/squeeze/click"}, {kBoolean, "/input/trigger/click"},
    {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHtcViveFocus3Controller[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/y/click", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kBoolean, "/input/squeeze/click"}, {kBoolean, "/input/squeeze/touch"}, {kFloat, "/input/squeeze/value"},
    {kBoolean, "/input/trigger/click"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/trigger/value"},
    {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kBoolean, "/input/thumbstick/touch"}, {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHpMixedRealityController[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/y/click", "/user/hand/left"},
    {kBoolean, "/input/a/click", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/menu/click"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kSamsungOdysseyController[] = {
    {kBoolean, "/input/menu/click"}, {kBoolean, "/input/squeeze/click"}, {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"},
    {kBoolean, "/input/trackpad/click"}, {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMlMl2Controller[] = {
    {kBoolean, "/input/menu/click"}, {kBoolean, "/input/home/click"}, {kBoolean, "/input/trigger/click"}, {kFloat, "/input/trigger/value"},
    {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"}, {kBoolean, "/input/trackpad/click"}, {kFloat, "/input/trackpad/force"},
    {kBoolean, "/input/trackpad/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kBoolean, "/input/shoulder/click"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kBytedancePicoUltraControllerBd[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/menu/click", "/user/hand/left"},
    {kBoolean, "/input/y/touch", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click"}, {kBoolean, "/input/squeeze/click"},
    {kFloat, "/input/squeeze/value"}, {kBoolean, "/input/trigger/click"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/aim/pose"}, {kPose, "/input/grip/pose"},
    {kPose, "/input/grip_surface/pose"}, {kVibration, "/output/haptic"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kVarjoXr4Controller[] = {
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/system/click", "/user/hand/right"}, {kBoolean, "/input/a/click"},
    {kBoolean, "/input/a/touch"}, {kBoolean, "/input/b/click"}, {kBoolean, "/input/b/touch"}, {kBoolean, "/input/squeeze/click"},
    {kBoolean, "/input/squeeze/touch"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kYvrTouchControllerYvr[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kBoolean, "/input/squeeze/click"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"},
    {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kOppoMrControllerOppo[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/menu/click", "/user/hand/left"},
    {kBoolean, "/input/y/touch", "/user/hand/left"}, {kFloat, "/input/heartrate_oppo/value", "/user/hand/left"},
    {kBoolean, "/input/a/click", "/user/hand/right"}, {kBoolean, "/input/a/touch", "/user/hand/right"},
    {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/b/touch", "/user/hand/right"},
    {kBoolean, "/input/home/click", "/user/hand/right"}, {kFloat, "/input/squeeze/value"}, {kBoolean, "/input/trigger/touch"},
    {kFloat, "/input/trigger/value"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"},
    {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"}, {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"},
    {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHuaweiController[] = {
    {kBoolean, "/input/home/click"}, {kBoolean, "/input/back/click"}, {kBoolean, "/input/volume_up/click"},
    {kBoolean, "/input/volume_down/click"}, {kBoolean, "/input/trigger/click"}, {kFloat, "/input/trigger/value"},
    {kFloat, "/input/trackpad/x"}, {kFloat, "/input/trackpad/y"}, {kBoolean, "/input/trackpad/click"}, {kBoolean, "/input/trackpad/touch"},
    {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kValveFrameControllerValve[] = {
    {kBoolean, "/input/dpad_up/click", "/user/hand/left"}, {kBoolean, "/input/dpad_up/touch", "/user/hand/left"},
    {kBoolean, "/input/dpad_left/click", "/user/hand/left"}, {kBoolean, "/input/dpad_left/touch", "/user/hand/left"},
    {kBoolean, "/input/dpad_down/click", "/user/hand/left"}, {kBoolean, "/input/dpad_down/touch", "/user/hand/left"},
    {kBoolean, "/input/dpad_right/click", "/user/hand/left"}, {kBoolean, "/input/dpad_right/touch", "/user/hand/left"},
    {kBoolean, "/input/view/click", "/user/hand/left"}, {kBoolean, "/input/view/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/right"}, {kBoolean, "/input/y/touch", "/user/hand/right"},
    {kBoolean, "/input/b/click", "/user/hand/right"}, {kBoolean, "/input/b/touch", "/user/hand/right"},
    {kBoolean, "/input/a/click", "/user/hand/right"}, {kBoolean, "/input/a/touch", "/user/hand/right"},
    {kBoolean, "/input/x/click", "/user/hand/right"}, {kBoolean, "/input/x/touch", "/user/hand/right"},
    {kBoolean, "/input/menu/click", "/user/hand/right"}, {kBoolean, "/input/menu/touch", "/user/hand/right"},
    {kBoolean, "/input/bumper/click"}, {kBoolean, "/input/bumper/touch"}, {kBoolean, "/input/system/click"},
    {kBoolean, "/input/system/touch"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/click"},
    {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/squeeze/value"}, {kBoolean, "/input/squeeze/click"},
    {kBoolean, "/input/squeeze/touch"}, {kFloat, "/input/thumbstick/x"}, {kFloat, "/input/thumbstick/y"},
    {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"},
};
inline constexpr Component kKhrGenericController[] = {
    {kBoolean, "/input/primary/click"}, {kBoolean, "/input/secondary/click"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kFloat, "/input/squeeze/value"},
    {kFloat, "/input/trigger/value"}, {kPose, "/input/grip/pose"}, {kPose, "/input/grip_surface/pose"}, {kPose, "/input/aim/pose"},
    {kVibration, "/output/haptic"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kLogitechMxInkStylusLogitech[] = {
    {kFloat, "/input/tip_logitech/force"}, {kFloat, "/input/cluster_middle_logitech/force"},
    {kBoolean, "/input/cluster_front_logitech/click"}, {kBoolean, "/input/cluster_front_logitech/double_tap_logitech"},
    {kBoolean, "/input/cluster_back_logitech/click"}, {kBoolean, "/input/cluster_back_logitech/double_tap_logitech"},
    {kBoolean, "/input/system/click"}, {kBoolean, "/input/dock_logitech/docked_logitech"}, {kPose, "/input/grip/pose"},
    {kPose, "/input/aim/pose"}, {kPose, "/input/tip_logitech/pose"}, {kVibration, "/output/haptic"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kFacebookTouchControllerPro[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kFloat, "/input/thumbrest/force"}, {kFloat, "/input/stylus_fb/force"}, {kFloat, "/input/trigger/curl_fb"},
    {kFloat, "/input/trigger/slide_fb"}, {kBoolean, "/input/thumb_fb/proximity_fb"}, {kBoolean, "/input/trigger/proximity_fb"},
    {kVibration, "/output/haptic_trigger_fb"}, {kVibration, "/output/haptic_thumb_fb"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kMetaTouchControllerPlus[] = {
    {kBoolean, "/input/x/click", "/user/hand/left"}, {kBoolean, "/input/x/touch", "/user/hand/left"},
    {kBoolean, "/input/y/click", "/user/hand/left"}, {kBoolean, "/input/y/touch", "/user/hand/left"},
    {kBoolean, "/input/menu/click", "/user/hand/left"}, {kBoolean, "/input/a/click", "/user/hand/right"},
    {kBoolean, "/input/a/touch", "/user/hand/right"}, {kBoolean, "/input/b/click", "/user/hand/right"},
    {kBoolean, "/input/b/touch", "/user/hand/right"}, {kBoolean, "/input/system/click", "/user/hand/right"},
    {kFloat, "/input/squeeze/value"}, {kFloat, "/input/trigger/value"}, {kBoolean, "/input/trigger/touch"}, {kFloat, "/input/thumbstick/x"},
    {kFloat, "/input/thumbstick/y"}, {kBoolean, "/input/thumbstick/click"}, {kBoolean, "/input/thumbstick/touch"},
    {kBoolean, "/input/thumbrest/touch"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"}, {kVibration, "/output/haptic"},
    {kBoolean, "/input/thumb_meta/proximity_meta"}, {kBoolean, "/input/trigger/proximity_meta"}, {kFloat, "/input/trigger/curl_meta"},
    {kFloat, "/input/trigger/slide_meta"}, {kFloat, "/input/trigger/force"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kExtHandInteractionExt[] = {
    {kPose, "/input/pinch_ext/pose"}, {kPose, "/input/poke_ext/pose"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kFloat, "/input/pinch_ext/value"}, {kBoolean, "/input/pinch_ext/ready_ext"}, {kFloat, "/input/grasp_ext/value"},
    {kBoolean, "/input/grasp_ext/ready_ext"}, {kFloat, "/input/aim_activate_ext/value"}, {kBoolean, "/input/aim_activate_ext/ready_ext"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
};
inline constexpr Component kMicrosoftHandInteraction[] = {
    {kFloat, "/input/select/value"}, {kFloat, "/input/squeeze/value"}, {kPose, "/input/grip/pose"}, {kPose, "/input/aim/pose"},
    {kPose, "/input/grip_surface/pose", {}, "XR_VERSION_1_1,XR_KHR_maintenance1"}, {kPose, "/input/palm_ext/pose", {}, "XR_EXT_palm_pose"},
    {kPose, "/input/pinch_ext/pose", {}, "XR_EXT_hand_interaction"}, {kPose, "/input/poke_ext/pose", {}, "XR_EXT_hand_interaction"},
};
inline constexpr Component kHtcVivePro[] = {
    {kBoolean, "/input/system/click"}, {kBoolean, "/input/volume_up/click"}, {kBoolean, "/input/volume_down/click"},
    {kBoolean, "/input/mute_mic/click"},
};
inline constexpr Component kMicrosoftXboxController[] = {
    {kBoolean, "/input/menu/click"}, {kBoolean, "/input/view/click"}, {kBoolean, "/input/a/click"}, {kBoolean, "/input/b/click"},
    {kBoolean, "/input/x/click"}, {kBoolean, "/input/y/click"}, {kBoolean, "/input/dpad_down/click"}, {kBoolean, "/input/dpad_right/click"},
    {kBoolean, "/input/dpad_up/click"}, {kBoolean, "/input/dpad_left/click"}, {kBoolean, "/input/shoulder_left/click"},
    {kBoolean, "/input/shoulder_right/click"}, {kBoolean, "/input/thumbstick_left/click"}, {kBoolean, "/input/thumbstick_right/click"},
    {kFloat, "/input/trigger_left/value"}, {kFloat, "/input/trigger_right/value"}, {kFloat, "/input/thumbstick_left/x"},
    {kFloat, "/input/thumbstick_left/y"}, {kFloat, "/input/thumbstick_right/x"}, {kFloat, "/input/thumbstick_right/y"},
    {kVibration, "/output/haptic_left"}, {kVibration, "/output/haptic_right"}, {kVibration, "/output/haptic_left_trigger"},
    {kVibration, "/output/haptic_right_trigger"},
};
inline constexpr Component kExtEyeGazeInteraction[] = {
    {kPose, "/input/gaze_ext/pose"},
};
// clang-format on

inline constexpr Profile kProfiles[] = {
    {"/interaction_profiles/oculus/touch_controller", "Touch controller", kHands, kOculusTouchController},
    {"/interaction_profiles/valve/index_controller", "Index controller", kHands, kValveIndexController},
    {"/interaction_profiles/microsoft/motion_controller", "Motion controller", kHands, kMicrosoftMotionController},
    {"/interaction_profiles/htc/vive_controller", "Vive controller", kHands, kHtcViveController},
    {"/interaction_profiles/khr/simple_controller", "Simple controller", kHands, kKhrSimpleController},
    {"/interaction_profiles/oculus/go_controller", "Go controller", kHands, kOculusGoController},
    {"/interaction_profiles/google/daydream_controller", "Daydream controller", kHands, kGoogleDaydreamController},
    {"/interaction_profiles/meta/touch_plus_controller", "Touch Plus controller", kHands, kMetaTouchPlusController, "XR_VERSION_1_1"},
    {"/interaction_profiles/meta/touch_pro_controller", "Touch Pro controller", kHands, kMetaTouchProController, "XR_VERSION_1_1"},
    {"/interaction_profiles/meta/touch_controller_quest_2", "Quest 2 controller", kHands, kMetaTouchControllerQuest2, "XR_VERSION_1_1"},
    {"/interaction_profiles/meta/touch_controller_quest_1_rift_s", "Quest 1 and Rift S controller", kHands, kMetaTouchControllerQuest1RiftS,
     "XR_VERSION_1_1"},
    {"/interaction_profiles/meta/touch_controller_rift_cv1", "Rift CV1 controller", kHands, kMetaTouchControllerRiftCv1, "XR_VERSION_1_1"},
    {"/interaction_profiles/bytedance/pico4_controller", "PICO 4 controller", kHands, kBytedancePico4Controller,
     "XR_VERSION_1_1,XR_BD_controller_interaction"},
    {"/interaction_profiles/bytedance/pico_neo3_controller", "PICO Neo3 controller", kHands, kBytedancePicoNeo3Controller,
     "XR_VERSION_1_1,XR_BD_controller_interaction"},
    {"/interaction_profiles/bytedance/pico_g3_controller", "PICO G3 controller", kHands, kBytedancePicoG3Controller,
     "XR_VERSION_1_1,XR_BD_controller_interaction"},
    {"/interaction_profiles/htc/vive_cosmos_controller", "Vive Cosmos controller", kHands, kHtcViveCosmosController,
     "XR_VERSION_1_1,XR_HTC_vive_cosmos_controller_interaction"},
    {"/interaction_profiles/htc/vive_focus3_controller", "Vive Focus 3 controller", kHands, kHtcViveFocus3Controller,
     "XR_VERSION_1_1,XR_HTC_vive_focus3_controller_interaction"},
    {"/interaction_profiles/hp/mixed_reality_controller", "HP controller", kHands, kHpMixedRealityController,
     "XR_VERSION_1_1,XR_EXT_hp_mixed_reality_controller"},
    {"/interaction_profiles/samsung/odyssey_controller", "Odyssey controller", kHands, kSamsungOdysseyController,
     "XR_VERSION_1_1,XR_EXT_samsung_odyssey_controller"},
    {"/interaction_profiles/ml/ml2_controller", "Magic Leap 2 controller", kHands, kMlMl2Controller,
     "XR_VERSION_1_1,XR_ML_ml2_controller_interaction"},
    {"/interaction_profiles/bytedance/pico_ultra_controller_bd", "PICO Ultra controller", kHands, kBytedancePicoUltraControllerBd,
     "XR_BD_ultra_controller_interaction"},
    {"/interaction_profiles/varjo/xr-4_controller", "XR-4 controller", kHands, kVarjoXr4Controller, "XR_VARJO_xr4_controller_interaction"},
    {"/interaction_profiles/yvr/touch_controller_yvr", "YVR controller", kHands, kYvrTouchControllerYvr, "XR_YVR_controller_interaction"},
    {"/interaction_profiles/oppo/mr_controller_oppo", "OPPO controller", kHands, kOppoMrControllerOppo, "XR_OPPO_controller_interaction"},
    {"/interaction_profiles/huawei/controller", "Huawei controller", kHands, kHuaweiController, "XR_HUAWEI_controller_interaction"},
    {"/interaction_profiles/valve/frame_controller_valve", "Frame controller", kHands, kValveFrameControllerValve,
     "XR_VALVE_frame_controller_interaction"},
    {"/interaction_profiles/khr/generic_controller", "Generic controller", kHands, kKhrGenericController, "XR_KHR_generic_controller"},
    {"/interaction_profiles/logitech/mx_ink_stylus_logitech", "MX Ink", kHands, kLogitechMxInkStylusLogitech,
     "XR_LOGITECH_mx_ink_stylus_interaction"},
    {"/interaction_profiles/facebook/touch_controller_pro", "Touch Pro controller", kHands, kFacebookTouchControllerPro,
     "XR_FB_touch_controller_pro"},
    {"/interaction_profiles/meta/touch_controller_plus", "Touch Plus controller", kHands, kMetaTouchControllerPlus,
     "XR_META_touch_controller_plus"},
    {"/interaction_profiles/ext/hand_interaction_ext", "Hand", kHands, kExtHandInteractionExt, "XR_EXT_hand_interaction"},
    {"/interaction_profiles/microsoft/hand_interaction", "Hand", kHands, kMicrosoftHandInteraction, "XR_MSFT_hand_interaction"},
    {"/interaction_profiles/htc/vive_pro", "Vive Pro headset", kUserHead, kHtcVivePro},
    {"/interaction_profiles/microsoft/xbox_controller", "Xbox controller", kUserGamepad, kMicrosoftXboxController},
    {"/interaction_profiles/ext/eye_gaze_interaction", "Eye tracker", kUserEyesExt, kExtEyeGazeInteraction, "XR_EXT_eye_gaze_interaction"},
};

}  // namespace simulated
