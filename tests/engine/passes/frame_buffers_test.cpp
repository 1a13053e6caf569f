// Facts about the memory of a frame's lists.
#include "engine/passes/frame_buffers.h"
#include "tests/engine/gpu/gpu_fixture.h"

SUITE(frame_buffers) {

// Bytes from begin to end.
struct Part {
    std::uint64_t begin, end;
};

template <typename T>
Part partOf(gpu::DeviceAddress<T> array, std::uint64_t count) {
    return {array.value, array.at(count).value};
}

Part partOf(const Buffer& buffer) { return partOf(buffer.address<gpu::uint>(), buffer.bytes() / 4); }

bool isWithin(const Part& part, const Part& whole) {
    return part.begin >= whole.begin && part.end <= whole.end;
}

// True if each lies within one of `wholes`, and none meets another.
bool areApart(std::vector<Part> parts, const std::vector<Part>& wholes) {
    for (const Part& part : parts) {
        if (std::ranges::none_of(wholes, [&](const Part& whole) { return isWithin(part, whole); })) {
            return false;
        }
    }
    std::ranges::sort(parts, {}, &Part::begin);
    return std::ranges::adjacent_find(parts, [](const Part& a, const Part& b) { return a.end > b.begin; }) ==
           parts.end();
}

// For a list of `splats` with so many pairs.
void checkLists(Gpu& gpu, std::uint32_t splats, std::uint32_t pairs, int pictures, const PairFormat& format,
                const Buffer& pictures_memory) {
    const EmptyPictures empty{pictures_memory.address<gpu::uint>(), pictures_memory.bytes()};
    const VisibleBuffers visible(gpu.context(), VisibleBuffers::capacityFor(splats, pictures, empty.bytes));
    const PairBuffers pair_buffers(gpu.context(), PairBuffers::capacityFor(format, pairs, empty.bytes));
    const VisibleArrays of_splats = visible.arrays(pictures, empty);
    const PairArrays of_pairs = pair_buffers.arrays(format, empty);
    REQUIRE(of_splats.capacity >= splats);
    REQUIRE(of_pairs.capacity >= pairs);
    const auto of_all = static_cast<std::uint64_t>(pictures);
    const Part sets = partOf(of_splats.tile_sets, of_all * splats), order = partOf(of_splats.order, splats),
               projected = partOf(of_splats.splats, of_all * splats);
    const std::vector<Part> wholes{
        partOf(gpu::Uints{visible.arrays(1).tile_sets.value}, visible.bytes() / 4),
        partOf(pair_buffers.arrays(PairFormat(1, 2, true), {}).pairs.keys, pair_buffers.bytes() / 4),
        partOf(pictures_memory)};
    CHECK(areApart({sets, order, projected}, wholes));
    for (const KeyValues& unsorted : {of_splats.unsorted(), of_splats.sorted()}) {
        CHECK(isWithin(partOf(unsorted.keys, splats), wholes[0]));
    }
    CHECK(areApart({partOf(of_splats.sorted().keys, splats), partOf(of_splats.unsorted().keys, splats),
                    partOf(of_splats.unsorted().values, splats), order},
                   wholes));
    std::vector<Part> words{partOf(of_pairs.pairs.keys, pairs), partOf(of_pairs.spare.keys, pairs)};
    if (!format.fitsOneWord()) {
        words.push_back(partOf(of_pairs.pairs.values, pairs));
        words.push_back(partOf(of_pairs.spare.values, pairs));
    }
    CHECK(areApart(words, wholes));
    // What rasterize reads is not where it writes.
    const KeyValues& last = format.tile_bits.endInSpare() ? of_pairs.spare : of_pairs.pairs;
    CHECK(isWithin(partOf(format.fitsOneWord() ? last.keys : last.values, pairs), wholes[1]));
    // bin reads sets and splats, and writes unsorted pairs.
    CHECK(areApart({sets, projected, words[0]}, wholes));
    if (!format.fitsOneWord()) { CHECK(areApart({sets, projected, words[2]}, wholes)); }
}

TEST_CASE_FIXTURE(Gpu, "lists have the capacity asked for, and none is overwritten before it has been read") {
    for (const std::uint64_t bytes : {0u, 4096u, 400000u, 2u << 20}) {
        const Buffer pictures_memory(context(), "pictures", bytes);
        for (const int pictures : {1, 2}) {
            for (const std::uint32_t splats : {1u, 1000u, 70001u}) {
                for (const std::uint32_t tiles : {3u, 512u, 8192u, 1u << 20}) {
                    const PairFormat format(tiles, splats, pictures > 1 && bytes > 0);
                    // FramePlan renders whole pictures at once only if their pairs fit.
                    if (pictures > 1 && bytes > 0 && !format.fitsOneWord()) { continue; }
                    for (const std::uint32_t pairs : {1u, 1025u, 90000u, 300000u}) {
                        INFO("bytes ", bytes, ", pictures ", pictures, ", splats ", splats, ", pairs ", pairs,
                             ", tiles ", tiles);
                        checkLists(*this, splats, pairs, pictures, format, pictures_memory);
                    }
                }
            }
        }
    }
}

TEST_CASE("a pair takes one word as long as the numbers of its tile and its splat fit") {
    CHECK(these(PairFormat(255, 1u << 24).rank_bits, PairFormat(256, 1u << 24).rank_bits,
                PairFormat(1, 1).rank_bits) == these(24, 0, 1));
    CHECK(these(PairFormat(255, (1u << 24) + 1).words(), PairFormat(8192, 125000).words()) == these(4, 2));
    CHECK(these(PairFormat(511, 5).tile_bits.rounds, PairFormat(511, 5, true).tile_bits.rounds,
                PairFormat(512, 5, true).tile_bits.rounds) == these(1, 2, 2));
}

}  // SUITE(frame_buffers)
