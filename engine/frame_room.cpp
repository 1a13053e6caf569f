// Room for a frame's pictures and lists: as much as the eyes need, found out by the frame itself.
#include "engine/error.h"
#include "engine/frame.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace binosplat {
namespace {

// Components of holes that get a box of their own: 64 KiB.
constexpr std::uint32_t kHoleBoxes = 4096;
// Room that is made ahead of what was needed.
constexpr double kRoomMade = 1.5;

}  // namespace

void StereoFrame::prepareImages(std::span<const Eye> eyes, const FrameSettings& settings) {
    const auto resize = [&](Buffer& buffer, const char* name, std::uint64_t bytes) {
        if (buffer.bytes() == bytes) { return; }
        buffer = {};
        buffer = Buffer(context_, name, bytes);
    };
    std::uint64_t most_tiles = 0;
    for (int e = 0; e < 2; ++e) {
        const bool used = static_cast<std::size_t>(e) < eyes.size();
        sizes_px_[e] = used ? eyes[e].size_px : glm::uvec2(0);
        const std::uint64_t pixels = std::uint64_t{sizes_px_[e].x} * sizes_px_[e].y;
        const glm::uvec2 tiles = tilesOf(sizes_px_[e]);
        most_tiles = std::max(most_tiles, std::uint64_t{tiles.x} * tiles.y);
        const std::span<const std::uint8_t> hidden = used ? settings.hidden_tiles[e] : std::span<const std::uint8_t>{};
        assert(hidden.empty() || hidden.size() == std::size_t{tiles.x} * tiles.y);
        shown_[e].set(hidden, tiles);
        const bool dominant = used && e == dominant_;
        images_[e].half_floats = settings.half_floats;
        resize(images_[e].colours, "colours", pixels * (settings.half_floats ? sizeof(gpu::uvec2) : sizeof(gpu::vec4)));
        const bool keeps_depth = dominant ? settings.keep_depth : settings.keep_both_depths;
        resize(images_[e].depths, "depths", keeps_depth ? pixels * sizeof(float) : 0);
        if (dominant) { resize(moments_, "inverse depth moments", settings.keep_moments ? pixels * sizeof(gpu::vec2) : 0); }
    }
    resize(buffers_.tile_ranges, "tile ranges", most_tiles * sizeof(gpu::uvec2));
    WarpBufferNeeds needs;
    if (reprojects(settings.mode)) {
        const bool components = settings.mode == Mode::kPaper && settings.stereo.center_rois;
        needs = {sizes_px_[0], settings.keep_classes || components, settings.half_floats, components ? kHoleBoxes : 0};
    }
    if (stereo_buffers_.needs() != needs) {
        stereo_buffers_ = {};
        stereo_buffers_ = WarpBuffers(context_, needs);
    }
}

std::uint32_t StereoFrame::mostLentPairs() const {
    if (!reprojects(mode_)) { return 0; }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(images_[1 - dominant_].colours.bytes() / sizeof(gpu::uint), UINT32_MAX));
}

FrameCapacity StereoFrame::lendWhatFits(FrameCapacity capacity) const {
    capacity.lent_pairs = std::min(capacity.lent_pairs, mostLentPairs());
    capacity.lent_words = capacity.lent_pairs == 0 ? 0 : std::min(mostLentPairs() / capacity.lent_pairs, PairBuffers::kMostLentWords);
    return capacity;
}

void StereoFrame::prepareLists() {
    FrameCapacity capacity = buffers_.capacity();
    if (capacity == FrameCapacity{}) {
        capacity = {std::min(first_capacity_.visible, std::max(scene_->splatCount(), 1u)), first_capacity_.pairs, 0, 0};
        if (reprojects(mode_)) {
            // What is rendered again has far fewer pairs.
            capacity.lent_pairs = capacity.pairs;
            capacity.pairs = (capacity.pairs + 3) / 4;
        }
    }
    growFrameBuffers(context_, buffers_, lendWhatFits(capacity));
}

