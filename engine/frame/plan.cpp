// Each mode as lists, targets and steps.
#include "engine/frame/plan.h"

#include "engine/error.h"
#include "engine/passes/eye_view.h"

#include <algorithm>
#include <cassert>

namespace binosplat {
namespace {

// The sums and words that `source` keeps for the target that is made from it.
void keepForWarp(Kept& source, const Warp& warp) {
    if (!warp.may_move) { return; }
    const bool predicts = warp.settings.choice == TileChoice::kPredicted;
    source.moving = true;
    source.depth_choice = warp.settings.depth_choice;
    // Odd rows will be warped like even ones, unless their moments are wanted.
    source.even_rows =
        predicts && warp.relation.rectified && !source.moments && source.depth_choice == gpu::kDepthInverse;
}

// True if one kernel suits both eyes, and rendering both whole at once takes little more memory than one
// after the other: if a pair fits into a word, and lists may lie in the pictures. With a history or coarse
// tiles they may not, unless they are short (`is_little`).
bool canRenderAtOnce(const FramePlan& plan, const FrameSettings& settings, std::uint32_t splats,
                     bool is_little) {
    const TargetPlan &left = plan.targets[0], &right = plan.targets[1];
    const glm::uvec2 tiles = tilesOf(left.memory_px);
    return plan.shares_order && (!plan.keeps_history || is_little) && !left.coarse &&
           left.eye.size_px == right.eye.size_px && left.memory_px == right.memory_px &&
           left.kept.cut == right.kept.cut && left.is_masked == right.is_masked && !settings.keep_moments &&
           PairFormat(2 * tiles.x * tiles.y, splats).fitsOneWord();
}

}  // namespace

// A picture that is neither a history nor the spare one.
int fourthPicture(const Histories& histories) {
    int picture = 0;
    while (picture == histories.spare || picture == histories.of_eyes[0]->picture ||
           picture == histories.of_eyes[1]->picture) {
        ++picture;
    }
    assert(picture < static_cast<int>(kFramePictures));
    return picture;
}

// `target` is made from `history`, and some of its tiles are chosen to be rendered.
void makeFromHistory(TargetPlan& target, const History& history, const FrameSettings& settings,
                     std::size_t eye) {
    target.history = history;
    target.choice = TileChoice::kHistory;
    target.gaze = settings.gazes[eye];
}

bool hasCoarseTiles(const FrameSettings& settings, std::size_t eyes) {
    const bool may =
        settings.mode == Mode::kMono || settings.mode == Mode::kPredicted || hasHistory(settings.mode);
    const auto gazes = std::span(settings.gazes).first(eyes);
    return settings.half_periphery && may && !settings.keep_moments && !settings.mesh_depths[0] &&
           std::ranges::all_of(gazes, [](const auto& gaze) { return gaze.has_value(); });
}

// The chosen tiles of both eyes, in this order, from one list.
void renderChosen(FramePlan& plan, const std::array<int, 2>& order, ListPlan list) {
    list.of_chosen = true;
    // A patch is too little work for a GPU: if the eyes have the same order and tiles, each stage processes
    // both eyes.
    if (plan.shares_order && plan.targets[0].eye.size_px == plan.targets[1].eye.size_px) {
        plan.at_once = list.eyes.at_once = 2;
        plan.makeList(list);
        plan.steps.push_back({Step::Kind::kRender, order[0]});
        return;
    }
    plan.makeList(list);
    plan.steps.push_back({Step::Kind::kRender, order[0]});
    if (!plan.shares_order) {
        plan.makeList({.eyes = {.order_eye = order[1], .list = 0},
                       .role = plan.targets[static_cast<std::size_t>(order[1])].role,
                       .culls = false});
    }
    plan.steps.push_back({Step::Kind::kRender, order[1]});
}

// Both eyes from their histories; the tiles that are rendered again are chosen before anything is culled.
void planTemporal(FramePlan& plan, const FrameSettings& settings, const Histories& histories,
                  const ListPlan& list) {
    const std::array order{plan.dominant, 1 - plan.dominant};
    int picture = histories.spare;
    for (const int e : order) {
        const auto eye = static_cast<std::size_t>(e);
        TargetPlan& target = plan.targets[eye];
        makeFromHistory(target, *histories.of_eyes[eye], settings, eye);
        target.picture = picture;
        // Free once this target is made; a larger one needs memory of its own, since this is still being
        // read.
        const bool fits =
            target.history->memory_px == plan.targets[static_cast<std::size_t>(order[1])].memory_px;
        picture = fits ? target.history->picture : fourthPicture(histories);
    }
    for (const int e : order) { plan.steps.push_back({Step::Kind::kHistory, e}); }
    plan.budget = settings.stereo.budget;
    plan.error_bound_db = settings.stereo.error_bound_db;
    plan.measured_part = settings.measured_part;
    plan.steps.push_back({Step::Kind::kChoose, 0});
    renderChosen(plan, order, list);
}

// One eye in full, taking turns, and the other from its history.
void planAlternate(FramePlan& plan, const Histories& histories, const ListPlan& list) {
    const int full = histories.turn, other = 1 - full;
    TargetPlan &rendered = plan.targets[full], &warped = plan.targets[other];
    rendered.picture = histories.of_eyes[static_cast<std::size_t>(full)]->picture;
    warped.history = histories.of_eyes[static_cast<std::size_t>(other)];
    warped.picture = histories.spare;
    warped.choice = TileChoice::kNone;
    warped.kept.history = false;
    plan.makeList(list);
    plan.steps.push_back({Step::Kind::kRender, full});
    plan.steps.push_back({Step::Kind::kHistory, other});
}

std::uint32_t countHidden(std::span<const std::uint8_t> hidden_tiles) {
    return static_cast<std::uint32_t>(
        hidden_tiles.size() - static_cast<std::size_t>(std::ranges::count(hidden_tiles, std::uint8_t{0})));
}

StereoSettings stereoSettingsOf(const FrameSettings& settings) {
    StereoSettings stereo = settings.stereo;
    stereo.choice = choiceOf(settings.mode);
    return stereo;
}

int FramePlan::firstTarget() const {
    const auto found = std::ranges::find(steps, Step::Kind::kRender, &Step::kind);
    return found == steps.end() ? 0 : found->index;
}

gpu::uint FramePlan::tilesWith(const TargetPlan& target) const {
    const auto tilesIn = [](const TargetPlan& of) {
        const glm::uvec2 tiles = tilesOf(of.eye.size_px);
        return tiles.x * tiles.y;
    };
    if (at_once == 1) { return tilesIn(target); }
    gpu::uint tiles = 0;
    for (const TargetPlan& of : targets) { tiles += tilesIn(of); }
    return tiles;
}

std::optional<int> FramePlan::warpedTarget() const {
    const auto found =
        std::ranges::find_if(targets, [](const TargetPlan& target) { return target.warp.has_value(); });
    return found == targets.end() ? std::nullopt : std::optional(static_cast<int>(found - targets.begin()));
}

Histories historiesAfter(const FramePlan& plan, const Histories& before) {
    Histories after = before;
    for (std::size_t e = 0; e < plan.eyes; ++e) {
        const TargetPlan& target = plan.targets[e];
        if (target.kept.history) { after.of_eyes[e] = History{target.eye, target.picture, target.memory_px}; }
    }
    // A picture that was a history is free, once this frame has read it.
    const auto isFree = [&](int picture) {
        return std::ranges::none_of(
            after.of_eyes, [&](const auto& history) { return history && history->picture == picture; });
    };
    if (plan.spare_picture) { after.spare = *plan.spare_picture; }
    for (std::size_t e = 0; e < before.of_eyes.size() && !isFree(after.spare); ++e) {
        if (before.of_eyes[e]) { after.spare = before.of_eyes[e]->picture; }
    }
    after.turn = 1 - before.turn;
    return after;
}

FramePlan planFrame(const FrameSettings& settings, std::span<const Eye> eyes, bool may_move,
                    std::uint32_t splats, const Histories& histories) {
    const bool keeps_history = hasHistory(settings.mode) && settings.keep_history;
    // `temporal` does without the histories where reprojecting them does not pay.
    const bool in_full = keeps_history && settings.mode == Mode::kTemporal && !may_move;
    const bool has_history = keeps_history && !in_full && histories.of_eyes[0] && histories.of_eyes[1];
    // If no history is kept, `temporal` falls back to `predicted`. If there is none, as after a jump, both
    // eyes are exact, since later pictures are made from them. And if each eye is cheap to render, making one
    // from the other would save a tenth of the time at the price of 15 to 30 dB.
    const bool coarse = hasCoarseTiles(settings, eyes.size()),
               predicts = choiceOf(settings.mode) == TileChoice::kPredicted && !keeps_history;
    const Mode mode = predicts                                    ? coarse ? Mode::kShared : Mode::kPredicted
                      : hasHistory(settings.mode) && !has_history ? Mode::kShared
                                                                  : settings.mode;
    const bool one_eye = mode == Mode::kMono;
    assert(eyes.size() == (one_eye ? 1u : 2u));
    check(!reprojects(mode) || eyes[0].size_px == eyes[1].size_px,
          "the eyes have {}x{} and {}x{} pixels: to reproject one into the other they must be equal",
          eyes[0].size_px.x, eyes[0].size_px.y, eyes.back().size_px.x, eyes.back().size_px.y);
    constexpr gpu::uint kMostPixels = gpu::kMostTilesAcross * gpu::kTileSize;
    for (const Eye& eye : eyes) {
        check(std::max(eye.size_px.x, eye.size_px.y) <= kMostPixels,
              "a picture has {}x{} pixels, at most {} per side are possible", eye.size_px.x, eye.size_px.y,
              kMostPixels);
    }
    const int first = one_eye ? 0 : settings.dominant, second = 1 - first;
    // True if each eye is culled and ordered by itself.
    const bool apart = one_eye || mode == Mode::kTwoPass || mode == Mode::kAlternate ||
                       (mode == Mode::kPaper && settings.per_eye);

    FramePlan plan{.near = settings.near, .background = settings.background};
    plan.dominant = first;
    plan.eyes = eyes.size();
    for (int e = 0; e < static_cast<int>(eyes.size()); ++e) {
        const bool is_first = e == first;
        plan.targets.push_back(
            {.eye = eyes[e],
             .memory_px = glm::max(settings.most_px, eyes[e].size_px),
             .role = one_eye    ? Role::kNone
                     : is_first ? Role::kDominant
                                : Role::kAffiliated,
             .list = apart ? e : 0,
             .is_masked = !settings.hidden_tiles[static_cast<std::size_t>(e)].empty(),
             .tiles_hidden = countHidden(settings.hidden_tiles[static_cast<std::size_t>(e)]),
             .kept = {.depth = is_first ? settings.keep_depth : settings.keep_both_depths,
                      .surface = settings.surface_depths && settings.half_floats && !keeps_history &&
                                 !reprojects(mode),
                      .moments = is_first && settings.keep_moments,
                      .half_floats = settings.half_floats,
                      .cut = settings.mesh_depths[static_cast<std::size_t>(e)].has_value(),
                      .history = keeps_history},
             .mesh_depths = settings.mesh_depths[static_cast<std::size_t>(e)],
             .picture = e,
             .from_history_later =
                 keeps_history && (settings.mode == Mode::kTemporal || (!has_history && e == histories.turn)),
             .coarse = coarse});
        if (coarse) { plan.targets.back().gaze = settings.gazes[static_cast<std::size_t>(e)]; }
    }
    plan.keeps_history = keeps_history;
    plan.in_full = in_full;
    if (keeps_history && !has_history) { plan.spare_picture = static_cast<int>(eyes.size()); }
    std::optional<gpu::Place> middle;
    if (settings.order == Order::kDistance) { middle = placeOf(middleOf(eyes)); }
    const auto listOf = [&](int e) {
        plan.makeList({.eyes = {.first = e, .count = 1, .order_eye = e, .list = e, .middle = middle},
                       .role = plan.targets[e].role});
    };
    const auto render = [&](int e) { plan.steps.push_back({Step::Kind::kRender, e}); };
    ListPlan both{.eyes = {.first = 0, .count = 2, .order_eye = first, .list = 0, .middle = middle},
                  .role = Role::kBoth};

    if (mode == Mode::kAlternate) {
        const int full = histories.turn;
        planAlternate(plan, histories,
                      {.eyes = {.first = full, .count = 1, .order_eye = full, .list = full, .middle = middle},
                       .role = plan.targets[full].role});
        return plan;
    }
    const EyeRelation relation = relate(eyes[first], eyes[one_eye ? first : second]);
    plan.shares_order = !one_eye && (middle || relation.same_depths);
    if (keeps_history && plan.shares_order && eyes[0].size_px == eyes[1].size_px) {
        plan.at_once_ahead = settings.mode == Mode::kTemporal ? 2 : 1;
    }
    if (mode == Mode::kTemporal) {
        planTemporal(plan, settings, histories, both);
        return plan;
    }

    if (mode == Mode::kShared && canRenderAtOnce(plan, settings, splats, in_full)) {
        plan.at_once = both.eyes.at_once = 2;
    }
    if (apart) {
        listOf(first);
    } else {
        plan.makeList(both);
    }
    render(first);
    if (one_eye || plan.at_once > 1) { return plan; }

    TargetPlan &source = plan.targets[first], &target = plan.targets[second];
    if (apart) { listOf(second); }
    if (reprojects(mode)) {
        target.warp = Warp{.source = first,
                           .relation = relation,
                           .settings = stereoSettingsOf(settings),
                           .may_move = may_move,
                           .gaze = settings.gazes[static_cast<std::size_t>(second)]};
        target.choice = may_move ? target.warp->settings.choice : TileChoice::kAll;
        target.keeps_classes = settings.keep_classes;
        keepForWarp(source.kept, *target.warp);
        plan.steps.push_back({Step::Kind::kWarp, second});
    }
    if (target.choice == TileChoice::kNone) { return plan; }
    if (!apart && !plan.shares_order) {
        plan.makeList({.eyes = {.order_eye = second, .list = 0}, .role = target.role, .culls = false});
    }
    render(second);
    return plan;
}

}  // namespace binosplat
