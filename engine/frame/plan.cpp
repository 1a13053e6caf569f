// Each mode as lists, targets and steps.
#include "engine/frame/plan.h"

#include "engine/error.h"
#include "engine/passes/eye_view.h"

#include <algorithm>
#include <cassert>

namespace binosplat {
namespace {

// What `source` keeps for the target that is made from it.
void keepForWarp(Kept& source, const Warp& warp) {
    if (!warp.may_move) { return; }
    const bool predicts = warp.settings.choice == TileChoice::kPredicted;
    source.moving = true;
    source.spread = predicts;
    source.depth_choice = warp.settings.depth_choice;
    // Odd rows will be moved like even ones, unless somebody asks for their moments.
    source.even_rows = predicts && warp.relation.rectified && !source.moments && source.depth_choice == gpu::kDepthInverse;
}

}  // namespace

// Pictures that two eyes with a past take turns in: the pasts, one that is made meanwhile, and one more where sizes change.
constexpr int kPastPictures = 4;

// One that is nobody's past, nor the spare one.
int fourthPicture(const Pasts& pasts) {
    int picture = 0;
    while (picture == pasts.spare || picture == pasts.of_eyes[0]->picture || picture == pasts.of_eyes[1]->picture) { ++picture; }
    assert(picture < kPastPictures);
    return picture;
}

// `target` is made from `past`, and some of its tiles are chosen to be rendered.
void makeFromPast(TargetPlan& target, const Past& past, const FrameSettings& settings, std::size_t eye) {
    target.past = past;
    target.choice = TileChoice::kPast;
    target.gaze = settings.gazes[eye];
}

// Both eyes from their pasts; the tiles that are rendered again are chosen before anything is culled.
void planTemporal(FramePlan& plan, const FrameSettings& settings, std::span<const Eye> eyes, const Pasts& pasts, const ListPlan& list) {
    const int order[2] = {plan.dominant, 1 - plan.dominant};
    int picture = pasts.spare;
    for (const int e : order) {
        const auto eye = static_cast<std::size_t>(e);
        TargetPlan& target = plan.targets[eye];
        makeFromPast(target, *pasts.of_eyes[eye], settings, eye);
        target.picture = picture;
        // Free once this target is made; another size needs memory of its own, since that is still read.
        const bool fits = target.past->eye.size_px == eyes[static_cast<std::size_t>(order[1])].size_px;
        picture = fits ? target.past->picture : fourthPicture(pasts);
        plan.steps.push_back({Step::Kind::kPast, e});
    }
    plan.budget = settings.stereo.budget;
    plan.steps.push_back({Step::Kind::kChoose, 0});
    plan.lists.push_back(list);
    plan.lists.back().of_chosen = true;
    plan.steps.push_back({Step::Kind::kList, 0});
    // A patch is too little work for a GPU: stage by stage it has that of both eyes, where they have the same order and tiles.
    if (plan.shares_order && eyes[0].size_px == eyes[1].size_px) {
        plan.steps.push_back({Step::Kind::kRenderAll, order[0]});
        plan.lists.back().eyes.shares = plan.shares();
        return;
    }
    plan.steps.push_back({Step::Kind::kRender, order[0]});
    if (!plan.shares_order) {
        plan.steps.push_back({Step::Kind::kList, 1});
        plan.lists.push_back({.eyes = {.order_eye = order[1], .list = 0}, .role = plan.targets[order[1]].role, .culls = false});
    }
    plan.steps.push_back({Step::Kind::kRender, order[1]});
}

// One eye in full, in turn, and the other from its past.
void planAlternate(FramePlan& plan, const Pasts& pasts, const ListPlan& list) {
    const int full = pasts.turn, other = 1 - full;
    TargetPlan &rendered = plan.targets[full], &warped = plan.targets[other];
    rendered.picture = pasts.of_eyes[static_cast<std::size_t>(full)]->picture;
    warped.past = pasts.of_eyes[static_cast<std::size_t>(other)];
    warped.picture = pasts.spare;
    warped.choice = TileChoice::kNone;
    warped.kept.past = false;
    plan.steps.push_back({Step::Kind::kList, 0});
    plan.lists.push_back(list);
    plan.steps.push_back({Step::Kind::kRender, full});
    plan.steps.push_back({Step::Kind::kPast, other});
}

// The eye in two pictures, of which the smaller comes first: what it holds says where it will do.
void planPeriphery(FramePlan& plan, const Gaze& gaze, ListPlan list) {
    const int half = static_cast<int>(plan.targets.size());
    plan.targets.push_back(plan.targets[0]);
    TargetPlan &sharp = plan.targets[0], &coarse = plan.targets.back();
    sharp.choice = TileChoice::kSharp;
    sharp.gaze = gaze;
    sharp.half = half;
    coarse.eye = halfOf(sharp.eye);
    coarse.choice = TileChoice::kHalf;
    coarse.picture = half;
    plan.square_boxes = false;
    // Each has its own list: most splats touch tiles of one of them alone, and projecting costs more than culling.
    list.of_chosen = true;
    for (const int t : {0, half}) {
        plan.targets[static_cast<std::size_t>(t)].list = t;
        list.eyes.first = list.eyes.order_eye = list.eyes.list = t;
        plan.lists.push_back(list);
    }
    plan.steps = {{Step::Kind::kHalfTiles, 0}, {Step::Kind::kList, 1},   {Step::Kind::kRender, half}, {Step::Kind::kOwnTiles, 0},
                  {Step::Kind::kList, 0},      {Step::Kind::kRender, 0}, {Step::Kind::kFill, 0}};
}

StereoSettings stereoSettingsOf(const FrameSettings& settings) {
    StereoSettings stereo = settings.stereo;
    stereo.choice = choiceOf(settings.mode);
    return stereo;
}

int FramePlan::firstTarget() const {
    const auto found = std::ranges::find_if(
        steps, [](const Step& step) { return step.kind == Step::Kind::kRender || step.kind == Step::Kind::kRenderAll; });
    return found == steps.end() ? 0 : found->index;
}

int FramePlan::shares() const {
    const bool at_once = std::ranges::find(steps, Step::Kind::kRenderAll, &Step::kind) != steps.end();
    return at_once ? static_cast<int>(targets.size()) : 1;
}

std::optional<int> FramePlan::warpedTarget() const {
    const auto found = std::ranges::find_if(targets, [](const TargetPlan& target) { return target.warp.has_value(); });
    return found == targets.end() ? std::nullopt : std::optional(static_cast<int>(found - targets.begin()));
}

Pasts pastsAfter(const FramePlan& plan, const Pasts& before) {
    Pasts after = before;
    for (std::size_t e = 0; e < plan.targets.size(); ++e) {
        const TargetPlan& target = plan.targets[e];
        if (target.kept.past) { after.of_eyes[e] = Past{target.eye, target.picture}; }
    }
    // What was a past is free, once this frame has read it.
    const auto isFree = [&](int picture) {
        return std::ranges::none_of(after.of_eyes, [&](const auto& past) { return past && past->picture == picture; });
    };
    if (plan.spare_picture) { after.spare = *plan.spare_picture; }
    for (std::size_t e = 0; e < before.of_eyes.size() && !isFree(after.spare); ++e) {
        if (before.of_eyes[e]) { after.spare = before.of_eyes[e]->picture; }
    }
    after.turn = 1 - before.turn;
    return after;
}

FramePlan planFrame(const FrameSettings& settings, std::span<const Eye> eyes, bool may_move, const Pasts& pasts) {
    const bool keeps_past = hasPast(settings.mode) && settings.keep_past;
    const bool has_past = keeps_past && pasts.of_eyes[0] && pasts.of_eyes[1];
    // Without a past, and where none is kept, they are as these.
    const Mode mode = settings.mode == Mode::kTemporal && !keeps_past  ? Mode::kPredicted
                      : settings.mode == Mode::kAlternate && !has_past ? Mode::kShared
                                                                       : settings.mode;
    const bool one_eye = mode == Mode::kMono;
    assert(eyes.size() == (one_eye ? 1u : 2u));
    check(!reprojects(mode) || eyes[0].size_px == eyes[1].size_px,
          "the eyes have {}x{} and {}x{} pixels: to make one from the other they must be equal", eyes[0].size_px.x, eyes[0].size_px.y,
          eyes.back().size_px.x, eyes.back().size_px.y);
    const int first = one_eye ? 0 : settings.dominant, second = 1 - first;
    // Whether each eye is culled and ordered by itself.
    const bool apart = one_eye || mode == Mode::kTwoPass || mode == Mode::kAlternate || (mode == Mode::kPaper && settings.per_eye);

    FramePlan plan{.near = settings.near, .background = settings.background, .square_boxes = settings.square_boxes};
    plan.dominant = first;
    plan.eyes = eyes.size();
    for (int e = 0; e < static_cast<int>(eyes.size()); ++e) {
        const bool is_first = e == first;
        plan.targets.push_back({.eye = eyes[e],
                                .role = one_eye    ? Role::kNone
                                        : is_first ? Role::kDominant
                                                   : Role::kAffiliated,
                                .list = apart ? e : 0,
                                .kept = {.depth = is_first ? settings.keep_depth : settings.keep_both_depths,
                                         .moments = is_first && settings.keep_moments,
                                         .half_floats = settings.half_floats,
                                         .past = keeps_past},
                                .picture = e});
    }
    plan.keeps_past = keeps_past;
    if (keeps_past && !has_past) { plan.spare_picture = static_cast<int>(eyes.size()); }
    std::optional<gpu::Place> middle;
    if (settings.order == Order::kDistance) { middle = placeOf(middleOf(eyes)); }
    const auto makeList = [&](const ListPlan& list) {
        plan.steps.push_back({Step::Kind::kList, static_cast<int>(plan.lists.size())});
        plan.lists.push_back(list);
    };
    const auto listOf = [&](int e) {
        makeList({.eyes = {.first = e, .count = 1, .order_eye = e, .list = e, .middle = middle}, .role = plan.targets[e].role});
    };
    const auto render = [&](int e) { plan.steps.push_back({Step::Kind::kRender, e}); };
    const ListPlan both{.eyes = {.first = 0, .count = 2, .order_eye = first, .list = 0, .middle = middle}, .role = Role::kBoth};

    if (mode == Mode::kAlternate) {
        const int full = pasts.turn;
        planAlternate(
            plan, pasts,
            {.eyes = {.first = full, .count = 1, .order_eye = full, .list = full, .middle = middle}, .role = plan.targets[full].role});
        return plan;
    }
    const EyeRelation relation = relate(eyes[first], eyes[one_eye ? first : second]);
    plan.shares_order = !one_eye && (middle || relation.same_depths);
    if (keeps_past && plan.shares_order && eyes[0].size_px == eyes[1].size_px) { plan.shares_ahead = mode == Mode::kTemporal ? 2 : 1; }
    if (mode == Mode::kTemporal && has_past) {
        planTemporal(plan, settings, eyes, pasts, both);
        return plan;
    }

    if (one_eye && settings.half_periphery && settings.gazes[0] && !settings.keep_moments) {
        planPeriphery(plan, *settings.gazes[0], {.eyes = {.middle = middle}});
        return plan;
    }
    if (apart) {
        listOf(first);
    } else {
        makeList(both);
    }
    render(first);
    if (one_eye) { return plan; }

    TargetPlan &source = plan.targets[first], &target = plan.targets[second];
    if (apart) { listOf(second); }
    if (mode == Mode::kTemporal) {  // nothing is there from before, but the other eye is
        makeFromPast(target, Past{source.eye, source.picture}, settings, static_cast<std::size_t>(second));
        plan.budget = settings.stereo.budget;
        plan.steps.push_back({Step::Kind::kPast, second});
        plan.steps.push_back({Step::Kind::kChoose, 0});
    } else if (reprojects(mode)) {
        target.warp = Warp{.source = first,
                           .relation = relation,
                           .settings = stereoSettingsOf(settings),
                           .may_move = may_move,
                           .gaze = settings.gazes[static_cast<std::size_t>(second)]};
        target.choice = may_move ? target.warp->settings.choice : TileChoice::kAll;
        target.keeps_classes = settings.keep_classes;
        source.feeds = second;
        keepForWarp(source.kept, *target.warp);
        plan.steps.push_back({Step::Kind::kWarp, second});
    }
    if (target.choice == TileChoice::kNone) { return plan; }
    if (!apart && !plan.shares_order) { makeList({.eyes = {.order_eye = second, .list = 0}, .role = target.role, .culls = false}); }
    render(second);
    return plan;
}

}  // namespace binosplat
