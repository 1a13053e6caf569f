// Allocating a frame's buffers.
#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace binosplat {

VisibleBuffers::VisibleBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "visible splats", kBytesPerSplat * capacity) {}

PairBuffers::PairBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "tile pairs", kBytesPerPair * capacity) {}

std::uint32_t PairBuffers::capacityBeside(const Buffer& colours, std::uint32_t pairs) {
    const std::uint64_t there = colours.bytes() / sizeof(gpu::uint);
    const std::uint64_t words_here =
        4 - std::min<std::uint64_t>(there / std::max(pairs, 1u), kMostWordsBeside);
    return static_cast<std::uint32_t>((words_here * pairs + 3) / 4);
}

PairArrays PairBuffers::arrays() const {
    const auto array = [&](std::uint64_t i) {
        return buffer_.address<gpu::uint>(i * capacity_ * sizeof(gpu::uint));
    };
    return {{array(0), array(1)}, {array(2), array(3)}, capacity_};
}

PairArrays PairBuffers::arraysBeside(const Buffer& colours, unsigned key_bits) const {
    const std::uint64_t here = 4 * std::uint64_t{capacity_}, there = colours.bytes() / sizeof(gpu::uint);
    std::uint64_t most = capacity_, words_here = 4;
    for (std::uint64_t beside = 1; beside <= kMostWordsBeside; ++beside) {
        const std::uint64_t fit = std::min(here / (4 - beside), there / beside);
        if (fit > most) { std::tie(most, words_here) = std::pair(fit, 4 - beside); }
    }
    PairArrays arrays{{}, {}, static_cast<std::uint32_t>(std::min<std::uint64_t>(most, gpu::kMaxItems))};
    KeyValues &last = Sort::endsInSpare(key_bits) ? arrays.spare : arrays.pairs,
              &other = Sort::endsInSpare(key_bits) ? arrays.pairs : arrays.spare;
    const std::array kept_first{&last.values, &last.keys, &other.values, &other.keys};
    for (std::uint64_t i = 0; i < kept_first.size(); ++i) {
        const Buffer& buffer = i < words_here ? buffer_ : colours;
        *kept_first.at(i) =
            buffer.address<gpu::uint>((i < words_here ? i : i - words_here) * most * sizeof(gpu::uint));
    }
    return arrays;
}

glm::uvec2 tilesOf(glm::uvec2 size_px) { return (size_px + (gpu::kTileSize - 1)) / gpu::kTileSize; }

FrameBuffers makeFrameBuffers(const Context& context, std::uint32_t splat_count, bool in_pages) {
    FrameBuffers buffers;
    buffers.splat_count = splat_count;
    buffers.state = Buffer(context, "frame state", sizeof(FrameState));
    buffers.visibility = Buffer(
        context, "visibility",
        buffers.cullGroups() * (gpu::kCullBlock / 8 + sizeof(gpu::uint)) + gpu::kSumRuns * sizeof(gpu::uint));
    if (in_pages) {
        buffers.pages =
            Buffer(context, "visible pages",
                   (buffers.cullGroups() + gpu::kSumRuns + 2 * buffers.pageWords()) * sizeof(gpu::uint));
    }
    return buffers;
}

namespace {

std::uint64_t scratchBytes(FrameCapacity capacity) {
    return std::max({VisibleBuffers::groupSumBytes(capacity.visible) + sizeof(gpu::uint),
                     Sort::histogramBytes(capacity.visible),
                     Sort::histogramBytes(4 * std::uint64_t{capacity.pairs})});
}

Buffer makeScratch(const Context& context, FrameCapacity capacity) {
    return {context, "sums and sort scratch", scratchBytes(capacity)};
}

}  // namespace

void growFrameBuffers(const Context& context, FrameBuffers& buffers, FrameCapacity capacity) {
    if (buffers.visible.capacity() != capacity.visible) {
        buffers.visible = {};
        buffers.visible = VisibleBuffers(context, capacity.visible);
    }
    if (buffers.pairs.capacity() != capacity.pairs) {
        buffers.pairs = {};
        buffers.pairs = PairBuffers(context, capacity.pairs);
    }
    if (buffers.scratch.bytes() != scratchBytes(capacity)) {
        buffers.scratch = {};
        buffers.scratch = makeScratch(context, capacity);
    }
}

FrameLists makeLongerLists(const Context& context, FrameCapacity now, FrameCapacity wanted) {
    FrameLists lists;
    if (now.visible != wanted.visible) { lists.visible = VisibleBuffers(context, wanted.visible); }
    if (now.pairs != wanted.pairs) { lists.pairs = PairBuffers(context, wanted.pairs); }
    if (scratchBytes(now) != scratchBytes(wanted)) { lists.scratch = makeScratch(context, wanted); }
    return lists;
}

FrameLists exchangeLists(FrameBuffers& buffers, FrameLists longer) {
    FrameLists before;
    const auto exchange = [](auto& from, auto& to, auto& out) {
        if (from.bytes() > 0) { out = std::exchange(to, std::move(from)); }
    };
    exchange(longer.visible, buffers.visible, before.visible);
    exchange(longer.pairs, buffers.pairs, before.pairs);
    exchange(longer.scratch, buffers.scratch, before.scratch);
    return before;
}

}  // namespace binosplat
