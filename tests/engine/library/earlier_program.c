/* For library_test: C compiled against an earlier header, whose frames ended with the mode and whose views ended
   with their size, and against a later one, whose frames have one more field. Each draws the splat of
   builtin:one-splat and prints how red its middle is. */
#include "tests/engine/library/earlier_program.h"

#include <binosplat.h>

typedef struct earlier_frame {
    uint32_t type, size;
    const void* next;
    bsp_scene scene;
    const bsp_view* views;
    uint32_t view_count;
    bsp_mode mode;
} earlier_frame;

typedef struct earlier_view {
    uint32_t type, size;
    const void* next;
    double orientation[4], position[3];
    double left_rad, right_rad, up_rad, down_rad;
    uint32_t width, height;
} earlier_view;

typedef struct later_frame {
    bsp_frame_info known;
    double unknown;
} later_frame;

static bsp_result draw(bsp_renderer renderer, const void* frame, float* red) {
    static float values[4 * 16 * 16];
    const bsp_result result = bsp_render(renderer, (const bsp_frame_info*)frame, NULL);
    if (result != BSP_SUCCESS) { return result; }
    *red = 0.0f;
    if (bsp_read_colour(renderer, 0, values, sizeof values / sizeof *values) == BSP_SUCCESS) { *red = values[4 * (8 * 16 + 8)]; }
    return BSP_SUCCESS;
}

int draw_as_compiled(struct bsp_renderer_t* renderer, struct bsp_scene_t* scene, enum compiled_against header, float* red) {
    bsp_scene_properties properties = {BSP_TYPE_SCENE_PROPERTIES, sizeof properties};
    bsp_view view = {BSP_TYPE_VIEW, sizeof view};
    earlier_view views[2] = {{BSP_TYPE_VIEW, sizeof views[0]}, {BSP_TYPE_VIEW, sizeof views[0]}};
    if (bsp_scene_get_properties(scene, &properties) != BSP_SUCCESS ||
        bsp_look_at(properties.eye, properties.look, properties.up, 0.0, 1.0, 16, 16, 1, &view) != BSP_SUCCESS ||
        bsp_look_at(properties.eye, properties.look, properties.up, 0.0, 1.0, 16, 16, 2, (bsp_view*)views) != BSP_SUCCESS) {
        return BSP_ERROR_INPUT;
    }
    if (header == AN_EARLIER_ONE) {
        earlier_frame frame = {BSP_TYPE_FRAME_INFO, sizeof frame};
        frame.scene = scene;
        frame.views = (const bsp_view*)views;
        frame.view_count = 2;
        frame.mode = BSP_MODE_SHARED;
        return draw(renderer, &frame, red);
    } else {
        later_frame frame = {{BSP_TYPE_FRAME_INFO, sizeof frame}};
        frame.known.scene = scene;
        frame.known.views = &view;
        frame.known.view_count = 1;
        frame.unknown = header == A_LATER_ONE_AND_USES_IT ? 1.0 : 0.0;
        return draw(renderer, &frame, red);
    }
}
