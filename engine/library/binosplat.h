// binosplat as a library: Gaussian splat scenes, drawn for one to four eyes on a Vulkan device. This header
// is all of it, except for a program's own Vulkan objects (binosplat_vulkan.h), and needs only the standard C
// headers. binosplat.hpp wraps it in C++ classes, binosplat.py in Python ones. docs/library.md begins with
// ten lines that make a picture.
//
// Lengths are in the scene's units, angles in radians. Camera axes are OpenCV's: x right, y down, z forward.
// Quaternions are w, x, y, z.
//
// Structures begin with their type and their size, as the program's compiler sees it. Set all other fields to
// 0 unless you use them; 0 always means the default. A program that was compiled against an earlier header
// therefore runs with a later library. In an array of structures, the elements are `size` of the first one
// apart.
//
// Errors: a function returns BSP_SUCCESS or a code; bsp_error_text() then says in one line what is wrong,
// where, and what was expected. A call that fails leaves its objects as they were, and the next call works,
// unless the code is BSP_ERROR_DEVICE_LOST. The library throws nothing, and writes nothing to the program's
// output.
//
// Threads: calls that are given different objects may run at the same time, and others as far as their
// comments say. A call that is given an object indirectly, such as a scene in a frame, counts as being given
// both.
#ifndef BINOSPLAT_H
#define BINOSPLAT_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && !defined(_WIN32)
#define BSP_API __attribute__((visibility("default")))
#else
#define BSP_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bsp_device_t* bsp_device;  // a Vulkan device: the library's own, or the program's
typedef struct bsp_scene_t* bsp_scene;    // splats in its memory
// Makes pictures, and keeps what the previous ones leave for the next.
typedef struct bsp_renderer_t* bsp_renderer;

typedef enum bsp_result {
    BSP_SUCCESS = 0,
    // A scene is loading, or the device is drawing. This is not an error, and has no text.
    BSP_NOT_READY = 1,
    BSP_ERROR_INPUT = -1,          // a file or a value
    BSP_ERROR_OUT_OF_MEMORY = -2,  // of the device or the host: a smaller scene or picture may fit
    BSP_ERROR_NO_DEVICE = -3,      // no Vulkan device, or none with what is needed
    BSP_ERROR_DEVICE_LOST = -4,    // its objects can only be destroyed now
    BSP_ERROR_CANCELLED = -5       // see bsp_scene_cancel
} bsp_result;

// A line about this thread's last call that failed, until the next one fails; "" if none has.
BSP_API const char* bsp_error_text(void);
// "0.1.0".
BSP_API const char* bsp_version(void);

typedef enum bsp_type {
    BSP_TYPE_DEVICE_INFO = 1,
    BSP_TYPE_SPLATS = 2,
    BSP_TYPE_SCENE_INFO = 3,
    BSP_TYPE_SCENE_PROPERTIES = 4,
    BSP_TYPE_VIEW = 5,
    BSP_TYPE_FRAME_INFO = 6,
    BSP_TYPE_FRAME_RESULT = 7,
    // binosplat_vulkan.h
    BSP_TYPE_VULKAN_DEVICE = 8,
    BSP_TYPE_TARGET = 9,
    BSP_TYPE_SUBMIT_INFO = 10,
    // binosplat.h
    BSP_TYPE_INSTANCE = 11
} bsp_type;

// The beginning of every structure. `next`: another structure with more fields, if a comment names one;
// otherwise null.
typedef struct bsp_header {
    uint32_t type, size;
    const void* next;
} bsp_header;

// Devices. --------------------------------------------------------------------------------------------------

// One line for the user, such as: splats were skipped and why, or a copy of a scene from the web may be old.
// Any thread may call it in the middle of any call, and it must not call this library.
typedef void (*bsp_log)(void* user, const char* line);

