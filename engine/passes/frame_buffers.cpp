// Allocating a frame's buffers.
#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace binosplat {

VisibleBuffers::VisibleBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "visible splats", kBytesPerSplat * capacity) {}

PairBuffers::PairBuffers(const Context& context, const FrameCapacity& capacity)
    : capacity_(capacity.pairs),
      lent_capacity_(capacity.lent_pairs),
      lent_words_(capacity.lent_words),
      buffer_(context, "tile pairs",
              std::max(kBytesPerPair * capacity_, (kBytesPerPair - lent_words_ * sizeof(gpu::uint)) * lent_capacity_)) {
    assert(lent_words_ <= kMostLentWords);
}

PairArrays PairBuffers::arrays(int share, int shares) const {
    const std::uint32_t capacity = capacity_ / static_cast<std::uint32_t>(shares);
    const std::uint64_t first = static_cast<std::uint64_t>(share) * capacity;
    const auto array = [&](std::uint64_t i) { return buffer_.address<gpu::uint>((i * capacity_ + first) * sizeof(gpu::uint)); };
    return {{array(0), array(1)}, {array(2), array(3)}, capacity};
}

PairArrays PairBuffers::arraysWith(const Buffer& idle, unsigned key_bits) const {
    const std::uint64_t array_bytes = sizeof(gpu::uint) * lent_capacity_;
    assert(idle.bytes() >= lent_words_ * array_bytes);
    PairArrays arrays{{}, {}, lent_capacity_};
    KeyValues &last = Sort::endsInSpare(key_bits) ? arrays.spare : arrays.pairs,
              &other = Sort::endsInSpare(key_bits) ? arrays.pairs : arrays.spare;
    const std::array kept_first{&last.values, &last.keys, &other.values, &other.keys};
    const std::size_t kept = kept_first.size() - lent_words_;
    for (std::size_t i = 0; i < kept_first.size(); ++i) {
        *kept_first[i] = i < kept ? buffer_.address<gpu::uint>(i * array_bytes) : idle.address<gpu::uint>((i - kept) * array_bytes);
    }
    return arrays;
}

glm::uvec2 tilesOf(glm::uvec2 size_px) { return (size_px + (gpu::kTileSize - 1)) / gpu::kTileSize; }

FrameBuffers makeFrameBuffers(const Context& context, std::uint32_t splat_count, bool in_pages) {
    FrameBuffers buffers;
    buffers.splat_count = splat_count;
    buffers.state = Buffer(context, "frame state", sizeof(FrameState));
    buffers.visibility =
        Buffer(context, "visibility", buffers.cullGroups() * (gpu::kCullBlock / 8 + sizeof(gpu::uint)) + gpu::kSumRuns * sizeof(gpu::uint));
    if (in_pages) {
        buffers.pages =
            Buffer(context, "visible pages", (buffers.cullGroups() + gpu::kSumRuns + 2 * buffers.pageWords()) * sizeof(gpu::uint));
    }
    return buffers;
}

void growFrameBuffers(const Context& context, FrameBuffers& buffers, FrameCapacity capacity) {
    if (buffers.visible.capacity() != capacity.visible) {
        buffers.visible = {};
        buffers.visible = VisibleBuffers(context, capacity.visible);
    }
    if (buffers.pairs.capacity() != capacity.pairs || buffers.pairs.lentCapacity() != capacity.lent_pairs ||
        buffers.pairs.lentWords() != capacity.lent_words) {
        buffers.pairs = {};
        buffers.pairs = PairBuffers(context, capacity);
    }
    const std::uint64_t scratch_bytes =
        kMostAtOnce * std::max({VisibleBuffers::groupSumBytes(capacity.visible), Sort::histogramBytes(capacity.visible),
                                Sort::histogramBytes(std::max(capacity.pairs, capacity.lent_pairs))});
    if (buffers.scratch.bytes() != scratch_bytes) {
        buffers.scratch = {};
        buffers.scratch = Buffer(context, "sums and sort scratch", scratch_bytes);
    }
}

}  // namespace binosplat
