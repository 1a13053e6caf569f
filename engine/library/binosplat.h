// binosplat as a library: scenes of Gaussian splats, drawn for one to four eyes on a Vulkan device. This header is all of it but what
// concerns a program's own Vulkan objects (binosplat_vulkan.h), and needs only the standard C headers. binosplat.hpp has C++ classes over
// it, binosplat.py Python's. docs/library.md begins with ten lines that make a picture.
//
// Lengths are in the scene's units; angles in radians. Camera axes are OpenCV's: x right, y down, z forward. Quaternions are w, x, y, z.
//
// Structures begin with their type and their size, as the program's compiler sees it; all other fields are 0 unless they are set, and 0
// always means the usual. So a program that was compiled against an earlier header runs on a later library. Where a pointer to several
// structures is asked for, they lie `size` of the first one apart.
//
// Errors: a function returns BSP_SUCCESS or a code; bsp_error_text() then says in one line what is wrong, where, and what was expected.
// What fails leaves its objects as they were, and the next call works, unless the code is BSP_ERROR_DEVICE_LOST. Nothing is thrown, and
// nothing written to the program's output.
//
// Threads: any call may run beside any other one that is given other objects, and as far as a call's comment says. A call that is given an
// object through another one, as a scene by a frame, is given both.
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

typedef struct bsp_device_t* bsp_device;      // a Vulkan device: the library's own, or the program's
typedef struct bsp_scene_t* bsp_scene;        // splats in its memory
typedef struct bsp_renderer_t* bsp_renderer;  // pictures, and what the last ones leave for the next

typedef enum bsp_result {
    BSP_SUCCESS = 0,
    BSP_NOT_READY = 1,             // a scene still loads, or the device still draws: not an error, there is no text
    BSP_ERROR_INPUT = -1,          // a file or a value
    BSP_ERROR_OUT_OF_MEMORY = -2,  // of the device or the host: a smaller scene or picture may do
    BSP_ERROR_NO_DEVICE = -3,      // no Vulkan device, or none with what is needed
    BSP_ERROR_DEVICE_LOST = -4,    // its objects can only be destroyed any more
    BSP_ERROR_CANCELLED = -5       // see bsp_scene_cancel
} bsp_result;

// What the last call of this thread that failed has to say; "" if there was none. Until the next one fails.
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

// The beginning of every structure. `next`: another structure that says more, where a comment names one; else null.
typedef struct bsp_header {
    uint32_t type, size;
    const void* next;
} bsp_header;

// Devices. ----------------------------------------------------------------------------------------------------------------------------

// One line for the user: that splats were skipped and why, that a copy of a scene from the web may be old. It may be called by any thread
// in the middle of any call, and must call nothing of this library.
typedef void (*bsp_log)(void* user, const char* line);

typedef struct bsp_device_info {
    uint32_t type, size;  // BSP_TYPE_DEVICE_INFO
    const void* next;
    const char* name;  // the device's number, or a part of its name; null: the first discrete GPU, or else the first that will do
    bsp_log log;       // null: nobody is told
    void* log_user;    // passed to `log`
    uint64_t memory_limit_bytes;  // at most so many in all buffers together; 0: what the device has
    uint32_t validation;          // 1: under Khronos' validation layers; what they say is logged as the device is destroyed
} bsp_device_info;

// `info` may be null.
BSP_API bsp_result bsp_device_create(const bsp_device_info* info, bsp_device* device);
// Null is fine. Its scenes and renderers must be gone.
BSP_API void bsp_device_destroy(bsp_device device);
// Its name; as long as the device lives. Beside any call.
BSP_API const char* bsp_device_name(bsp_device device);

// Scenes. -----------------------------------------------------------------------------------------------------------------------------

// Floats of each splat, together; splats lie `stride` bytes apart, or side by side if it is 0.
typedef struct bsp_array {
    const float* values;
    uint64_t stride;
} bsp_array;

typedef struct bsp_splats {
    uint32_t type, size;  // BSP_TYPE_SPLATS
    const void* next;
    uint64_t count;
    bsp_array positions;   // 3: the centre
    bsp_array rotations;   // 4: w, x, y, z, of any length but 0
    bsp_array scales;      // scale_count: along the rotated axes
    bsp_array opacities;   // 1
    bsp_array sh;          // 3 (sh_degree + 1)^2: coefficient by coefficient, the constant one first, red, green and blue of each together
    uint32_t scale_count;  // 2: discs (2DGS); 3: Gaussians (3DGS)
    uint32_t sh_degree;    // 0 to 3
    uint32_t activated;    // 0: as trainings store them: logarithms of scales, logits of opacities; 1: lengths, and 0 to 1
    uint32_t antialiased;  // 1: Gaussians trained with opacities that the low-pass dims
    double origin[3];      // positions count from here, if they are far from 0
} bsp_splats;