typedef struct bsp_device_info {
    uint32_t type, size;  // BSP_TYPE_DEVICE_INFO
    const void* next;
    // The device's number, or part of its name; null: the first discrete GPU, or else the first usable
    // device.
    const char* name;
    bsp_log log;                  // null: no messages
    void* log_user;               // passed to `log`
    uint64_t memory_limit_bytes;  // the most for all buffers together; 0: what the device has
    // 1: use Khronos' validation layers; their messages are logged when the device is destroyed.
    uint32_t validation;
} bsp_device_info;

// `info` may be null.
BSP_API bsp_result bsp_device_create(const bsp_device_info* info, bsp_device* device);
// Null is allowed. Destroy its scenes and renderers first.
BSP_API void bsp_device_destroy(bsp_device device);
// The device's name, valid while the device exists. May run at the same time as any call.
BSP_API const char* bsp_device_name(bsp_device device);

// Scenes. ---------------------------------------------------------------------------------------------------

// The floats of each splat are adjacent; splats are `stride` bytes apart, or packed if it is 0.
typedef struct bsp_array {
    const float* values;
    uint64_t stride;
} bsp_array;

typedef struct bsp_splats {
    uint32_t type, size;  // BSP_TYPE_SPLATS
    const void* next;
    uint64_t count;
    bsp_array positions;  // 3: the centre
    bsp_array rotations;  // 4: w, x, y, z, of any length except 0
    bsp_array scales;     // scale_count: along the rotated axes
    bsp_array opacities;  // 1
    // 3 (sh_degree + 1)^2: by coefficients, the constant one first, with red, green and blue of each together
    bsp_array sh;
    uint32_t scale_count;  // 2: discs (2DGS); 3: Gaussians (3DGS)
    uint32_t sh_degree;    // 0 to 3
    // 0: as training stores them, logarithms of scales and logits of opacities; 1: lengths, and opacities
    // from 0 to 1
    uint32_t activated;
    uint32_t antialiased;  // 1: Gaussians whose opacities were trained to be dimmed by the low-pass
    double origin[3];      // positions are relative to it; for positions far from 0
} bsp_splats;

typedef struct bsp_scene_info {
    uint32_t type, size;  // BSP_TYPE_SCENE_INFO
    const void* next;
    // A file of any format that the README lists, a folder, builtin:NAME, or a web address; null: `splats`.
    const char* source;
    const bsp_splats* splats;  // null: `source`
    // 1: a streamed scene loads what the views need, frame by frame, and a folder of numbered files moves,
    // see bsp_frame_info::time_s. Such a scene belongs to one renderer at a time. 0: all of it is loaded, or
    // the first file.
    uint32_t live;
    uint32_t unused;
    // For a streamed scene: the most splats to show; 0: as many as half of the memory holds.
    uint64_t splat_budget;
    double rate_hz;  // of a scene that moves: files per second; 0: 30
} bsp_scene_info;

// Starts loading in the background, and returns at once. Arrays are read before it returns. May run beside
// any call with the same device. A program's own device lends its queue (binosplat_vulkan.h).
BSP_API bsp_result bsp_scene_create(bsp_device device, const bsp_scene_info* info, bsp_scene* scene);
// BSP_SUCCESS once the scene is loaded, BSP_NOT_READY while it loads, or the reason why it never will be.
// `progress`, 0 to 1, may be null. Like the next two, it may run beside any call with the same scene except
// its destruction.
BSP_API bsp_result bsp_scene_state(bsp_scene scene, double* progress);
// Waits until loading has ended, and returns the same.
BSP_API bsp_result bsp_scene_wait(bsp_scene scene);
// Loading stops soon; the scene's state is then BSP_ERROR_CANCELLED.
BSP_API void bsp_scene_cancel(bsp_scene scene);
// Null is allowed. Cancels, and waits for that. Renderers that were showing it show nothing afterwards; no
// call may use them meanwhile.
BSP_API void bsp_scene_destroy(bsp_scene scene);

