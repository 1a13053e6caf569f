// What a frame does, in order: the lists of splats that it makes, the pictures that it renders, and which of
// these are made from others.
#pragma once

#include "engine/frame/settings.h"
#include "engine/passes/eye_relation.h"
#include "engine/passes/passes.h"

#include <optional>
#include <span>
#include <vector>

namespace binosplat {

// Pictures that frames have: two eyes with a history take turns with theirs, one that is being made, and one
// more in case sizes change.
inline constexpr std::size_t kFramePictures = 4;

// A list of visible splats, front to back.
struct ListPlan {
    EyesOfList eyes;
    Role role = Role::kNone;
    // Holds only what touches the chosen tiles of its eyes, and is made once these are known.
    bool of_chosen = false;
    bool culls = true;  // otherwise it is the existing one, in the order of another eye
};

// Where pixels of a target that are not rendered come from.
struct Warp {
    int source = 0;  // of the plan's targets; it is rendered before
    EyeRelation relation;
    StereoSettings settings;
    // If false, nothing is warped, and the frame only finds out whether warping would pay in the next one.
    bool may_move = true;
    std::optional<Gaze> gaze = {};  // empty: the whole target counts alike
};

// The last picture of an eye, from which later ones are made.
struct History {
    Eye eye;
    int picture = 0;             // of the frames'
    glm::uvec2 memory_px{0, 0};  // that this has memory for
};
// By eye; the picture to be made next, which no frame in flight reads; and the eye to be rendered in
// full next (kAlternate).
struct Histories {
    std::array<std::optional<History>, 2> of_eyes = {};
    int spare = 2;
    int turn = 0;
};

// A picture that the frame makes.
struct TargetPlan {
    Eye eye;
    glm::uvec2 memory_px{0, 0};  // its pictures have memory for this size
    Role role = Role::kNone;
    int list = 0;            // of visible splats
    bool is_masked = false;  // some tiles may be hidden
    std::uint32_t tiles_hidden = 0;
    Kept kept;
    std::optional<MeshDepths> mesh_depths = {};  // that cut through it
    TileChoice choice = TileChoice::kAll;        // of the tiles that are rendered
    std::optional<Warp> warp = {};
    std::optional<History> history = {};  // what it is made from instead: its eye's last picture
    std::optional<Gaze> gaze = {};  // for the choice among what the history has left, and of coarse tiles
    int picture = 0;                // which of the frames' pictures it becomes
    bool keeps_classes = false;
    bool from_history_later = false;  // frames after this one make it from a history: what they need is kept
    bool coarse = false;              // tiles that the eye does not see sharply may be
};

struct Step {
    enum class Kind {
        kList,     // makes FramePlan::lists[index]
        kWarp,     // warps pixels into FramePlan::targets[index] and chooses its tiles
        kHistory,  // makes FramePlan::targets[index] from its history
        kChoose,   // chooses the tiles of all targets that have one
        kRender,   // renders the chosen tiles, of all targets if they are rendered at once
    };
    Kind kind;
    int index;
};

struct FramePlan {
    std::vector<ListPlan> lists = {};
    std::vector<TargetPlan> targets = {};  // one for each eye, in the eyes' order
    std::size_t eyes = 0;
    std::vector<Step> steps = {};
    bool shares_order = false;  // one order of the splats serves all eyes
    double near = 0.2;
    glm::dvec3 background{0.0};
    // For the choice among what histories have left: a share of the work of the targets that have one.
    double budget = 0.0;
    double error_bound_db = 0.0;                        // of that choice: StereoSettings
    std::uint32_t measured_part = gpu::kMeasuredParts;  // FrameSettings
    int dominant = 0;                                   // of the targets
    bool keeps_history = false;                         // later frames are made from this one
    bool in_full = false;                               // since reprojecting would cost more
    std::optional<int> spare_picture = {};              // the picture for the frame after this one
    // How many pictures are rendered at the same time, from lists with capacity for each; and in that frame.
    int at_once = 1, at_once_ahead = 1;

    // The step that makes it is the next one.
    void makeList(const ListPlan& list) {
        steps.push_back({Step::Kind::kList, static_cast<int>(lists.size())});
        lists.push_back(list);
    }
    // The target from which others are made, or the one that is rendered in full.
    [[nodiscard]] int firstTarget() const;
    // True if nothing is in the target's picture until its pairs are sorted, or in both if they are rendered
    // at once. The frames after a history need their lists in one piece.
    [[nodiscard]] bool isSortedInPicture(const TargetPlan& target) const {
        return target.choice == TileChoice::kAll && !keeps_history && !target.coarse;
    }
    [[nodiscard]] bool isSortedInBothPictures() const { return at_once > 1 && isSortedInPicture(targets[0]); }
    // The tiles of the target and of those that are rendered with it.
    [[nodiscard]] gpu::uint tilesWith(const TargetPlan& target) const;
    // The first target that is made from another.
    [[nodiscard]] std::optional<int> warpedTarget() const;
};

// True if tiles may be coarse: that is wanted, and all eyes' gazes are known. The references are always in
// full.
[[nodiscard]] bool hasCoarseTiles(const FrameSettings& settings, std::size_t eyes);

// The only place that knows what a mode does. Throws Error if eyes that are made from one another have
// different sizes, or if one is larger than any can be. `may_move`: warping paid in the frame before, or that
// is unknown; if not, `temporal` renders both eyes in full. `splats`: the most that the scene can show.
// `histories`: the histories that earlier frames have left; their pictures may have other sizes.
FramePlan planFrame(const FrameSettings& settings, std::span<const Eye> eyes, bool may_move,
                    std::uint32_t splats, const Histories& histories = {});
// What such a frame leaves to the next one.
Histories historiesAfter(const FramePlan& plan, const Histories& before);

}  // namespace binosplat
