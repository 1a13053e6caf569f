// Pictures and lists grow to what frames need.
#include "engine/frame/capacity.h"

#include "engine/error.h"
#include "engine/frame/changes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <utility>

namespace binosplat {
namespace {

// Components of holes that get a box of their own: 64 KiB.
constexpr std::uint32_t kHoleBoxes = 4096;
// Capacity beyond what was needed.
constexpr double kCapacityMade = 1.5;

bool isEmptied(const gpu::ListState& list) { return list.needed != list.count; }

std::uint64_t colourBytes(glm::uvec2 size_px, const Kept& kept) {
    return std::uint64_t{size_px.x} * size_px.y * (kept.half_floats ? sizeof(gpu::uvec2) : sizeof(gpu::vec4));
}

WarpBufferNeeds needsOf(const TargetPlan& target) {
    if (target.history || target.from_history_later) {
        return {.memory_px = target.memory_px,
                .classes = false,
                .half_floats = target.kept.half_floats,
                .history = true,
                .boxes = 0};
    }
    if (!target.warp) { return {}; }
    const bool components =
        target.warp->settings.choice == TileChoice::kPaper && target.warp->settings.center_rois;
    return {.memory_px = target.memory_px,
            .classes = target.keeps_classes || components,
            .half_floats = target.kept.half_floats,
            .history = false,
            .boxes = components ? kHoleBoxes : 0};
}

}  // namespace

FrameMemory::FrameMemory(const Context& context, const FrameCapacity& first_capacity,
                         std::function<void()> wait_for_frames)
    : context_(context),
      first_capacity_(first_capacity),
      wait_for_frames_(std::move(wait_for_frames)),
      longer_(context) {
    shown_.reserve(kMostTargets);
    while (shown_.size() < kMostTargets) { shown_.emplace_back(context); }
}

void FrameMemory::show(const GpuScene& scene) {
    longer_.drop();
    lists_ = makeFrameBuffers(context_, scene.splatCount(), scene.isInPages());
    scene_ = &scene;
    first_frame_ = fits_ahead_ = fits_beside_ = true;
}

void FrameMemory::resize(Buffer& buffer, const char* name, std::uint64_t bytes,
                         std::optional<std::uint64_t> used) {
    if (buffer.madeBytes() != bytes) {
        if (buffer.madeBytes() > 0) { wait_for_frames_(); }
        buffer = {};
        buffer = Buffer(context_, name, bytes);
    }
    buffer.use(used.value_or(bytes));
}

void FrameMemory::growLists(const FrameCapacity& capacity) {
    if (capacity == lists_.capacity()) { return; }
    wait_for_frames_();
    longer_.drop();
    growFrameBuffers(context_, lists_, capacity);
}

const Buffer& FrameMemory::changedRects() {
    resize(changed_rects_, "changed parts", kMostTargets * kMostChanges * sizeof(gpu::ChangedRect));
    return changed_rects_;
}

void FrameMemory::recordShown(Commands& commands) {
    for (ShownTiles& shown : shown_) { shown.record(commands); }
}

void FrameMemory::fitWarps(const FramePlan& plan) {
    std::array<WarpBufferNeeds, kMostTargets> needs;
    for (std::size_t t = 0; t < needs.size() && t < plan.targets.size(); ++t) {
        needs[t] = needsOf(plan.targets[t]);
    }
    // If eyes have changed their roles, one's buffers serve the other; buffers that are no longer needed are
    // freed before anything is made.
    for (std::size_t t = 0; t < needs.size(); ++t) {
        for (std::size_t other = 0; other < needs.size() && warps_[t].needs() != needs[t]; ++other) {
            if (warps_[other].needs() == needs[t] && needs[other] != needs[t]) {
                std::swap(warps_[t], warps_[other]);
            }
        }
    }
    for (std::size_t t = 0; t < needs.size(); ++t) {
        if (warps_[t].needs() == needs[t]) { continue; }
        if (warps_[t].bytes() > 0) { wait_for_frames_(); }
        warps_[t] = {};
    }
    for (std::size_t t = 0; t < needs.size(); ++t) {
        if (warps_[t].needs() != needs[t]) { warps_[t] = WarpBuffers(context_, needs[t]); }
        if (needs[t].memory_px.x > 0) { warps_[t].use(plan.targets[t].eye.size_px); }
    }
}

void FrameMemory::joinColours(const FramePlan& plan) {
    std::uint64_t bytes = 0, apart = 0;
    if (plan.isSortedInBothPictures()) {
        bytes = colourBytes(plan.targets[0].memory_px, plan.targets[0].kept);
        if (alignment_ == 0) { alignment_ = Buffer::alignmentOf(context_); }
        apart = (bytes + alignment_ - 1) / alignment_ * alignment_;
        if (apart + bytes > context_.maxAllocationBytes()) { bytes = apart = 0; }
    }
    if (both_colours_.bytes() == apart + bytes) { return; }
    wait_for_frames_();
    for (std::size_t e = 0; e < kMostTargets; ++e) { pictures_[e].colours = {}; }
    both_colours_ = {};
    if (bytes == 0) { return; }
    both_colours_ = Buffer(context_, "colours of both eyes", apart + bytes);
    for (std::size_t e = 0; e < kMostTargets; ++e) {
        pictures_[e].colours = Buffer(context_, "colours", bytes, both_colours_, e * apart);
    }
}

EmptyPictures FrameMemory::emptyPictures(const FramePlan& plan, const TargetPlan& target) const {
    if (!plan.isSortedInPicture(target)) { return {}; }
    const Buffer& memory = plan.isSortedInBothPictures() ? both_colours_ : picture(target.picture).colours;
    return {memory.address<gpu::uint>(), memory.madeBytes()};
}

void FrameMemory::fitPicture(Picture& picture, glm::uvec2 size_px, glm::uvec2 memory_px, const Kept& kept) {
    const auto pixels = [](glm::uvec2 size) { return std::uint64_t{size.x} * size.y; };
    const auto fit = [&](Buffer& buffer, const char* name, bool is_kept, const auto& bytesOf) {
        resize(buffer, name, is_kept ? bytesOf(memory_px) : 0, is_kept ? bytesOf(size_px) : 0);
    };
    picture.size_px = size_px;
    picture.half_floats = kept.half_floats;
    picture.of_surface = kept.depth && kept.surface;
    fit(picture.colours, "colours", true, [&](glm::uvec2 size) { return colourBytes(size, kept); });
    fit(picture.depths, "depths", kept.depth && !kept.history,
        [&](glm::uvec2 size) { return pixels(size) * sizeof(float); });
    fit(picture.words, "depths of the history", kept.history,
        [&](glm::uvec2 size) { return pixels(size) * sizeof(gpu::uint); });
    fit(picture.tiles, "tiles of the history", kept.history,
        [&](glm::uvec2 size) { return pixels(tilesOf(size)) * sizeof(gpu::HistoryTile); });
}

void FrameMemory::fitPictures(const FramePlan& plan,
                              const std::array<std::span<const std::uint8_t>, 2>& hidden_tiles) {
    std::uint64_t most_tiles = 0, moments_bytes = 0, moments_used = 0;
    std::array<bool, kFramePictures> is_used{};
    for (std::size_t t = 0; t < shown_.size(); ++t) {
        const bool used = t < plan.targets.size();
        const glm::uvec2 size_px = used ? plan.targets[t].eye.size_px : glm::uvec2(0),
                         memory_px = used ? plan.targets[t].memory_px : glm::uvec2(0),
                         tiles = tilesOf(size_px), memory_tiles = tilesOf(memory_px);
        most_tiles = std::max(most_tiles, std::uint64_t{memory_tiles.x} * memory_tiles.y);
        const auto hidden = used && t < plan.eyes ? hidden_tiles[t] : std::span<const std::uint8_t>{};
        assert(hidden.empty() || hidden.size() == std::size_t{tiles.x} * tiles.y);
        shown_[t].set(hidden, tiles, memory_tiles);
        if (!used) { continue; }
        if (plan.targets[t].kept.moments) {
            moments_bytes = std::uint64_t{memory_px.x} * memory_px.y * sizeof(gpu::vec2);
            moments_used = std::uint64_t{size_px.x} * size_px.y * sizeof(gpu::vec2);
        }
        is_used[static_cast<std::size_t>(plan.targets[t].picture)] = true;
        // A history stays as it is.
        if (plan.targets[t].history) {
            is_used[static_cast<std::size_t>(plan.targets[t].history->picture)] = true;
        }
    }
    if (plan.spare_picture) { is_used[static_cast<std::size_t>(*plan.spare_picture)] = true; }
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
        if (!is_used[p]) { fitPicture(pictures_[p], {0, 0}, {0, 0}, {}); }
    }
    joinColours(plan);
    // The histories of both eyes have memory for what either leaves, since they change places.
    bool coarse = false;
    for (const TargetPlan& target : plan.targets) {
        coarse = coarse || target.coarse;
        Kept kept = target.kept;
        kept.history = kept.history || plan.keeps_history;
        if (plan.spare_picture) {
            fitPicture(pictures_[static_cast<std::size_t>(*plan.spare_picture)], target.eye.size_px,
                       target.memory_px, kept);
        }
        fitPicture(pictures_[static_cast<std::size_t>(target.picture)], target.eye.size_px, target.memory_px,
                   kept);
    }
    resize(moments_, "inverse depth moments", moments_bytes, moments_used);
    if (plan.keeps_history && scene_->isInPages()) { (void)changedRects(); }
    const auto at_once = static_cast<std::uint64_t>(std::max(plan.at_once, plan.at_once_ahead));
    resize(lists_.tile_ranges, "tile ranges",
           most_tiles * std::max(at_once * sizeof(gpu::uvec2), coarse ? sizeof(gpu::uvec3) : 0));
    fitWarps(plan);
}