typedef struct bsp_scene_properties {
    uint32_t type, size;  // BSP_TYPE_SCENE_PROPERTIES
    void* next;
    // skipped: with a NaN, an infinity, or a rotation of length 0. From here on a live scene counts with its
    // coarsest level or first file
    uint64_t splats, skipped;
    uint64_t device_bytes;   // memory that it takes on the device
    uint32_t scale_count;    // 2 or 3, as bsp_splats
    uint32_t sh_degree;      // the highest degree with a coefficient that is not 0
    double low[3], high[3];  // the box of all centres
    // The longest side of the box with nine tenths of the scene, without its surroundings.
    double core_size;
    double near;             // the nearest depth that is drawn unless a frame sets it
    double eye[3], look[3];  // where to start, judged from the scene, and what to look at
    double up[3];            // a vector that points upwards
} bsp_scene_properties;

// Of a loaded scene. May run beside any call with the same scene except its destruction.
BSP_API bsp_result bsp_scene_get_properties(bsp_scene scene, bsp_scene_properties* properties);

// Frames. ---------------------------------------------------------------------------------------------------

// An eye: where it is and what it sees.
typedef struct bsp_view {
    uint32_t type, size;    // BSP_TYPE_VIEW
    const void* next;       // bsp_target, for pictures in a program's own images
    double orientation[4];  // world from camera, a quaternion
    double position[3];     // in the coordinates of the scene's file
    // Signed angles from the axis, as OpenXR's: usually left and down are negative.
    double left_rad, right_rad, up_rad, down_rad;
    uint32_t width, height;  // pixels, 1 to 16384
    // For foveation: where the eye looks, in its own axes, of any length; 0: straight ahead.
    double gaze[3];
} bsp_view;

// Sets everything but the headers of `count` views, 1 or 2, with square pixels: from `eye` to `look`, with
// `up` pointing upwards. Two views are `eye_distance` apart.
BSP_API bsp_result bsp_look_at(const double eye[3], const double look[3], const double up[3],
                               double eye_distance, double fov_x_rad, uint32_t width, uint32_t height,
                               uint32_t count, bsp_view* views);

// How the pictures of two eyes are made; docs/how-it-works.md explains each mode.
typedef enum bsp_mode {
    BSP_MODE_USUAL = 0,     // predicted
    BSP_MODE_TWO_PASS = 1,  // both eyes in full, one after the other
    BSP_MODE_SHARED = 2,    // both eyes in full, culled and sorted together: the same pictures in less time
    // The second eye reprojected from the first, its borders rendered again (Zhu and Zhou).
    BSP_MODE_PAPER = 3,
    // As BSP_MODE_PAPER, and also renders again the tiles with the greatest expected error, up to the budget.
    BSP_MODE_PREDICTED = 4,
    // Both eyes reprojected from the frame before, and such tiles of both rendered again; the first frame in
    // full.
    BSP_MODE_TEMPORAL = 5
} bsp_mode;

typedef enum bsp_frame_flags {
    BSP_FRAME_HALF_FLOATS = 1,  // pictures of 11 bits a value, for display: half the memory, and less time
    BSP_FRAME_DEPTH = 2,        // depths are kept, for bsp_read_depth
    BSP_FRAME_CUT = 4,          // the history is of no use: the head jumped, or the scene changed
    // For bsp_render and bsp_prepare: wait for everything that the views need of live scenes.
    BSP_FRAME_SETTLED = 8
} bsp_frame_flags;

// A scene placed among others: p in the frame = scale * (orientation p) + position, with p in the coordinates
// of its file.
typedef struct bsp_instance {
    uint32_t type, size;  // BSP_TYPE_INSTANCE
    const void* next;
    bsp_scene scene;        // a loaded one; several instances may share it
    double orientation[4];  // a quaternion; all 0: as in the file
    double position[3];
    double scale;     // 0: 1
    uint32_t hidden;  // 1: not shown
} bsp_instance;

