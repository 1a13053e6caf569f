// Successive frames: what each prepares, when it is waited for, and when it is rendered once more.
#include "engine/frame/stereo_frame.h"

#include "engine/frame/changes.h"
#include "engine/frame/report.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat {
namespace {

// Where the scene changed, tiles are rendered on top of the budget, and this share of the budget is left for
// the others: as many in these parts of the picture as elsewhere, and a few more. If more than the last
// figure changed, lists that were made for whole pictures may be too short for the patches of both.
constexpr double kBudgetBesideChanges = 0.5, kMoreWhereChanged = 1.2, kMostChanged = 0.4;
// If more than this share of a picture's tiles come into view, or if some are newly hidden, its lists may
// change a lot.
constexpr double kMostHiddenDiffer = 0.1;

// The traits that a history must share with a frame.
FrameShape askedApartFromSizes(const FrameSettings& settings) { return shapeOf({}, settings); }

}  // namespace

StereoFrame::StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options)
    : StereoFrame(context, scene, options, nullptr) {}

StereoFrame::StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options,
                         PassKernels* others)
    : context_(context),
      own_kernels_(others == nullptr ? std::make_unique<PassKernels>(context, options.threads_per_cell)
                                     : nullptr),
      kernels_(others == nullptr ? *own_kernels_ : *others),
      memory_(context, options.first_capacity,
              [this] {
                  for (const Flight& flight : flights_) {
                      static_cast<void>(flight.commands.isDone(UINT64_MAX));
                  }
              }),
      flights_{Flight(context), Flight(context)} {
    show(scene);
}

StereoFrame::~StereoFrame() = default;

std::unique_ptr<StereoFrame> StereoFrame::beside(StereoFrame& other) {
    return std::unique_ptr<StereoFrame>(new StereoFrame(other.context_, *other.scene_, {}, &other.kernels_));
}

void StereoFrame::show(const GpuScene& scene) {
    finish();
    memory_.show(scene);
    scene_ = &scene;
    moving_pays_.forget();
    history_pays_.forget();
    histories_ = {};
    changes_known_ = scene.changesRecorded();
    cut_short_ = done_again_ = 0;
}

void StereoFrame::goOnWith(const GpuScene& scene) {
    scene_ = &scene;
    memory_.goOnWith(scene);
    histories_ = {};
    changes_known_ = scene.changesRecorded();
    cut_short_ = done_again_ = 0;
}

void StereoFrame::reserveForChanges(std::uint64_t bytes) {
    for (Flight& flight : flights_) { flight.commands.reserveStaging(bytes); }
}

void StereoFrame::rebuildKernels() {
    finish();
    kernels_.rebuild();
}

void StereoFrame::makeKernels(std::span<const Eye> eyes, const FrameSettings& settings) {
    finish();
    histories_ = {};
    prepare(eyes, settings);
    Commands& commands = flight().commands;
    // They may find that warping does not pay.
    if (choiceOf(settings.mode) == TileChoice::kPredicted || settings.mode == Mode::kTemporal) {
        recorder(true).record(commands, planFrame(settings, eyes, false, scene_->splatCount()));
        commands.drop();
    }
    recorder(true).record(commands, planFrame(settings, eyes, true, scene_->splatCount()));
    commands.drop();
    if (hasHistory(settings.mode) && settings.keep_history) {
        const FramePlan next =
            planFrame(settings, eyes, true, scene_->splatCount(), historiesAfter(plan_, {}));
        memory_.fitPictures(next, settings.hidden_tiles);
        recorder(true).record(commands, next);
        commands.drop();
    }
    // Nothing is known about earlier frames any more.
    moving_pays_.forget();
    history_pays_.forget();
    memory_.forgetFrames();
}

FrameResult StereoFrame::render(std::span<const Eye> eyes, const FrameSettings& settings,
                                const Append& append) {
    finish();
    prepare(eyes, settings);
    renderUntilComplete(settings, append);
    FrameResult result = take(flight());
    // With a bound, frames decide what lists have capacity for.
    if (plan_.error_bound_db > 0.0) { memory_.growAhead(plan_, state_); }
    return result;
}

void StereoFrame::reserve(std::span<const Eye> eyes, const FrameSettings& settings) {
    if (shapeOf(eyes, settings) == shape_) { return; }
    histories_ = historiesFor(eyes, settings);
    FramePlan plan = planFrame(settings, eyes, true, scene_->splatCount(), histories_);
    finish();
    shape_ = {};  // some pictures are new, and some may fail
    plan_ = std::move(plan);
    const Histories histories = std::exchange(histories_, {});
    memory_.fitPictures(plan_, settings.hidden_tiles);
    histories_ = histories;
}