void FrameMemory::fitLists() {
    const FrameCapacity first{std::min(first_capacity_.visible, std::max(scene_->splatCount(), 1u)),
                              first_capacity_.pairs};
    if (lists_.capacity() == FrameCapacity{}) { growLists(first); }
}

bool FrameMemory::isCutShort(const FrameState& state) {
    return std::ranges::any_of(state.visible, isEmptied) ||
           std::ranges::any_of(state.targets,
                               [](const TargetState& target) { return isEmptied(target.pairs); });
}

bool FrameMemory::isSourceVoid(const FramePlan& plan, const FrameState& state) {
    const auto source = static_cast<std::size_t>(plan.firstTarget());
    return isEmptied(state.visible[static_cast<std::size_t>(plan.targets[source].list)]) ||
           isEmptied(state.targets[source].pairs);
}

double FrameMemory::spareFor(double ahead) const {
    // Just enough the first time, since a single picture needs no more; with some to spare once the view
    // moves.
    return ahead > 1.0 ? kCapacityMade : first_frame_ ? 1.0 : 1.25;
}

std::uint32_t FrameMemory::capacityForSplats(const FramePlan& plan, std::uint32_t splats) const {
    return std::max(
        VisibleBuffers::capacityFor(splats, plan.at_once, emptyPictures(plan, plan.targets[0]).bytes),
        VisibleBuffers::capacityFor(splats, plan.at_once_ahead, 0));
}

