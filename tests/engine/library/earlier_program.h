// A C program, compiled against an earlier header.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

struct bsp_renderer_t;
struct bsp_scene_t;
enum compiled_against { AN_EARLIER_ONE, A_LATER_ONE, A_LATER_ONE_AND_USES_IT };

int draw_as_compiled(struct bsp_renderer_t* renderer, struct bsp_scene_t* scene, enum compiled_against header,
                     float* red);

#ifdef __cplusplus
}
#endif