bool StereoFrame::dominantIsVoid() const {
    const gpu::ListState& visible = state_.visible[listOf(dominant_)];
    return visible.needed != visible.count || state_.pairs[dominant_].needed != state_.pairs[dominant_].count;
}

double StereoFrame::spareFor(double ahead) const {
    // Just enough the first time, since a single picture needs no more; with room to spare once the view moves.
    return ahead > 1.0 ? kRoomMade : first_frame_ ? 1.0 : 1.25;
}

FrameCapacity StereoFrame::roomFor(double ahead, double spare) const {
    const auto enough = [&](std::uint32_t needed, std::uint32_t capacity) {
        if (ahead * needed <= capacity) { return capacity; }
        const double roomy = std::min(std::ceil(needed * spare / 1024.0) * 1024.0, 2147482624.0);
        return std::max(needed, static_cast<std::uint32_t>(roomy));
    };
    const FrameCapacity now = buffers_.capacity();
    FrameCapacity wanted = now;
    for (int e = 0; e < 2; ++e) {
        const std::uint32_t visible = state_.visible[e].needed, pairs = state_.pairs[e].needed;
        check(pairs != UINT32_MAX, "an eye sees more than {} pairs of tile and splat, fewer splats or pixels are needed", gpu::kMaxItems);
        wanted.visible = std::max(wanted.visible, std::min(enough(visible, now.visible), std::max(scene_->splatCount(), 1u)));
        const bool lends = e == dominant_ && pairs <= mostLentPairs();
        // Without the dominant eye's pairs every tile seems cheap to render: how many the other eye needs shows in the next try.
        if (e != dominant_ && reprojects(mode_) && dominantIsVoid()) { continue; }
        if (!lends) {
            wanted.pairs = std::max(wanted.pairs, enough(pairs, now.pairs));
        } else if (pairs > now.pairs) {
            wanted.lent_pairs = enough(pairs, now.lent_pairs);
        }
    }
    return lendWhatFits(wanted);
}

bool StereoFrame::growIfNeeded() {
    const FrameCapacity wanted = roomFor(1.0, spareFor(1.0));
    if (wanted == buffers_.capacity()) {
        first_frame_ = false;
        return true;
    }
    growFrameBuffers(context_, buffers_, wanted);
    return false;
}

bool StereoFrame::tryToGrow(const FrameCapacity& wanted) {
    const FrameCapacity before = buffers_.capacity();
    try {
        growFrameBuffers(context_, buffers_, wanted);
        return true;
    } catch (const Error&) {
        growFrameBuffers(context_, buffers_, before);
        return false;
    }
}

bool StereoFrame::growIfItFits() {
    for (const double spare : {spareFor(1.0), 1.0}) {
        const FrameCapacity wanted = roomFor(1.0, spare);
        if (wanted == buffers_.capacity()) { return false; }
        if (tryToGrow(wanted)) { return true; }
    }
    return false;
}

void StereoFrame::makeRoomForPatches() {
    // Of the other eye's work: all, or the share that is cheap to render and the budget.
    const double share = may_move_ ? 0.5 : 1.0;
    FrameCapacity wanted = buffers_.capacity();
    wanted.pairs = std::max(wanted.pairs, static_cast<std::uint32_t>(share * std::min(state_.pairs[dominant_].needed, gpu::kMaxItems)));
    if (wanted != buffers_.capacity()) { tryToGrow(lendWhatFits(wanted)); }
}

bool StereoFrame::isCutShort() const {
    const auto isEmptied = [](const gpu::ListState& list) { return list.needed != list.count; };
    return std::ranges::any_of(state_.visible, isEmptied) || std::ranges::any_of(state_.pairs, isEmptied);
}

void StereoFrame::makeRoomAhead() {
    if (!room_ahead_fits_ || hasRoom(kRoomAhead)) { return; }
    // It goes without, as long as the lists themselves fit.
    room_ahead_fits_ = tryToGrow(roomFor(kRoomAhead, spareFor(kRoomAhead)));
}

}  // namespace binosplat