std::optional<FrameResult> StereoFrame::renderAhead(std::span<const Eye> eyes, const FrameSettings& settings,
                                                    const Append& append, vk::Semaphore signals) {
    Flight &before_last = flight(), &last = flights_[1 - turn_];
    std::optional<FrameResult> result = land(before_last);
    memory_.bringLonger();
    // Lists have capacity for patches while there is a history, and for whole pictures after it.
    const bool has_history = histories_.of_eyes[0] && settings.keep_history;
    const bool was_warped = std::ranges::any_of(
        plan_.targets, [](const TargetPlan& target) { return target.history.has_value(); });
    const bool loses_history = has_history && (!historiesFor(eyes, settings).of_eyes[0] ||
                                               (was_warped && changedShare(eyes, settings) > kMostChanged));
    const Likeness likeness = likenessToLast(eyes, settings);
    const bool jumps = loses_history || likeness == Likeness::kJumps;
    const bool grows_beside = !settings.waits_for_lists && memory_.growsBeside();
    bool waits = memory_.isFirstFrame() || likeness == Likeness::kOther ||
                 (jumps && settings.waits_for_lists) || (FrameMemory::isCutShort(state_) && !grows_beside);
    // Lists fill up gradually: they are made longer before they are full, while nothing uses them.
    const bool is_short = result && !grows_beside && memory_.fitsAhead() &&
                          !memory_.hasCapacity(plan_, stateAhead(), kCapacityAhead);
    if (result && grows_beside) { memory_.growBeside(plan_, stateAhead()); }
    if (waits || is_short) {
        if (auto newer = land(last)) { result = std::move(newer); }
        waits = waits || (FrameMemory::isCutShort(state_) && !grows_beside);
        if (is_short) { memory_.growAhead(plan_, stateAhead()); }
    }
    prepare(eyes, settings);
    if (!waits) {
        record(flight(), settings, append);
        flight().commands.submit(signals);
        turn_ = 1 - turn_;
        return result;
    }
    growForVisible();
    done_again_ += renderAtMostTwice(settings, append);
    if (FrameMemory::isCutShort(state_)) {
        ++cut_short_;
        histories_ = {};
    }
    result = take(flight());
    result->counters.ahead = {cut_short_, done_again_};
    memory_.growAhead(plan_, state_);
    if (signals) {
        const std::lock_guard lock(context_.queueMutex());
        context_.queue().submit(vk::SubmitInfo({}, {}, {}, signals));
    }
    return result;
}

void StereoFrame::passOver() {
    static_cast<void>(land(flight()));
    turn_ = 1 - turn_;
}

std::optional<FrameResult> StereoFrame::finish() {
    std::optional<FrameResult> older = land(flights_[turn_]), newer = land(flights_[1 - turn_]);
    memory_.finishLonger();
    return newer ? std::move(newer) : std::move(older);
}

std::optional<FrameResult> StereoFrame::land(Flight& flight) {
    if (!flight.commands.isUnderWay()) { return std::nullopt; }
    flight.commands.wait();
    state_ = flight.readback.mapped<FrameState>()[0];
    splats_known_ = flight.splats_held;
    if (FrameMemory::isCutShort(state_)) {
        ++cut_short_;
        // A tile that did not fit keeps what was made from a history or another picture; a picture made from
        // neither has nothing else.
        const auto isMade = [](const TargetPlan& target) {
            return target.history.has_value() || target.warp.has_value();
        };
        if (!std::ranges::all_of(flight.plan.targets, isMade)) { histories_ = {}; }
    }
    FrameResult result = take(flight);
    result.counters.ahead = {cut_short_, done_again_};
    return result;
}

FrameResult StereoFrame::take(const Flight& flight) {
    if (const std::optional<int> warped = flight.plan.warpedTarget()) {
        const gpu::WarpCounters& counters = state_.targets[static_cast<std::size_t>(*warped)].warp_counters;
        moving_pays_.learn(flight.asked, counters.pays != 0);
    }
    FrameResult result =
        reportFrame({context_, *scene_, memory_, flight.plan, state_, flight.commands}, flight.settings.mark);
    if (FrameMemory::isCutShort(state_)) {
        history_pays_.forget();
    } else if (flight.settings.mode == Mode::kTemporal && flight.plan.keeps_history) {
        learnWhetherHistoryPays(flight.asked, result.counters);
    }
    return result;
}

void StereoFrame::renderUntilComplete(const FrameSettings& settings, const Append& append) {
    for (;;) {
        renderOnce(settings, append);
        if (memory_.growIfNeeded(plan_, state_)) { return; }
        planAnew(settings);
    }
}

std::uint64_t StereoFrame::renderAtMostTwice(const FrameSettings& settings, const Append& append) {
    renderOnce(settings, append);
    const std::optional<int> warped = plan_.warpedTarget();
    const bool guesses = warped &&
                         plan_.targets[static_cast<std::size_t>(*warped)].choice != TileChoice::kNone &&
                         FrameMemory::isSourceVoid(plan_, state_);
    if (!memory_.growIfItFits(plan_, state_)) {
        memory_.haveFrame();
        return 0;
    }
    if (guesses) { memory_.growForChosen(plan_, state_); }
    planAnew(settings);
    renderOnce(settings, append);
    // Lists that are still too short grow the next time.
    if (!memory_.growIfItFits(plan_, state_)) { memory_.haveFrame(); }
    return 1;
}

