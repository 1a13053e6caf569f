// Allocating a frame's buffers.
#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <cassert>

namespace binosplat {

VisibleBuffers::VisibleBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "visible splats", kBytesPerSplat * capacity) {}

PairBuffers::PairBuffers(const Context& context, std::uint32_t capacity, std::uint32_t lent_capacity)
    : capacity_(capacity),
      lent_capacity_(lent_capacity),
      buffer_(context, "tile pairs", std::max(kBytesPerPair * capacity, (kBytesPerPair - kLentBytesPerPair) * lent_capacity)) {}

PairArrays PairBuffers::arrays() const {
    const auto array = [&](std::uint64_t i) { return buffer_.address<gpu::uint>(i * sizeof(gpu::uint) * capacity_); };
    return {{array(0), array(1)}, {array(2), array(3)}, capacity_};
}

PairArrays PairBuffers::arraysWith(const Buffer& idle, unsigned key_bits) const {
    assert(idle.bytes() >= kLentBytesPerPair * lent_capacity_);
    const auto lent = [&](std::uint64_t i) { return idle.address<gpu::uint>(i * sizeof(gpu::uint) * lent_capacity_); };
    PairArrays arrays{{lent(0), lent(2)}, {lent(1), lent(2)}, lent_capacity_};
    (Sort::endsInSpare(key_bits) ? arrays.spare : arrays.pairs).values = buffer_.address<gpu::uint>();
    return arrays;
}

glm::uvec2 tilesOf(glm::uvec2 size_px) { return (size_px + (gpu::kTileSize - 1)) / gpu::kTileSize; }

StereoBuffers::StereoBuffers(const Context& context, glm::uvec2 size_px, std::uint32_t boxes)
    : size_px_(size_px), tile_count_(std::uint64_t{tilesOf(size_px).x} * tilesOf(size_px).y), box_capacity_(boxes) {
    tiles_ = Buffer(context, "stereo tiles", (4 * tile_count_ + 1 + gpu::kDepthBins) * sizeof(gpu::uint));
}

FrameBuffers makeFrameBuffers(const Context& context, std::uint32_t splat_count) {
    FrameBuffers buffers;
    buffers.splat_count = splat_count;
    buffers.state = Buffer(context, "frame state", sizeof(FrameState));
    buffers.visibility =
        Buffer(context, "visibility", std::max<std::uint64_t>(buffers.cullGroups(), 1) * (gpu::kGroupSize / 8 + sizeof(gpu::uint)));
    return buffers;
}

void growFrameBuffers(const Context& context, FrameBuffers& buffers, FrameCapacity capacity) {
    if (buffers.visible.capacity() != capacity.visible) {
        buffers.visible = {};
        buffers.visible = VisibleBuffers(context, capacity.visible);
    }
    if (buffers.pairs.capacity() != capacity.pairs || buffers.pairs.lentCapacity() != capacity.lent_pairs) {
        buffers.pairs = {};
        buffers.pairs = PairBuffers(context, capacity.pairs, capacity.lent_pairs);
    }
    const std::uint64_t scratch_bytes = std::max({Scan::blockSumBytes(capacity.visible), Sort::histogramBytes(capacity.visible),
                                                  Sort::histogramBytes(std::max(capacity.pairs, capacity.lent_pairs))});
    if (buffers.scratch.bytes() != scratch_bytes) {
        buffers.scratch = {};
        buffers.scratch = Buffer(context, "scan and sort scratch", scratch_bytes);
    }
}

}  // namespace binosplat
