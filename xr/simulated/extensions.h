// The extensions that this runtime offers, by name: instances enable them, scripts take them away.
#pragma once

#include <cstdint>

namespace simulated {

struct Extension {
    const char* name;
    std::uint32_t version;
};

inline constexpr Extension kExtensions[] = {
    {"XR_KHR_vulkan_enable2", 2},
    {"XR_KHR_vulkan_enable", 8},
    {"XR_KHR_composition_layer_depth", 5},
    {"XR_KHR_composition_layer_cylinder", 4},
    {"XR_KHR_composition_layer_equirect2", 1},
    {"XR_KHR_composition_layer_cube", 8},
    {"XR_KHR_visibility_mask", 2},
    {"XR_KHR_convert_timespec_time", 1},
    {"XR_EXT_conformance_automation", 3},
    {"XR_EXT_debug_utils", 4},
    {"XR_EXT_eye_gaze_interaction", 2},
    {"XR_EXT_hand_tracking", 4},
    {"XR_EXT_user_presence", 1},
    {"XR_FB_display_refresh_rate", 1},
    {"XR_FB_passthrough", 1},
    {"XR_MND_headless", 2},
    {"XR_VARJO_quad_views", 1},
    {"XR_VARJO_foveated_rendering", 3},
    // Part of 1.1; for instances of 1.0.
    {"XR_KHR_locate_spaces", 1},
    {"XR_KHR_maintenance1", 1},
    {"XR_EXT_local_floor", 1},
    {"XR_EXT_palm_pose", 3},
    {"XR_EXT_uuid", 1},
    {"XR_EXT_hp_mixed_reality_controller", 1},
    {"XR_EXT_samsung_odyssey_controller", 1},
    {"XR_BD_controller_interaction", 2},
    {"XR_HTC_vive_cosmos_controller_interaction", 1},
    {"XR_HTC_vive_focus3_controller_interaction", 2},
    {"XR_ML_ml2_controller_interaction", 1},
    {"XR_FB_touch_controller_pro", 1},
    {"XR_META_touch_controller_plus", 1},
    {"XR_EXT_hand_interaction", 1},
    {"XR_MSFT_hand_interaction", 1},
    {"XR_KHR_generic_controller", 1},
    {"XR_BD_ultra_controller_interaction", 1},
    {"XR_VARJO_xr4_controller_interaction", 2},
    {"XR_YVR_controller_interaction", 1},
    {"XR_OPPO_controller_interaction", 1},
    {"XR_HUAWEI_controller_interaction", 1},
    {"XR_LOGITECH_mx_ink_stylus_interaction", 1},
    {"XR_VALVE_frame_controller_interaction", 1},
};

}  // namespace simulated