typedef struct bsp_frame_info {
    uint32_t type, size;  // BSP_TYPE_FRAME_INFO
    const void* next;
    bsp_scene scene;  // a loaded one; null: none, or `instances`
    // The first two are a pair of eyes, left and right, of the same size; so are the third and fourth.
    const bsp_view* views;
    uint32_t view_count;  // 1 to 4; an odd one at the end is drawn by itself, in full
    bsp_mode mode;
    uint32_t flags;  // of bsp_frame_flags
    // Share of an eye's work (predicted) or of both eyes' (temporal) for patching; 0: 0.2; less than 0: none.
    double budget;
    double near_depth;     // the nearest depth that is drawn; 0: the scene's
    double background[3];  // red, green, blue, display-encoded
    // Several scenes in place of `scene`, at most 4096: all discs, or all Gaussians trained alike. With a
    // `near_depth` of 0 the least of theirs counts. An instance that comes or goes makes a cut; one that
    // moves or is hidden does not.
    const bsp_instance* instances;
    uint32_t instance_count;
    uint32_t unused;
    // Within this angle of its gaze an eye sees everything; farther out, tiles may be coarse if it would not
    // see the difference; 0: no foveation.
    double foveation_rad;
    double time_s;  // which scenes that move are shown at, in their loop
    // temporal: tiles that are expected to be off by more than this PSNR in dB, such as 28, are rendered
    // first, within the budget, and what is better than that is left as it is; up to 60; 0: no bound, the
    // budget is spent
    double error_bound_db;
} bsp_frame_info;

BSP_API bsp_result bsp_renderer_create(bsp_device device, bsp_renderer* renderer);
// Null is allowed. Waits for what the library submitted; what the program submitted must be done.
BSP_API void bsp_renderer_destroy(bsp_renderer renderer);

typedef struct bsp_frame_result {
    uint32_t type, size;  // BSP_TYPE_FRAME_RESULT
    void* next;
    double gpu_ms;            // device time for the first two views; 0 if it has no timestamps
    uint64_t splats_visible;  // by one eye of the first two
    uint64_t tile_pairs;      // pairs of tile and splat that were blended for them
    // The share of the second eye's work (predicted) or of both eyes' (temporal) that was rendered.
    double work_rendered;
    // Number of frames so far whose lists were too short, so that some place showed background.
    uint64_t frames_cut_short;
    uint64_t peak_device_bytes;  // the most ever in use
    // The loaded share of what the views need of live scenes, for the scene that lacks most; 1: all of it.
    double share_there;
} bsp_frame_result;

// Renders and waits. `result` may be null. With BSP_MODE_TEMPORAL, call it frame after frame, with views that
// move little.
BSP_API bsp_result bsp_render(bsp_renderer renderer, const bsp_frame_info* frame, bsp_frame_result* result);
// A view of the last bsp_render: rows from top to bottom, four floats a pixel. Red, green and blue are
// display-encoded (sRGB, usually 0 to 1, not clamped), in front of the background; alpha is the share of the
// pixel that splats cover. `count`: how many floats `values` can hold, at least 4 width height.
BSP_API bsp_result bsp_read_colour(bsp_renderer renderer, uint32_t view, float* values, uint64_t count);
// Likewise, one float a pixel: how far along the camera's z axis its content lies, as the mean weighted by
// what each splat adds; 0 where there is nothing. For a view with BSP_FRAME_DEPTH.
BSP_API bsp_result bsp_read_depth(bsp_renderer renderer, uint32_t view, float* values, uint64_t count);

// Writes a picture with 8 bits a channel and no alpha to `path` plus the format's extension, as PNG (as PPM
// if the library was built without OpenImageIO and libpng). A failed write leaves no file. May run beside any
// call.
BSP_API bsp_result bsp_write_picture(const char* path, const float* rgba, uint32_t width, uint32_t height);

#ifdef __cplusplus
}
#endif

#endif
