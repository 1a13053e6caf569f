// binosplat in a program's own Vulkan: its device, its images, its command buffers. Begin with binosplat.h.
//
// The device is created by the program, with what bsp_required_device_features says; then a renderer's frames can be parts of the program's
// own command buffers:
//
//     bsp_prepare(renderer, &frame);                    once, while nobody waits for a picture: it does
//     each frame:
//         bsp_record(renderer, &frame, commands, &number);    waits for nothing
//         vkQueueSubmit(... commands ..., fence);
//         later, when the fence of an earlier frame is signalled:  bsp_collect(renderer, its_number, &result);
//
// Nothing waits for the device in bsp_record, bsp_submit and bsp_collect. So lists of splats have the size that collected frames needed,
// and some more: after a jump of the eyes a frame may find too little room, and shows background where it does
// (bsp_frame_result::frames_cut_short), until it is collected. bsp_prepare, which waits, makes room beforehand.
#ifndef BINOSPLAT_VULKAN_H
#define BINOSPLAT_VULKAN_H

#include <vulkan/vulkan_core.h>
#include "binosplat.h"

#ifdef __cplusplus
extern "C" {
#endif

// Sets the members that the device must be created with, and leaves the others: bufferDeviceAddress and scalarBlockLayout. The instance
// must be of Vulkan 1.2 or later, and the queue's family one that can compute. Any thread.
BSP_API void bsp_required_device_features(VkPhysicalDeviceVulkan12Features* features);
// How many extensions of the device must be enabled, and their names: none. These are used if they are enabled:
// VK_EXT_subgroup_size_control with subgroupSizeControl and computeFullSubgroups, VK_KHR_shader_subgroup_uniform_control_flow with its
// feature. Any thread.
BSP_API uint32_t bsp_required_device_extensions(const char* const** names);

// For bsp_device_info::next: a device of the program, which outlives the library's. `name` and `validation` are then without effect.
// bsp_device_create names what it lacks.
typedef struct bsp_vulkan_device {
    uint32_t type, size;  // BSP_TYPE_VULKAN_DEVICE
    const void* next;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;                 // scenes are uploaded on it, by their own threads, and bsp_render, bsp_prepare and bsp_submit use it
    const void* enabled_features;  // the chain that was VkDeviceCreateInfo::pNext
    const char* const* enabled_extensions;
    uint32_t enabled_extension_count;
    // Called around each use of the queue, as Vulkan wants it of whoever shares one; null if no other thread uses it meanwhile.
    void (*lock_queue)(void* user);
    void (*unlock_queue)(void* user);
    void* queue_user;
} bsp_vulkan_device;

typedef enum bsp_target_flags {
    BSP_TARGET_BLEND = 1,  // the picture is blended over what is in the image; the frame's background must be 0
    BSP_TARGET_LIGHT = 2,  // an image without sRGB in its format holds light, as OpenXR has it, not values as they are displayed
    // With BLEND: `depth` holds the depths of what is there, behind which splats do not show. A single view, and those of modes that render
    // both eyes in full (two-pass, shared), are tested splat by splat as they are blended. Other modes warp pictures that know of no mesh:
    // there one depth stands for all splats of a pixel, the mean of what it shows.
    BSP_TARGET_DEPTH_TEST = 4,
    BSP_TARGET_DEPTH_BY_PIXEL = 8  // with DEPTH_TEST: that, in any mode
} bsp_target_flags;

// For bsp_view::next: where the picture of a view goes.
typedef struct bsp_target {
    uint32_t type, size;  // BSP_TYPE_TARGET
    const void* next;
    // Of the view's size, of one sample, with VK_IMAGE_USAGE_TRANSFER_DST_BIT, to be blended over also TRANSFER_SRC. Formats: R8G8B8A8 and
    // B8G8R8A8, each _SRGB or _UNORM; without BLEND also R32G32B32A32_SFLOAT, and with BSP_FRAME_HALF_FLOATS R16G16B16A16_SFLOAT.
    VkImage colour;
    VkFormat colour_format;
    uint32_t layer;                             // of the array, of both images
    VkImageLayout colour_before, colour_after;  // before: with BLEND, else anything; after: not UNDEFINED
    // Null, or of VK_FORMAT_D32_SFLOAT, with the same usages. What is written, and tested, is depth_scale / z + depth_offset, with z along
    // the camera's axis; depth_offset where there is nothing. With the near plane n and the far one f: reversed: n f / (f - n) and
    // -n / (f - n), or n and 0 if f is infinite; otherwise: -n f / (f - n) and f / (f - n).
    VkImage depth;
    VkImageLayout depth_before, depth_after;  // as colour's, `before` with DEPTH_TEST
    float depth_scale, depth_offset;
    uint32_t flags;  // of bsp_target_flags
} bsp_target;

// Renders such frames for their lists, pictures and kernels, and waits: some hundred milliseconds, or seconds if the driver has never
// compiled the kernels. Before the first frame, and wherever waiting does no harm and the scene, the sizes or the mode change. All that was
// recorded must be submitted.
BSP_API bsp_result bsp_prepare(bsp_renderer renderer, const bsp_frame_info* frame);

// Records the frame into a primary command buffer of the queue's family, outside of render passes; what is bound there is undefined
// afterwards. All commands before it are waited for on the device, and all after it wait. The buffer must be submitted once, to the
// device's queue, and frames of a renderer in the order of their recording. Every view has a bsp_target. If it fails, nothing is recorded.
// `number`: of the frame, for bsp_collect; at most 8 may be uncollected.
BSP_API bsp_result bsp_record(bsp_renderer renderer, const bsp_frame_info* frame, VkCommandBuffer commands, uint64_t* number);

typedef struct bsp_submit_info {
    uint32_t type, size;  // BSP_TYPE_SUBMIT_INFO
    const void* next;
    // Null, or a semaphore that is waited for before anything, and one that is signalled after everything; the values are those of timeline
    // semaphores, 0 for the others.
    VkSemaphore wait, signal;
    uint64_t wait_value, signal_value;
} bsp_submit_info;

// The same in a command buffer of the library's own, which it submits.
BSP_API bsp_result bsp_submit(bsp_renderer renderer, const bsp_frame_info* frame, const bsp_submit_info* info, uint64_t* number);

// Takes a frame back, and says how it went; `result` may be null. Of bsp_record: the caller knows, by a fence or a semaphore of its own,
// that the device is done with it. Of bsp_submit: BSP_NOT_READY if it is not. Each frame once; after an error, it counts as taken back.
BSP_API bsp_result bsp_collect(bsp_renderer renderer, uint64_t number, bsp_frame_result* result);
// Instead, of a recorded frame whose command buffer is never submitted.
BSP_API bsp_result bsp_discard(bsp_renderer renderer, uint64_t number);

#ifdef __cplusplus
}
#endif

#endif