std::uint32_t FrameMemory::capacityForPairs(const FramePlan& plan, const TargetPlan& target,
                                            std::uint32_t pairs, std::uint32_t visible, bool is_ahead) const {
    const std::uint64_t empty_bytes = emptyPictures(plan, target).bytes;
    // In the next frame tiles may be numbered through more pictures, and pairs take more words.
    const auto more = static_cast<gpu::uint>(std::max(plan.at_once_ahead / plan.at_once, 1));
    const PairFormat format(
        more * plan.tilesWith(target),
        std::min(VisibleBuffers::splatsIn(visible, plan.at_once, empty_bytes), scene_->splatCount()));
    // Once moving pays again, patches are sorted in the lists alone.
    return PairBuffers::capacityFor(format, pairs, is_ahead && target.warp ? 0 : empty_bytes);
}

FrameCapacity FrameMemory::capacityFor(const FramePlan& plan, const FrameState& state, double ahead,
                                       double spare) const {
    // `capacityOf`: the memory for this many; it need not be proportional.
    const auto enough = [&](std::uint32_t needed, std::uint32_t capacity, const auto& capacityOf) {
        const auto times = [&](double factor, double step) {
            return static_cast<std::uint32_t>(
                std::min(std::ceil(needed * factor / step) * step, 2147482624.0));
        };
        return capacityOf(std::max(needed, times(ahead, 1.0))) <= capacity
                   ? capacity
                   : capacityOf(std::max(needed, times(spare, 1024.0)));
    };
    const FrameCapacity now = lists_.capacity();
    FrameCapacity wanted = now;
    // Of the next frame, too, whose pictures meet no more splats than these.
    const auto capacityOfSplats = [&](std::uint32_t of) {
        return capacityForSplats(plan, std::min(of, std::max(scene_->splatCount(), 1u)));
    };
    for (const gpu::ListState& visible : state.visible) {
        wanted.visible = std::max(wanted.visible, enough(visible.needed, now.visible, capacityOfSplats));
    }
    for (std::size_t t = 0; t < plan.targets.size(); ++t) {
        const std::uint32_t pairs = state.targets[t].pairs.needed;
        check(pairs != UINT32_MAX,
              "an eye sees more than {} pairs of tile and splat, fewer splats or pixels are needed",
              gpu::kMaxItems);
        // Without the source's pairs every tile seems cheap to render; how many the target needs is found on
        // the next try.
        if (plan.targets[t].warp && isSourceVoid(plan, state)) { continue; }
        const auto capacityOf = [&](std::uint32_t of) {
            return capacityForPairs(plan, plan.targets[t], of, wanted.visible, ahead > 1.0);
        };
        wanted.pairs = std::max(wanted.pairs, enough(pairs, now.pairs, capacityOf));
    }
    return wanted;
}

