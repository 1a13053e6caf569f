// binosplat in a program's own Vulkan: its device, its images, its command buffers. Start with binosplat.h.
//
// The program creates the device, with the features that bsp_required_device_features sets. A renderer's
// frames can then be parts of the program's own command buffers:
//
//     bsp_prepare(renderer, &frame);                        // once, while no picture is due: this waits
//     each frame:
//         bsp_record(renderer, &frame, commands, &number);  // waits for nothing
//         vkQueueSubmit(... commands ..., fence);
//         later, once an earlier frame's fence is signalled: bsp_collect(renderer, its_number, &result);
//
// bsp_record, bsp_submit and bsp_collect do not wait for the device. Lists of splats therefore have the
// capacity that collected frames needed, and some to spare. After a jump of the eyes a frame may lack
// capacity, and shows background there (bsp_frame_result::frames_cut_short) until it has been collected.
// bsp_prepare, which waits, provides the capacity beforehand.
#ifndef BINOSPLAT_VULKAN_H
#define BINOSPLAT_VULKAN_H

#include <vulkan/vulkan_core.h>
#include "binosplat.h"

#ifdef __cplusplus
extern "C" {
#endif

// Sets the features that the device must be created with, and leaves the others: bufferDeviceAddress and
// scalarBlockLayout. The instance must have Vulkan 1.2 or later, and the queue's family must support compute.
// Any thread.
BSP_API void bsp_required_device_features(VkPhysicalDeviceVulkan12Features* features);
// The number and names of device extensions that must be enabled: none. These are used if they are enabled:
// VK_EXT_subgroup_size_control with subgroupSizeControl and computeFullSubgroups, and
// VK_KHR_shader_subgroup_uniform_control_flow with its feature. Any thread.
BSP_API uint32_t bsp_required_device_extensions(const char* const** names);

// For bsp_device_info::next: a device of the program, which must outlive the library's. `name` and
// `validation` then have no effect. bsp_device_create names what the device lacks.
typedef struct bsp_vulkan_device {
    uint32_t type, size;  // BSP_TYPE_VULKAN_DEVICE
    const void* next;
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    // Scenes are uploaded on it by their own threads, and bsp_render, bsp_prepare and bsp_submit use it.
    VkQueue queue;
    const void* enabled_features;  // the chain that was VkDeviceCreateInfo::pNext
    const char* const* enabled_extensions;
    uint32_t enabled_extension_count;
    // Called around each use of the queue, as Vulkan requires of threads that share one; null if no other
    // thread uses it meanwhile.
    void (*lock_queue)(void* user);
    void (*unlock_queue)(void* user);
    void* queue_user;
} bsp_vulkan_device;

typedef enum bsp_target_flags {
    // The picture is blended over what is in the image; the frame's background must be 0.
    BSP_TARGET_BLEND = 1,
    // An image without sRGB in its format holds linear light, as in OpenXR, not display-encoded values.
    BSP_TARGET_LIGHT = 2,
    // With BLEND: `depth` has the depths of the program's meshes, which hide splats behind them. A single
    // view, and the views of modes that render both eyes in full (two-pass, shared), test each splat as they
    // blend it. Other modes reproject pictures that do not contain the meshes: there one depth stands for all
    // splats of a pixel, the mean of what it shows.
    BSP_TARGET_DEPTH_TEST = 4,
    BSP_TARGET_DEPTH_BY_PIXEL = 8  // with DEPTH_TEST: one depth per pixel in any mode
} bsp_target_flags;

// For bsp_view::next: where a view's picture goes.
typedef struct bsp_target {
    uint32_t type, size;  // BSP_TYPE_TARGET
    const void* next;
    // An image of the view's size with one sample, with VK_IMAGE_USAGE_TRANSFER_DST_BIT, and also
    // TRANSFER_SRC if it is to be blended over. Formats: R8G8B8A8 and B8G8R8A8, each _SRGB or _UNORM; without
    // BLEND also R32G32B32A32_SFLOAT, and with BSP_FRAME_HALF_FLOATS R16G16B16A16_SFLOAT.
    VkImage colour;
    VkFormat colour_format;
    uint32_t layer;                             // array layer of both images
    VkImageLayout colour_before, colour_after;  // before: anything unless with BLEND; after: not UNDEFINED
    // Null, or of VK_FORMAT_D32_SFLOAT, with the same usages. depth_scale / z + depth_offset is written and
    // tested, with z along the camera's axis; depth_offset where there is nothing. For near plane n and far
    // plane f: reversed: n f / (f - n) and -n / (f - n), or n and 0 if f is infinite; otherwise: -n f / (f -
    // n) and f / (f - n).
    VkImage depth;
    VkImageLayout depth_before, depth_after;  // as with colour; `before` matters with DEPTH_TEST
    float depth_scale, depth_offset;
    uint32_t flags;  // of bsp_target_flags
} bsp_target;

// Renders such frames to size their lists, pictures and kernels, and waits: some hundred milliseconds, or
// seconds if the driver has never compiled the kernels. Call it before the first frame, and whenever waiting
// does no harm and the scene, the sizes or the mode change. Everything recorded so far must have been
// submitted.
BSP_API bsp_result bsp_prepare(bsp_renderer renderer, const bsp_frame_info* frame);

// Records the frame into a primary command buffer of the queue's family, outside of render passes; what was
// bound there is undefined afterwards. On the device it waits for all commands before it, and all commands
// after it wait for it. Submit the buffer once, to the device's queue, with a renderer's frames in the order
// of their recording. Every view has a bsp_target. If it fails, nothing is recorded. `number` identifies the
// frame for bsp_collect; at most 8 frames may be uncollected.
BSP_API bsp_result bsp_record(bsp_renderer renderer, const bsp_frame_info* frame, VkCommandBuffer commands,
                              uint64_t* number);

typedef struct bsp_submit_info {
    uint32_t type, size;  // BSP_TYPE_SUBMIT_INFO
    const void* next;
    // Null, or a semaphore that is waited for before anything else, and one that is signalled after
    // everything; the values are for timeline semaphores, 0 for others.
    VkSemaphore wait, signal;
    uint64_t wait_value, signal_value;
} bsp_submit_info;

// The same in a command buffer of the library's own, which the library submits.
BSP_API bsp_result bsp_submit(bsp_renderer renderer, const bsp_frame_info* frame, const bsp_submit_info* info,
                              uint64_t* number);

// Takes a frame back, and says how it went; `result` may be null. After bsp_record, the caller must know by a
// fence or semaphore of its own that the device has finished it. After bsp_submit, returns BSP_NOT_READY if
// the device has not. Once for each frame; after an error the frame counts as taken back.
BSP_API bsp_result bsp_collect(bsp_renderer renderer, uint64_t number, bsp_frame_result* result);
// Call this instead for a recorded frame whose command buffer is never submitted.
BSP_API bsp_result bsp_discard(bsp_renderer renderer, uint64_t number);

#ifdef __cplusplus
}
#endif

#endif
