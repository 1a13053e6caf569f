// Which paths each interaction profile has, as the registry (xr.xml) lists them. Vectors such as /input/thumbstick stand there as their
// parts.
#pragma once

#include "xr/simulated/api/profiles.h"

namespace simulated {

inline constexpr std::string_view kHands[] = {"/user/hand/left", "/user/hand/right"};
inline constexpr std::string_view kHeadPaths[] = {"/user/head"};
inline constexpr std::string_view kGamepadPaths[] = {"/user/gamepad"};
inline constexpr std::string_view kEyesPaths[] = {"/user/eyes_ext"};

inline constexpr std::string_view kGazeComponents[] = {"/input/gaze_ext/pose"};

inline constexpr std::string_view kSimple[] = {"/input/select/click", "/input/menu/click", "/input/grip/pose", "/input/aim/pose",
                                               "/output/haptic"};
inline constexpr std::string_view kDaydream[] = {"/input/select/click",   "/input/trackpad/x", "/input/trackpad/y", "/input/trackpad/click",
                                                 "/input/trackpad/touch", "/input/grip/pose",  "/input/aim/pose"};
inline constexpr std::string_view kVive[] = {"/input/system/click",   "/input/squeeze/click", "/input/menu/click", "/input/trigger/click",
                                             "/input/trigger/value",  "/input/trackpad/x",    "/input/trackpad/y", "/input/trackpad/click",
                                             "/input/trackpad/touch", "/input/grip/pose",     "/input/aim/pose",   "/output/haptic"};
inline constexpr std::string_view kVivePro[] = {"/input/system/click", "/input/volume_up/click", "/input/volume_down/click",
                                                "/input/mute_mic/click"};
inline constexpr std::string_view kMotion[] = {
    "/input/menu/click",       "/input/squeeze/click", "/input/trigger/value", "/input/thumbstick/x",   "/input/thumbstick/y",
    "/input/thumbstick/click", "/input/trackpad/x",    "/input/trackpad/y",    "/input/trackpad/click", "/input/trackpad/touch",
    "/input/grip/pose",        "/input/aim/pose",      "/output/haptic"};
inline constexpr std::string_view kXbox[] = {"/input/menu/click",
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
inline constexpr std::string_view kGo[] = {"/input/system/click",   "/input/trigger/click", "/input/back/click",
                                           "/input/trackpad/x",     "/input/trackpad/y",    "/input/trackpad/click",
                                           "/input/trackpad/touch", "/input/grip/pose",     "/input/aim/pose"};
inline constexpr std::string_view kTouch[] = {"/input/squeeze/value",    "/input/trigger/value",   "/input/trigger/touch",
                                              "/input/thumbstick/x",     "/input/thumbstick/y",    "/input/thumbstick/click",
                                              "/input/thumbstick/touch", "/input/thumbrest/touch", "/input/grip/pose",
                                              "/input/aim/pose",         "/output/haptic"};
inline constexpr std::string_view kTouchLeft[] = {"/input/x/click", "/input/x/touch", "/input/y/click", "/input/y/touch",
                                                  "/input/menu/click"};
inline constexpr std::string_view kTouchRight[] = {"/input/a/click", "/input/a/touch", "/input/b/click", "/input/b/touch",
                                                   "/input/system/click"};
inline constexpr std::string_view kIndex[] = {
    "/input/system/click",  "/input/system/touch",  "/input/a/click",        "/input/a/touch",          "/input/b/click",
    "/input/b/touch",       "/input/squeeze/value", "/input/squeeze/force",  "/input/trigger/click",    "/input/trigger/value",
    "/input/trigger/touch", "/input/thumbstick/x",  "/input/thumbstick/y",   "/input/thumbstick/click", "/input/thumbstick/touch",
    "/input/trackpad/x",    "/input/trackpad/y",    "/input/trackpad/force", "/input/trackpad/touch",   "/input/grip/pose",
    "/input/aim/pose",      "/output/haptic"};

// Of 1.1, before it of extensions.
inline constexpr std::string_view kCosmos[] = {"/input/shoulder/click",   "/input/squeeze/click",    "/input/trigger/click",
                                               "/input/trigger/value",    "/input/thumbstick/x",     "/input/thumbstick/y",
                                               "/input/thumbstick/click", "/input/thumbstick/touch", "/input/thumbrest/touch",
                                               "/input/grip/pose",        "/input/aim/pose",         "/output/haptic"};
inline constexpr std::string_view kCosmosLeft[] = {"/input/x/click", "/input/y/click", "/input/menu/click"};
inline constexpr std::string_view kCosmosRight[] = {"/input/a/click", "/input/b/click", "/input/system/click"};
inline constexpr std::string_view kFocus3[] = {
    "/input/squeeze/click",   "/input/squeeze/touch", "/input/squeeze/value", "/input/trigger/click",    "/input/trigger/touch",
    "/input/trigger/value",   "/input/thumbstick/x",  "/input/thumbstick/y",  "/input/thumbstick/click", "/input/thumbstick/touch",
    "/input/thumbrest/touch", "/input/grip/pose",     "/input/aim/pose",      "/output/haptic"};
inline constexpr std::string_view kHp[] = {"/input/menu/click",   "/input/squeeze/value", "/input/trigger/value",
                                           "/input/thumbstick/x", "/input/thumbstick/y",  "/input/thumbstick/click",
                                           "/input/grip/pose",    "/input/aim/pose",      "/output/haptic"};
inline constexpr std::string_view kHpLeft[] = {"/input/x/click", "/input/y/click"};
inline constexpr std::string_view kHpRight[] = {"/input/a/click", "/input/b/click"};
inline constexpr std::string_view kMagicLeap[] = {
    "/input/menu/click", "/input/home/click",     "/input/trigger/click",  "/input/trigger/value",  "/input/trackpad/x",
    "/input/trackpad/y", "/input/trackpad/click", "/input/trackpad/force", "/input/trackpad/touch", "/input/grip/pose",
    "/input/aim/pose",   "/input/shoulder/click", "/output/haptic"};
inline constexpr std::string_view kTouchCv1[] = {"/input/squeeze/value",
                                                 "/input/trigger/value",
                                                 "/input/trigger/touch",
                                                 "/input/trigger/proximity",
                                                 "/input/thumb_resting_surfaces/proximity",
                                                 "/input/thumbstick/x",
                                                 "/input/thumbstick/y",
                                                 "/input/thumbstick/click",
                                                 "/input/thumbstick/touch",
                                                 "/input/thumbrest/touch",
                                                 "/input/grip/pose",
                                                 "/input/aim/pose",
                                                 "/output/haptic"};
inline constexpr std::string_view kTouchQuest1[] = {"/input/squeeze/value",
                                                    "/input/trigger/value",
                                                    "/input/trigger/touch",
                                                    "/input/trigger/proximity",
                                                    "/input/thumb_resting_surfaces/proximity",
                                                    "/input/thumbstick/x",
                                                    "/input/thumbstick/y",
                                                    "/input/thumbstick/click",
                                                    "/input/thumbstick/touch",
                                                    "/input/grip/pose",
                                                    "/input/aim/pose",
                                                    "/output/haptic"};
inline constexpr std::string_view kTouchPlus[] = {"/input/squeeze/value",
                                                  "/input/trigger/value",
                                                  "/input/trigger/touch",
                                                  "/input/trigger/force",
                                                  "/input/trigger/proximity",
                                                  "/input/trigger_curl/value",
                                                  "/input/trigger_slide/value",
                                                  "/input/thumb_resting_surfaces/proximity",
                                                  "/input/thumbstick/x",
                                                  "/input/thumbstick/y",
                                                  "/input/thumbstick/click",
                                                  "/input/thumbstick/touch",
                                                  "/input/thumbrest/touch",
                                                  "/input/grip/pose",
                                                  "/input/aim/pose",
                                                  "/output/haptic"};
inline constexpr std::string_view kTouchPro[] = {"/input/squeeze/value",
                                                 "/input/trigger/value",
                                                 "/input/trigger/touch",
                                                 "/input/trigger/proximity",
                                                 "/input/trigger_curl/value",
                                                 "/input/trigger_slide/value",
                                                 "/input/thumb_resting_surfaces/proximity",
                                                 "/input/thumbstick/x",
                                                 "/input/thumbstick/y",
                                                 "/input/thumbstick/click",
                                                 "/input/thumbstick/touch",
                                                 "/input/thumbrest/touch",
                                                 "/input/thumbrest/force",
                                                 "/input/stylus/force",
                                                 "/input/grip/pose",
                                                 "/input/aim/pose",
                                                 "/output/haptic",
                                                 "/output/haptic_trigger",
                                                 "/output/haptic_thumb"};
inline constexpr std::string_view kPicoNeo3[] = {
    "/input/system/click",     "/input/menu/click",    "/input/squeeze/click", "/input/squeeze/value", "/input/trigger/click",
    "/input/trigger/touch",    "/input/trigger/value", "/input/thumbstick/x",  "/input/thumbstick/y",  "/input/thumbstick/click",
    "/input/thumbstick/touch", "/input/grip/pose",     "/input/aim/pose",      "/output/haptic"};
inline constexpr std::string_view kPico4[] = {
    "/input/system/click",  "/input/squeeze/click", "/input/squeeze/value", "/input/trigger/click",    "/input/trigger/touch",
    "/input/trigger/value", "/input/thumbstick/x",  "/input/thumbstick/y",  "/input/thumbstick/click", "/input/thumbstick/touch",
    "/input/grip/pose",     "/input/aim/pose",      "/output/haptic"};
inline constexpr std::string_view kPicoLeft[] = {"/input/x/click", "/input/x/touch", "/input/y/click", "/input/y/touch"};
inline constexpr std::string_view kPicoRight[] = {"/input/a/click", "/input/a/touch", "/input/b/click", "/input/b/touch"};
inline constexpr std::string_view kPicoG3[] = {"/input/trigger/click", "/input/trigger/value",   "/input/menu/click",
                                               "/input/grip/pose",     "/input/aim/pose",        "/input/thumbstick/x",
                                               "/input/thumbstick/y",  "/input/thumbstick/click"};

// Of extensions alone, which 1.1 took up under other names.
inline constexpr std::string_view kFbTouchPro[] = {"/input/squeeze/value",
                                                   "/input/trigger/value",
                                                   "/input/trigger/touch",
                                                   "/input/trigger/proximity_fb",
                                                   "/input/trigger/curl_fb",
                                                   "/input/trigger/slide_fb",
                                                   "/input/thumb_fb/proximity_fb",
                                                   "/input/thumbstick/x",
                                                   "/input/thumbstick/y",
                                                   "/input/thumbstick/click",
                                                   "/input/thumbstick/touch",
                                                   "/input/thumbrest/touch",
                                                   "/input/thumbrest/force",
                                                   "/input/stylus_fb/force",
                                                   "/input/grip/pose",
                                                   "/input/aim/pose",
                                                   "/output/haptic",
                                                   "/output/haptic_trigger_fb",
                                                   "/output/haptic_thumb_fb"};
inline constexpr std::string_view kMetaTouchPlus[] = {
    "/input/squeeze/value",          "/input/trigger/value",     "/input/trigger/touch",      "/input/trigger/force",
    "/input/trigger/proximity_meta", "/input/trigger/curl_meta", "/input/trigger/slide_meta", "/input/thumb_meta/proximity_meta",
    "/input/thumbstick/x",           "/input/thumbstick/y",      "/input/thumbstick/click",   "/input/thumbstick/touch",
    "/input/thumbrest/touch",        "/input/grip/pose",         "/input/aim/pose",           "/output/haptic"};
// Bare hands.
inline constexpr std::string_view kExtHands[] = {
    "/input/aim/pose",        "/input/grip/pose",           "/input/pinch_ext/pose",         "/input/poke_ext/pose",
    "/input/pinch_ext/value", "/input/pinch_ext/ready_ext", "/input/aim_activate_ext/value", "/input/aim_activate_ext/ready_ext",
    "/input/grasp_ext/value", "/input/grasp_ext/ready_ext"};
inline constexpr std::string_view kMsftHands[] = {"/input/select/value", "/input/squeeze/value", "/input/aim/pose", "/input/grip/pose"};

inline constexpr Profile kProfiles[] = {
    {"/interaction_profiles/oculus/touch_controller", "Touch controller", kHands, kTouch, kTouchLeft, kTouchRight},
    {"/interaction_profiles/valve/index_controller", "Index controller", kHands, kIndex, {}, {}},
    {"/interaction_profiles/microsoft/motion_controller", "Motion controller", kHands, kMotion, {}, {}},
    {"/interaction_profiles/htc/vive_controller", "Vive controller", kHands, kVive, {}, {}},
    {"/interaction_profiles/khr/simple_controller", "Simple controller", kHands, kSimple, {}, {}},
    {"/interaction_profiles/oculus/go_controller", "Go controller", kHands, kGo, {}, {}},
    {"/interaction_profiles/google/daydream_controller", "Daydream controller", kHands, kDaydream, {}, {}},
    {"/interaction_profiles/meta/touch_plus_controller",
     "Touch Plus controller",
     kHands,
     kTouchPlus,
     kTouchLeft,
     kTouchRight,
     Since::k1_1,
     {}},
    {"/interaction_profiles/meta/touch_pro_controller",
     "Touch Pro controller",
     kHands,
     kTouchPro,
     kTouchLeft,
     kTouchRight,
     Since::k1_1,
     {}},
    {"/interaction_profiles/meta/touch_controller_quest_2",
     "Quest 2 controller",
     kHands,
     kTouchCv1,
     kTouchLeft,
     kTouchRight,
     Since::k1_1,
     {}},
    {"/interaction_profiles/meta/touch_controller_quest_1_rift_s",
     "Quest 1 and Rift S controller",
     kHands,
     kTouchQuest1,
     kTouchLeft,
     kTouchRight,
     Since::k1_1,
     {}},
    {"/interaction_profiles/meta/touch_controller_rift_cv1",
     "Rift CV1 controller",
     kHands,
     kTouchCv1,
     kTouchLeft,
     kTouchRight,
     Since::k1_1,
     {}},
    {"/interaction_profiles/bytedance/pico4_controller", "PICO 4 controller", kHands, kPico4, kTouchLeft, kPicoRight, Since::k1_1,
     "XR_BD_controller_interaction"},
    {"/interaction_profiles/bytedance/pico_neo3_controller", "PICO Neo3 controller", kHands, kPicoNeo3, kPicoLeft, kPicoRight, Since::k1_1,
     "XR_BD_controller_interaction"},
    {"/interaction_profiles/bytedance/pico_g3_controller",
     "PICO G3 controller",
     kHands,
     kPicoG3,
     {},
     {},
     Since::k1_1,
     "XR_BD_controller_interaction"},
    {"/interaction_profiles/htc/vive_cosmos_controller", "Vive Cosmos controller", kHands, kCosmos, kCosmosLeft, kCosmosRight, Since::k1_1,
     "XR_HTC_vive_cosmos_controller_interaction"},
    {"/interaction_profiles/htc/vive_focus3_controller", "Vive Focus 3 controller", kHands, kFocus3, kCosmosLeft, kCosmosRight, Since::k1_1,
     "XR_HTC_vive_focus3_controller_interaction"},
    {"/interaction_profiles/hp/mixed_reality_controller", "HP controller", kHands, kHp, kHpLeft, kHpRight, Since::k1_1,
     "XR_EXT_hp_mixed_reality_controller"},
    {"/interaction_profiles/samsung/odyssey_controller",
     "Odyssey controller",
     kHands,
     kMotion,
     {},
     {},
     Since::k1_1,
     "XR_EXT_samsung_odyssey_controller"},
    {"/interaction_profiles/ml/ml2_controller",
     "Magic Leap 2 controller",
     kHands,
     kMagicLeap,
     {},
     {},
     Since::k1_1,
     "XR_ML_ml2_controller_interaction"},
    {"/interaction_profiles/facebook/touch_controller_pro", "Touch Pro controller", kHands, kFbTouchPro, kTouchLeft, kTouchRight,
     Since::kNone, "XR_FB_touch_controller_pro"},
    {"/interaction_profiles/meta/touch_controller_plus", "Touch Plus controller", kHands, kMetaTouchPlus, kTouchLeft, kTouchRight,
     Since::kNone, "XR_META_touch_controller_plus"},
    {"/interaction_profiles/ext/hand_interaction_ext", "Hand", kHands, kExtHands, {}, {}, Since::kNone, "XR_EXT_hand_interaction"},
    {"/interaction_profiles/microsoft/hand_interaction", "Hand", kHands, kMsftHands, {}, {}, Since::kNone, "XR_MSFT_hand_interaction"},
    {"/interaction_profiles/htc/vive_pro", "Vive Pro headset", kHeadPaths, kVivePro, {}, {}},
    {"/interaction_profiles/microsoft/xbox_controller", "Xbox controller", kGamepadPaths, kXbox, {}, {}},
    {"/interaction_profiles/ext/eye_gaze_interaction",
     "Eye tracker",
     kEyesPaths,
     kGazeComponents,
     {},
     {},
     Since::kNone,
     "XR_EXT_eye_gaze_interaction"},
};

}  // namespace simulated