void StereoFrame::renderOnce(const FrameSettings& settings, const Append& append) {
    record(flight(), settings, append);
    flight().commands.submitAndWait();
    state_ = flight().readback.mapped<FrameState>()[0];
    splats_known_ = flight().splats_held;
}

Histories StereoFrame::historiesFor(std::span<const Eye> eyes, const FrameSettings& settings) const {
    if (!settings.keep_history || eyes.size() != 2 || !histories_.of_eyes[0] || !histories_.of_eyes[1] ||
        askedApartFromSizes(settings) != history_shape_ || !scene_->changesSince(changes_known_)) {
        return {};
    }
    const double farthest = farthestHistory(eyes, settings.units_per_metre);
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        // This eye is rendered anyway.
        if (settings.mode == Mode::kAlternate && static_cast<int>(e) == histories_.turn) { continue; }
        if (!canComeFrom(histories_.of_eyes[e]->eye, eyes[e], farthest)) { return {}; }
    }
    return histories_;
}

double StereoFrame::changedShare(std::span<const Eye> eyes, const FrameSettings& settings) const {
    if (settings.mode != Mode::kTemporal || eyes.size() != 2) { return 0.0; }
    std::vector<SceneChange> changes(scene_->changesNoted().begin(), scene_->changesNoted().end());
    if (const auto recorded = scene_->changesSince(changes_known_)) {
        changes.insert(changes.end(), recorded->begin(), recorded->end());
    }
    return 0.5 * (binosplat::changedShare(changes, eyes[0], settings.near) +
                  binosplat::changedShare(changes, eyes[1], settings.near));
}

void StereoFrame::planAnew(const FrameSettings& settings) {
    if (std::ranges::none_of(plan_.targets,
                             [](const TargetPlan& target) { return target.history.has_value(); })) {
        return;
    }
    // The memory that the history was made from is overwritten already.
    plan_ = planFrame(settings, eyes_, true, scene_->splatCount());
    memory_.fitPictures(plan_, settings.hidden_tiles);
}

StereoFrame::Likeness StereoFrame::likenessToLast(std::span<const Eye> eyes,
                                                  const FrameSettings& settings) const {
    if (shapeOf(eyes, settings) != shape_) { return Likeness::kOther; }
    bool jumps = binosplat::jumps(eyes_, eyes, settings.units_per_metre);
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        // Another size, for which there is memory.
        if (plan_.targets[e].eye.size_px != eyes[e].size_px) {
            jumps = true;
            continue;
        }
        if (plan_.targets[e].is_masked == settings.hidden_tiles[e].empty()) { return Likeness::kOther; }
        const double before = plan_.targets[e].tiles_hidden, now = countHidden(settings.hidden_tiles[e]);
        const glm::uvec2 tiles = tilesOf(eyes[e].size_px);
        // A view that turns over its picture shows another row and another column.
        const double most =
            std::max(kMostHiddenDiffer * tiles.x * tiles.y, static_cast<double>(tiles.x + tiles.y));
        jumps = jumps || std::abs(now - before) > most;
    }
    return jumps ? Likeness::kJumps : Likeness::kAlike;
}

void StereoFrame::prepare(std::span<const Eye> eyes, const FrameSettings& settings) {
    const MovingPays::Asked asked = MovingPays::askedBy(eyes, settings);
    if (settings.mode == Mode::kTemporal) { history_pays_.ask(asked); }
    const bool may_move = moving_pays_.mayMove(asked), in_full = rendersInFull(eyes, settings);
    const double changed = changedShare(eyes, settings);
    plan_ = planFrame(settings, eyes, may_move && !in_full, scene_->splatCount(),
                      changed > kMostChanged ? Histories() : historiesFor(eyes, settings));
    if (changed <= kMostChanged) {
        plan_.budget = std::min(
            std::max(plan_.budget, kMoreWhereChanged * changed + kBudgetBesideChanges * plan_.budget), 1.0);
    }
    memory_.fitPictures(plan_, settings.hidden_tiles);
    memory_.fitLists();
    moving_pays_.ask(asked, may_move);
    shape_ = shapeOf(eyes, settings);
    eyes_.assign(eyes.begin(), eyes.end());
}

void StereoFrame::record(Flight& flight, const FrameSettings& settings, const Append& append) {
    flight.plan = plan_;
    flight.settings = settings;
    flight.settings.hidden_tiles = {};
    flight.settings.before = {};
    flight.asked = moving_pays_.asked();
    recorder().record(flight.commands, plan_, settings.times_passes, settings.before);
    changes_known_ = scene_->changesRecorded();
    recorder().recordReport(flight.commands, flight.readback);
    histories_ = historiesAfter(plan_, historiesFor(eyes_, settings));
    history_shape_ = askedApartFromSizes(settings);
    flight.splats_held = scene_->splatsHeld();
    if (append) { append(flight.commands); }
}

}  // namespace binosplat