typedef struct bsp_scene_info {
    uint32_t type, size;  // BSP_TYPE_SCENE_INFO
    const void* next;
    const char* source;  // a file of any format that the README lists, a folder, builtin:NAME, or an address on the web; null: `splats`
    const bsp_splats* splats;  // null: `source`
    // 1: a streamed scene brings what the views ask for, frame by frame, and a folder of numbered files moves, see bsp_frame_info::time_s.
    // Such a scene belongs to one renderer at a time. 0: all of it is loaded, or the first file.
    uint32_t live;
    uint32_t unused;
    uint64_t splat_budget;  // of a streamed scene: the most splats that are shown; 0: as many as half of the memory takes
    double rate_hz;         // of one that moves: files a second; 0: 30
} bsp_scene_info;

// Begins to load in the background, and returns at once. Arrays are read before it returns. Beside any call with the same device.
// If the device is a program's own, its queue is used (binosplat_vulkan.h).
BSP_API bsp_result bsp_scene_create(bsp_device device, const bsp_scene_info* info, bsp_scene* scene);
// BSP_SUCCESS once the scene is there, BSP_NOT_READY while it loads, or why it never will be. `progress`, 0 to 1, may be null. Beside any
// call with the same scene but its destruction, as the next two.
BSP_API bsp_result bsp_scene_state(bsp_scene scene, double* progress);
// The same once loading has ended: waits.
BSP_API bsp_result bsp_scene_wait(bsp_scene scene);
// A scene that still loads soon stops to; its state is BSP_ERROR_CANCELLED then.
BSP_API void bsp_scene_cancel(bsp_scene scene);
// Null is fine. Cancels, and waits for that. Renderers that showed it show nothing, so that no call may use them meanwhile.
BSP_API void bsp_scene_destroy(bsp_scene scene);

typedef struct bsp_scene_properties {
    uint32_t type, size;  // BSP_TYPE_SCENE_PROPERTIES
    void* next;
    uint64_t splats, skipped;  // skipped: with a NaN, an infinity, or a rotation of length 0. Of a live scene: of its coarsest level
                               // or first file, as all from here on
    uint64_t device_bytes;     // that it takes on the device
    uint32_t scale_count;      // 2 or 3, as bsp_splats
    uint32_t sh_degree;        // the highest with a coefficient that is not 0
    double low[3], high[3];    // the box of all centres
    double core_size;          // the longest side of the box that holds nine tenths of what one stands in or before
    double near;               // the nearest depth that is drawn unless it is given
    double eye[3], look[3];    // where to begin, judged from the scene, and what to look at
    double up[3];              // a vector that points up
} bsp_scene_properties;

// Of a scene that is there. Beside any call with the same scene but its destruction.
BSP_API bsp_result bsp_scene_get_properties(bsp_scene scene, bsp_scene_properties* properties);

// Frames. -----------------------------------------------------------------------------------------------------------------------------

// An eye: where it is and what it sees.
typedef struct bsp_view {
    uint32_t type, size;                           // BSP_TYPE_VIEW
    const void* next;                              // bsp_target, for pictures in a program's own images
    double orientation[4];                         // world from camera: a quaternion
    double position[3];                            // in the coordinates of the scene's file
    double left_rad, right_rad, up_rad, down_rad;  // signed angles from the axis, as OpenXR's: of a usual eye, left and down are negative
    uint32_t width, height;                        // pixels, 1 to 16384
    double gaze[3];                                // with foveation: where the eye looks, in its axes, of any length; 0: straight ahead
} bsp_view;

// Sets all but the headers of `count` views, 1 or 2, with square pixels: from `eye` to `look`, `up` points up; two are `eye_distance`
// apart.
BSP_API bsp_result bsp_look_at(const double eye[3], const double look[3], const double up[3], double eye_distance, double fov_x_rad,
                               uint32_t width, uint32_t height, uint32_t count, bsp_view* views);

// How the pictures of two eyes are made; docs/how-it-works.md says what each does.
typedef enum bsp_mode {
    BSP_MODE_USUAL = 0,      // predicted
    BSP_MODE_TWO_PASS = 1,   // both eyes in full, one after the other
    BSP_MODE_SHARED = 2,     // both eyes in full, culled and sorted together: the same pictures in less time
    BSP_MODE_PAPER = 3,      // the second eye warped from the first one, its borders rendered again (Zhu and Zhou)
    BSP_MODE_PREDICTED = 4,  // and the tiles with the greatest expected error, up to the budget
    BSP_MODE_TEMPORAL = 5    // with a past: both eyes warped from the frame before, and such tiles of both; the first frame is predicted
} bsp_mode;

