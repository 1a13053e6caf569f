// Allocates a frame's buffers.
#include "engine/passes/frame_buffers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

namespace binosplat {

namespace {

// Of a visible splat: its place in the order; for each picture the splat, and the set of its tiles.
constexpr std::uint64_t bytesPerSplat(int pictures, bool has_sets) {
    return sizeof(gpu::uint) + static_cast<std::uint64_t>(pictures) *
                                   (sizeof(gpu::ProjectedSplat) + (has_sets ? sizeof(gpu::uvec2) : 0));
}
constexpr std::uint64_t kBytesPerSplat = bytesPerSplat(1, true);
static_assert(3 * sizeof(gpu::uint) <= sizeof(gpu::ProjectedSplat));  // VisibleArrays::unsorted

// How many splats' sets fit into pictures. Those of a single picture never lie there: passes between two
// pictures may read them.
std::uint64_t setsIn(std::uint64_t empty_bytes, int pictures) {
    return pictures > 1 ? empty_bytes / (static_cast<std::uint64_t>(pictures) * sizeof(gpu::uvec2)) : 0;
}

}  // namespace

VisibleBuffers::VisibleBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "visible splats", kBytesPerSplat * capacity) {}

std::uint32_t VisibleBuffers::splatsIn(std::uint32_t capacity, int pictures, std::uint64_t empty_bytes) {
    const std::uint64_t bytes = kBytesPerSplat * capacity,
                        beside =
                            std::min(bytes / bytesPerSplat(pictures, false), setsIn(empty_bytes, pictures));
    return static_cast<std::uint32_t>(std::max(bytes / bytesPerSplat(pictures, true), beside));
}

std::uint32_t VisibleBuffers::capacityFor(std::uint32_t splats, int pictures, std::uint64_t empty_bytes) {
    const bool has_sets = splats > setsIn(empty_bytes, pictures);
    const std::uint64_t bytes = splats * bytesPerSplat(pictures, has_sets);
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>((bytes + kBytesPerSplat - 1) / kBytesPerSplat, UINT32_MAX));
}

VisibleArrays VisibleBuffers::arrays(int pictures, const EmptyPictures& empty) const {
    VisibleArrays arrays;
    arrays.capacity = splatsIn(capacity_, pictures, empty.bytes);
    const std::uint64_t set_bytes =
        static_cast<std::uint64_t>(pictures) * sizeof(gpu::uvec2) * arrays.capacity;
    const bool has_sets = bytesPerSplat(pictures, true) * arrays.capacity <= buffer_.bytes();
    std::uint64_t at = has_sets ? set_bytes : 0;
    arrays.tile_sets = has_sets ? buffer_.address<gpu::uvec2>() : gpu::UVec2s{empty.memory.value};
    arrays.order = buffer_.address<gpu::uint>(at);
    at += sizeof(gpu::uint) * arrays.capacity;
    arrays.splats = buffer_.address<gpu::ProjectedSplat>(at);
    return arrays;
}

unsigned tileBits(gpu::uint tiles) { return static_cast<unsigned>(std::bit_width(tiles)); }

PairFormat::PairFormat(gpu::uint tiles, std::uint32_t splats, bool in_place)
    : rank_bits(0), tile_bits(tileBits(tiles)) {
    if (in_place && tile_bits.endInSpare()) { ++tile_bits.rounds; }
    const auto bits = static_cast<unsigned>(std::bit_width(std::max(splats, 2u) - 1));
    if (bits + tile_bits.count <= 32) {
        rank_bits = bits;
        tile_bits.first = bits;
    }
}

PairBuffers::PairBuffers(const Context& context, std::uint32_t capacity)
    : capacity_(capacity), buffer_(context, "tile pairs", kBytesPerPair * capacity) {}

std::uint32_t PairBuffers::capacityFor(const PairFormat& format, std::uint32_t pairs,
                                       std::uint64_t empty_bytes) {
    const std::uint64_t there = empty_bytes / sizeof(gpu::uint), words = format.words();
    const std::uint64_t words_here = words - std::min(there / std::max(pairs, 1u), words - 1);
    return static_cast<std::uint32_t>((words_here * pairs + 3) / 4);
}

PairArrays PairBuffers::arrays(const PairFormat& format, const EmptyPictures& empty) const {
    const std::uint64_t words = format.words(), here = 4 * std::uint64_t{capacity_},
                        there = empty.bytes / sizeof(gpu::uint);
    std::uint64_t most = here / words, words_here = words;
    for (std::uint64_t beside = 1; beside < words; ++beside) {
        const std::uint64_t fit = std::min(here / (words - beside), there / beside);
        if (fit > most) { std::tie(most, words_here) = std::pair(fit, words - beside); }
    }
    PairArrays arrays{{}, {}, static_cast<std::uint32_t>(std::min<std::uint64_t>(most, gpu::kMaxItems))};
    KeyValues &last = format.tile_bits.endInSpare() ? arrays.spare : arrays.pairs,
              &other = format.tile_bits.endInSpare() ? arrays.pairs : arrays.spare;
    const std::array kept_first = format.fitsOneWord()
                                      ? std::array{&last.keys, &other.keys, &last.values, &other.values}
                                      : std::array{&last.values, &last.keys, &other.values, &other.keys};
    for (std::uint64_t i = 0; i < words; ++i) {
        const gpu::Uints memory = i < words_here ? buffer_.address<gpu::uint>() : empty.memory;
        *kept_first.at(i) = memory.at((i < words_here ? i : i - words_here) * most);
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
