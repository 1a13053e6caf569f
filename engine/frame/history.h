// What a frame remembers about earlier ones.
#pragma once

#include "engine/frame/settings.h"

#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// What frames that are in flight together must have in common.
struct FrameShape {
    Mode mode = Mode::kMono;
    int dominant = 0;
    bool per_eye = false, half_floats = false, keep_depth = false, keep_both_depths = false,
         keep_moments = false, keep_classes = false, center_rois = false, half_periphery = false;
    std::array<glm::uvec2, 2> memory_px{};  // the sizes that pictures have memory for
    bool operator==(const FrameShape&) const = default;
};
FrameShape shapeOf(std::span<const Eye> eyes, const FrameSettings& settings);

// True if lists for these eyes may differ much from those for `before`.
bool jumps(std::span<const Eye> before, std::span<const Eye> eyes, double units_per_metre);
// The farthest that a history may be from these eyes, in scene units.
double farthestHistory(std::span<const Eye> eyes, double units_per_metre);
// True if what `history` saw is of use for `eye`: their places and axes are close. Sizes may differ, and
// angles by less than a factor of two.
bool canComeFrom(const Eye& history, const Eye& eye, double farthest);

// Whether warping pays: `predicted` does without it for as long as it did not pay in the last known frame
// with the same settings.
class MovingPays {
public:
    struct Asked {
        StereoSettings stereo;
        int dominant = 0;
        glm::uvec2 size_px{0, 0};
        std::size_t hidden_tiles = 0;
        bool operator==(const Asked&) const = default;
    };

    [[nodiscard]] static Asked askedBy(std::span<const Eye> eyes, const FrameSettings& settings);
    [[nodiscard]] bool mayMove(const Asked& asked) const { return asked != asked_ || pays_; }
    // The settings of the next frame.
    void ask(const Asked& asked, bool may_move) {
        asked_ = asked;
        pays_ = may_move;
    }
    [[nodiscard]] const Asked& asked() const { return asked_; }
    // The result of a frame with the settings `asked`.
    void learn(const Asked& asked, bool pays) {
        if (asked == asked_) { pays_ = asked.stereo.choice != TileChoice::kPredicted || pays; }
    }
    void forget() { *this = {}; }

private:
    Asked asked_;
    bool pays_ = true;
};

// Whether reprojecting pays for `temporal`: frames with few pairs of tile and splat are rendered in full,
// which is exact, for as long as reprojecting both eyes' histories would cost more than it saves. Work is
// that of both eyes, in such pairs.
class HistoryPays {
public:
    using Asked = MovingPays::Asked;

    [[nodiscard]] bool mayReproject() const { return pays_; }
    // The work of both pictures in full, as far as known.
    [[nodiscard]] double fullWork() const { return full_; }
    // With other settings, less may have to be rendered again.
    void ask(const Asked& asked);
    // A frame with the settings `asked`, of so many tiles; `rendered`: the work that was done again, if it
    // had a history.
    void learn(const Asked& asked, double full, std::optional<double> rendered, double tiles);
    void forget() { *this = {}; }

private:
    Asked asked_;
    bool pays_ = true;
    double full_ = 0.0;
    double share_ = 0.0;  // of the work that is rendered again
};

}  // namespace binosplat