typedef enum bsp_frame_flags {
    BSP_FRAME_HALF_FLOATS = 1,  // pictures of 11 bits a value, for display: half the memory, and less time
    BSP_FRAME_DEPTH = 2,        // depths are kept, for bsp_read_depth
    BSP_FRAME_CUT = 4,          // the past is of no use: the head jumped, or the scene changed
    BSP_FRAME_SETTLED = 8       // of bsp_render and bsp_prepare: all that the views ask for of live scenes is waited for
} bsp_frame_flags;

// A scene where it is placed among others: p in the frame = scale * (orientation p) + position, with p in the coordinates of its file.
typedef struct bsp_instance {
    uint32_t type, size;  // BSP_TYPE_INSTANCE
    const void* next;
    bsp_scene scene;        // that is there; several instances may be of one
    double orientation[4];  // a quaternion; all 0: as in the file
    double position[3];
    double scale;     // 0: 1
    uint32_t hidden;  // 1: not shown
} bsp_instance;

typedef struct bsp_frame_info {
    uint32_t type, size;  // BSP_TYPE_FRAME_INFO
    const void* next;
    bsp_scene scene;        // one that is there; null: an empty one, or `instances`
    const bsp_view* views;  // the first two are a pair of eyes, left and right, of one size; so are the third and the fourth
    uint32_t view_count;    // 1 to 4; an odd one at the end is drawn by itself, in full
    bsp_mode mode;
    uint32_t flags;        // of bsp_frame_flags
    double budget;         // share of an eye's work (predicted) or of both eyes' (temporal) that mends the warp; 0: 0.2; less than 0: none
    double near_depth;     // the nearest depth that is drawn; 0: the scene's
    double background[3];  // red, green, blue, as they are displayed
    // Several scenes in place of `scene`, at most 4096: all discs, or all Gaussians trained alike. A `near_depth` of 0 is
    // then the least of theirs. Where an instance comes or goes it is a cut; where one moves or is hidden it is none.
    const bsp_instance* instances;
    uint32_t instance_count;
    uint32_t unused;
    double foveation_rad;  // within this angle of its gaze an eye sees all; farther out tiles may be coarse, as it would not see; 0: none
    double time_s;         // which scenes that move are shown at, in their loop
    // temporal: tiles that are expected to be off by more than this PSNR in dB, such as 28, are rendered first, within
    // the budget, and what is better than that is left as it is; up to 60; 0: no bound, the budget is spent
    double error_bound_db;
} bsp_frame_info;

BSP_API bsp_result bsp_renderer_create(bsp_device device, bsp_renderer* renderer);
// Null is fine. Waits for what the library submitted; what the program submitted must be done.
BSP_API void bsp_renderer_destroy(bsp_renderer renderer);

typedef struct bsp_frame_result {
    uint32_t type, size;  // BSP_TYPE_FRAME_RESULT
    void* next;
    double gpu_ms;               // that the device took, for the first two views; 0 if it has no timestamps
    uint64_t splats_visible;     // by an eye of the first two
    uint64_t tile_pairs;         // of tile and splat that were blended for them
    double work_rendered;        // the share of the second eye's work (predicted) or of both eyes' (temporal) that was rendered
    uint64_t frames_cut_short;   // so far: lists had no room, and something showed background
    uint64_t peak_device_bytes;  // the most that was ever in use
    double share_there;          // of what the views ask for of live scenes, of the one that lacks most; 1: all of it
} bsp_frame_result;

// Renders and waits. `result` may be null. For BSP_MODE_TEMPORAL call it frame after frame, with views that move little.
BSP_API bsp_result bsp_render(bsp_renderer renderer, const bsp_frame_info* frame, bsp_frame_result* result);
// A view of the last bsp_render: rows from top to bottom, four floats a pixel: red, green, blue as they are displayed (sRGB, usually 0 to
// 1, not clamped) with the background behind them, and alpha, the share of the pixel that splats cover. `count`: floats that there is room
// for, at least 4 width height.
BSP_API bsp_result bsp_read_colour(bsp_renderer renderer, uint32_t view, float* values, uint64_t count);
// Likewise one float a pixel: how far along the camera's z axis lies what the pixel shows, the mean by what each splat adds; 0 where it
// shows nothing. Of a view with BSP_FRAME_DEPTH.
BSP_API bsp_result bsp_read_depth(bsp_renderer renderer, uint32_t view, float* values, uint64_t count);

// Writes a picture with 8 bits a channel and no alpha, as PNG (as PPM if the library was built without OpenImageIO and libpng), to `path`
// and the extension for that. A failed write leaves no file. Beside any call.
BSP_API bsp_result bsp_write_picture(const char* path, const float* rgba, uint32_t width, uint32_t height);

#ifdef __cplusplus
}
#endif

#endif