bool FrameMemory::hasCapacity(const FramePlan& plan, const FrameState& state, double ahead) const {
    return capacityFor(plan, state, ahead, spareFor(ahead)) == lists_.capacity();
}

bool FrameMemory::growIfNeeded(const FramePlan& plan, const FrameState& state) {
    const FrameCapacity wanted = capacityFor(plan, state, 1.0, spareFor(1.0));
    if (wanted == lists_.capacity()) {
        first_frame_ = false;
        return true;
    }
    growLists(wanted);
    return false;
}

bool FrameMemory::tryToGrow(const FrameCapacity& wanted) {
    const FrameCapacity before = lists_.capacity();
    try {
        growLists(wanted);
        return true;
    } catch (const Error&) {
        growLists(before);
        return false;
    }
}

bool FrameMemory::growIfItFits(const FramePlan& plan, const FrameState& state) {
    for (const double spare : {spareFor(1.0), 1.0}) {
        const FrameCapacity wanted = capacityFor(plan, state, 1.0, spare);
        if (wanted == lists_.capacity()) { return false; }
        if (tryToGrow(wanted)) { return true; }
    }
    return false;
}

void FrameMemory::growForChosen(const FramePlan& plan, const FrameState& state) {
    // Of the target's work: all of it, or the share that is cheap to render plus the budget.
    const TargetPlan& target = plan.targets[static_cast<std::size_t>(plan.warpedTarget().value())];
    const std::uint32_t all =
        std::min(state.targets[static_cast<std::size_t>(plan.firstTarget())].pairs.needed, gpu::kMaxItems);
    FrameCapacity wanted = lists_.capacity();
    wanted.pairs = std::max(
        wanted.pairs,
        capacityForPairs(plan, target, target.warp->may_move ? all / 2 : all, wanted.visible, false));
    if (wanted != lists_.capacity()) { tryToGrow(wanted); }
}

void FrameMemory::growAhead(const FramePlan& plan, const FrameState& state) {
    if (!fits_ahead_ || hasCapacity(plan, state, kCapacityAhead)) { return; }
    fits_ahead_ = tryToGrow(capacityFor(plan, state, kCapacityAhead, spareFor(kCapacityAhead)));
}

void FrameMemory::growBeside(const FramePlan& plan, const FrameState& state) {
    if (longer_.isUnderWay()) { return; }
    std::vector<FrameCapacity> wanted;
    are_ahead_.clear();
    const auto want = [&](double ahead, double spare) {
        const FrameCapacity capacity = capacityFor(plan, state, ahead, spare);
        if (capacity == lists_.capacity()) { return; }
        wanted.push_back(capacity);
        are_ahead_.push_back(ahead > 1.0);
    };
    if (fits_ahead_) { want(kCapacityAhead, spareFor(kCapacityAhead)); }
    if (isCutShort(state)) {
        want(1.0, spareFor(1.0));
        want(1.0, 1.0);
    }
    if (!wanted.empty()) { longer_.begin(lists_.capacity(), std::move(wanted)); }
}

void FrameMemory::learnWhichFitted(std::optional<std::size_t> which) {
    if (!which) { return; }
    fits_beside_ = *which < are_ahead_.size();
    if (fits_beside_) { fits_ahead_ = are_ahead_[*which]; }
}

void FrameMemory::bringLonger() { learnWhichFitted(longer_.bring(lists_)); }

void FrameMemory::finishLonger() { learnWhichFitted(longer_.finish(lists_)); }

}  // namespace binosplat
