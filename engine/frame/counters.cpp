// Names of counters.
#include "engine/frame/counters.h"

namespace binosplat {

std::map<std::string, std::uint64_t> FrameCounters::named() const {
    if (targets.empty()) { return {}; }
    std::map<std::string, std::uint64_t> names{
        {"commands", commands},           {"splats_read", splats_read}, {"scene_bytes", scene_bytes},
        {"visible_bytes", visible_bytes}, {"pair_bytes", pair_bytes},   {"scratch_bytes", scratch_bytes}};
    const auto add = [&names](std::map<std::string, std::uint64_t> more) { names.merge(more); };
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const TargetCounters& of = targets[t];
        const std::string eye = targets.size() == 1 ? "" : t == 0 ? "_left" : "_right";
        add({{"splats_visible" + eye, of.splats_visible},
             {"tile_pairs" + eye, of.tile_pairs},
             {"tiles" + eye, of.tiles}});
        add({{"pixels" + eye, of.pixels}, {"pixel_bytes" + eye, of.pixel_bytes}});
        if (of.tiles_hidden > 0) { add({{"tiles_hidden" + eye, of.tiles_hidden}}); }
    }
    if (pages) { add({{"pages_resident", pages->resident}, {"pages_seen", pages->seen}}); }
    if (coarse) {
        add({{"tiles_coarse", coarse->tiles}, {"tiles_tried_as_coarse", coarse->tiles_tried}});
        add({{"tile_pairs_as_samples", coarse->pairs}, {"tile_pairs_in_full", coarse->sharp_pairs}});
    }
    if (warped) {
        if (const auto& pixels = warped->pixels) {
            add({{"pixels_covered", pixels->covered},
                 {"pixels_gap", pixels->gap},
                 {"pixels_hole", pixels->hole}});
        }
        if (const auto& work = warped->work) {
            add({{"tiles_cheap", work->tiles_cheap},
                 {"tiles_weighed_as_reprojected", work->tiles_weighed_as_reprojected}});
            add({{"work_full", work->full},
                 {"work_patched", work->patched},
                 {"work_saved_by_moving", work->saved_by_moving}});
        }
        if (warped->tiles_over_bound) { add({{"tiles_over_bound", *warped->tiles_over_bound}}); }
        add({{"tiles_patched", warped->tiles_patched},
             {"tiles_edge", warped->tiles_edge},
             {"tiles_center", warped->tiles_center}});
        add({{"tiles_predicted", warped->tiles_predicted}, {"hole_components", warped->hole_components}});
        add({{"splats_newcomers", warped->splats_newcomers}, {"stereo_bytes", warped->bytes}});
    }
    if (ahead) {
        add({{"frames_cut_short", ahead->frames_cut_short}, {"frames_done_again", ahead->frames_done_again}});
    }
    if (streaming) {
        add({{"splats_resident", streaming->splats_resident},
             {"chunks_resident", streaming->chunks_resident}});
        add({{"frames_waited_for_loading", streaming->frames_waited_for_loading},
             {"scene_frames_late", streaming->scene_frames_late}});
    }
    return names;
}

}  // namespace binosplat
