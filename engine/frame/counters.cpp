// Names of counters.
#include "engine/frame/counters.h"

namespace binosplat {

std::map<std::string, std::uint64_t> FrameCounters::named() const {
    if (targets.empty()) { return {}; }
    std::map<std::string, std::uint64_t> names{{"commands", commands},       {"splats_read", splats_read},
                                               {"scene_bytes", scene_bytes}, {"visible_bytes", visible_bytes},
                                               {"pair_bytes", pair_bytes},   {"scratch_bytes", scratch_bytes}};
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const TargetCounters& target = targets[t];
        const std::string eye = targets.size() == 1 ? "" : t == 0 ? "_left" : "_right";
        names["splats_visible" + eye] = target.splats_visible;
        names["tile_pairs" + eye] = target.tile_pairs;
        names["tiles" + eye] = target.tiles;
        if (target.tiles_hidden > 0) { names["tiles_hidden" + eye] = target.tiles_hidden; }
        names["pixels" + eye] = target.pixels;
        names["pixel_bytes" + eye] = target.pixel_bytes;
    }
    if (pages) {
        names["pages_resident"] = pages->resident;
        names["pages_seen"] = pages->seen;
    }
    if (coarse) {
        names["tiles_coarse"] = coarse->tiles;
        names["tiles_tried_as_coarse"] = coarse->tiles_tried;
        names["tile_pairs_as_samples"] = coarse->pairs;
        names["tile_pairs_in_full"] = coarse->sharp_pairs;
    }
    if (warped) {
        if (warped->pixels) {
            names["pixels_covered"] = warped->pixels->covered;
            names["pixels_gap"] = warped->pixels->gap;
            names["pixels_hole"] = warped->pixels->hole;
        }
        names["tiles_patched"] = warped->tiles_patched;
        names["tiles_edge"] = warped->tiles_edge;
        names["tiles_center"] = warped->tiles_center;
        names["tiles_predicted"] = warped->tiles_predicted;
        if (warped->work) {
            names["tiles_cheap"] = warped->work->tiles_cheap;
            names["tiles_weighed_as_moved"] = warped->work->tiles_weighed_as_moved;
            names["work_full"] = warped->work->full;
            names["work_patched"] = warped->work->patched;
            names["work_saved_by_moving"] = warped->work->saved_by_moving;
        }
        if (warped->tiles_over_bound) { names["tiles_over_bound"] = *warped->tiles_over_bound; }
        names["hole_components"] = warped->hole_components;
        names["splats_newcomers"] = warped->splats_newcomers;
        names["stereo_bytes"] = warped->bytes;
    }
    if (ahead) {
        names["frames_cut_short"] = ahead->frames_cut_short;
        names["frames_done_again"] = ahead->frames_done_again;
    }
    if (streaming) {
        names["splats_resident"] = streaming->splats_resident;
        names["chunks_resident"] = streaming->chunks_resident;
        names["frames_waited_for_loading"] = streaming->frames_waited_for_loading;
        names["scene_frames_late"] = streaming->scene_frames_late;
    }
    return names;
}

}  // namespace binosplat
