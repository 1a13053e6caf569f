// A frame's counters.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// Of one picture.
struct TargetCounters {
    std::uint64_t splats_visible = 0;  // in its list
    std::uint64_t tile_pairs = 0;
    std::uint64_t tiles = 0, tiles_hidden = 0;  // tiles_hidden: those that are never seen
    std::uint64_t pixels = 0, pixel_bytes = 0;
};

// For a picture that is made from another.
struct WarpedCounters {
    // How its pixels were made, before tiles are rendered; if this was kept.
    struct Classes {
        std::uint64_t covered = 0, gap = 0, hole = 0;
    };
    // In pairs of tile and splat; if tiles are weighed.
    struct Work {
        std::uint64_t tiles_cheap = 0, tiles_weighed_as_reprojected = 0, full = 0, patched = 0,
                      saved_by_moving = 0;
    };
    std::optional<Classes> pixels;
    std::uint64_t tiles_shown = 0;  // of pictures that are made from others
    std::uint64_t tiles_patched = 0, tiles_edge = 0, tiles_center = 0, tiles_predicted = 0;
    std::optional<Work> work;
    // If errors are bounded: tiles left above the bound for lack of budget.
    std::optional<std::uint64_t> tiles_over_bound;
    std::uint64_t hole_components = 0, splats_newcomers = 0, bytes = 0;
};

struct FrameCounters {
    std::uint64_t commands = 0, splats_read = 0;
    std::uint64_t scene_bytes = 0, visible_bytes = 0, pair_bytes = 0, scratch_bytes = 0;
    std::vector<TargetCounters> targets;  // one for each eye
    // For a scene whose parts come and go: pages that contain splats, and those that cull examined for the
    // list that needed most.
    struct Pages {
        std::uint64_t resident = 0, seen = 0;
    };
    std::optional<Pages> pages;
    // If tiles may be coarse: those that are, those that were tried as coarse, and the pairs that were
    // blended as samples and in full.
    struct Coarse {
        std::uint64_t tiles = 0, tiles_tried = 0, pairs = 0, sharp_pairs = 0;
    };
    std::optional<Coarse> coarse;
    std::optional<WarpedCounters> warped;
    // Of StereoFrame::renderAhead, since its frame was made.
    struct Ahead {
        std::uint64_t frames_cut_short = 0, frames_done_again = 0;
    };
    std::optional<Ahead> ahead;
    // For a scene that is streamed or moves, from its loader.
    struct Streaming {
        std::uint64_t splats_resident = 0, chunks_resident = 0, frames_waited_for_loading = 0,
                      scene_frames_late = 0;
    };
    std::optional<Streaming> streaming;

    // The counters by their names in reports; empty for a frame that was not drawn.
    [[nodiscard]] std::map<std::string, std::uint64_t> named() const;
};

}  // namespace binosplat
