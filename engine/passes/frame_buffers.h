// The device memory of a frame: what grows with the visible splats (56 bytes each, 92 for two pictures at
// once), with the pairs (4 to 16), with the pixels.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/passes/sort.h"
#include "shaders/shared/types.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace binosplat {

// The most pictures and lists of visible splats in a frame.
inline constexpr std::size_t kMostTargets = 2;

using gpu::TargetState;
// Shaders step from one to the next by whole addresses.
static_assert(sizeof(TargetState) % sizeof(gpu::DeviceAddress<gpu::uint>) == 0);

// What the device gets at the start of a frame, and what it reports at the end.
struct FrameState {
    std::array<gpu::EyeView, kMostTargets> views;            // a target's view has its index
    std::array<gpu::ListState, kMostTargets> visible;        // [0] is both eyes' if they share it
    std::array<gpu::ListState, kMostTargets> visible_pages;  // the same for the pages of a scene in pages
    std::array<TargetState, kMostTargets> targets;
};

glm::uvec2 tilesOf(glm::uvec2 size_px);

struct FrameCapacity {
    std::uint32_t visible = 0;
    std::uint32_t pairs = 0;  // see PairBuffers
    bool operator==(const FrameCapacity&) const = default;
};

// A target's result in device memory, rows top to bottom.
struct Picture {
    Buffer colours;            // four floats per pixel, or four half floats
    bool half_floats = false;  // which
    Buffer depths = {};        // D, a float per pixel, if it is wanted and not in the words
    bool of_surface = false;   // D/A is the depth of a surface in every pixel, see gpu::RasterizePass
    // If later pictures are made from this one:
    Buffer words = {};  // a word per pixel, lib/moving_pixel.glsl
    Buffer tiles = {};  // gpu::HistoryTile
    glm::uvec2 size_px{0, 0};
};

// Memory of pictures that are empty until the pairs of all tiles are sorted.
struct EmptyPictures {
    gpu::DeviceAddress<gpu::uint> memory;
    std::uint64_t bytes = 0;
};

// The arrays over the visible splats, front to back. Sets of tiles and splats: those of one picture after
// those of another, if several are rendered at once.
struct VisibleArrays {
    std::uint32_t capacity = 0;
    gpu::DeviceAddress<gpu::uvec2> tile_sets;
    gpu::DeviceAddress<gpu::uint> order;  // indices into the scene
    gpu::DeviceAddress<gpu::ProjectedSplat> splats;

    // For sorting by depth, where the splats will be: begins in `unsorted`, ends in `sorted`.
    [[nodiscard]] KeyValues sorted() const { return {words(0), order}; }
    [[nodiscard]] KeyValues unsorted() const { return {words(1), words(2)}; }

private:
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> words(std::uint64_t arrays_before) const {
        return gpu::DeviceAddress<gpu::uint>{splats.value}.at(arrays_before * capacity);
    }
};

// Their memory.
class VisibleBuffers {
public:
    VisibleBuffers() = default;
    VisibleBuffers(const Context& context, std::uint32_t capacity);

    // Of splats, if pictures are rendered one by one.
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    // For as many pictures at once. Sets of tiles are dead before any pair is sorted: those of several
    // pictures lie in the pictures if that leaves more capacity.
    [[nodiscard]] VisibleArrays arrays(int pictures = 1, const EmptyPictures& empty = {}) const;
    // The capacity of those arrays in buffers of this capacity; and the other way around.
    static std::uint32_t splatsIn(std::uint32_t capacity, int pictures, std::uint64_t empty_bytes);
    static std::uint32_t capacityFor(std::uint32_t splats, int pictures, std::uint64_t empty_bytes);
    [[nodiscard]] std::uint64_t bytes() const { return buffer_.bytes(); }
    // Of the sums of tiles that project leaves for bin.
    static std::uint64_t groupSumBytes(std::uint64_t capacity) {
        return (capacity + gpu::kListBlock - 1) / gpu::kListBlock * sizeof(gpu::uint);
    }

private:
    std::uint32_t capacity_ = 0;
    Buffer buffer_;
};

// How many bits distinguish so many tiles, and no tile.
unsigned tileBits(gpu::uint tiles);

// How (tile, splat) pairs are stored: lib/pair_word.glsl.
struct PairFormat {
    unsigned rank_bits;  // 0: two words a pair
    KeyBits tile_bits;   // by which they are sorted
    // Of `tiles` through all pictures that are rendered at once, and a list of up to `splats`. `in_place`:
    // once sorted, they are where they were.
    PairFormat(gpu::uint tiles, std::uint32_t splats, bool in_place = false);

    [[nodiscard]] bool fitsOneWord() const { return rank_bits > 0; }
    // Of a pair while it is sorted.
    [[nodiscard]] std::uint32_t words() const { return fitsOneWord() ? 2 : 4; }
};

// Where the pairs are: a sort goes from one place to the other and back, and its result is in either.
struct PairArrays {
    KeyValues pairs, spare;
    std::uint32_t capacity = 0;
};

// Two or four words a pair. Only one of them outlives the sort: that with the rank. For pictures that are
// rendered whole the others are there, as far as they fit.
class PairBuffers {
public:
    static constexpr std::uint64_t kBytesPerPair = 4 * sizeof(gpu::uint);

    PairBuffers() = default;
    PairBuffers(const Context& context, std::uint32_t capacity);

    // Of pairs of four words.
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    // The same for this many pairs if the rest is in pictures.
    static std::uint32_t capacityFor(const PairFormat& format, std::uint32_t pairs,
                                     std::uint64_t empty_bytes);
    // For as many pairs as fit here and in pictures.
    [[nodiscard]] PairArrays arrays(const PairFormat& format, const EmptyPictures& empty) const;
    [[nodiscard]] std::uint64_t bytes() const { return buffer_.bytes(); }

private:
    std::uint32_t capacity_ = 0;
    Buffer buffer_;
};

// What grows with what the eyes see.
struct FrameLists {
    VisibleBuffers visible;
    PairBuffers pairs;
    Buffer scratch;  // sums of workgroups or histograms of the list at hand
};

// Everything on which the passes of one frame work, except the pictures.
struct FrameBuffers : FrameLists {
    std::uint32_t splat_count = 0;
    Buffer state;       // FrameState
    Buffer visibility;  // one bit per splat, then one count per workgroup and per run of these
    // For a scene in pages: the list, a word per run of it, then one bit per page, then one count per word of
    // these.
    Buffer pages;
    // One uvec2 per tile for all that are rendered at once; then, if tiles may be coarse, a list of those
    // with pairs.
    Buffer tile_ranges;

    [[nodiscard]] FrameCapacity capacity() const { return {visible.capacity(), pairs.capacity()}; }
    [[nodiscard]] gpu::DeviceAddress<gpu::EyeView> eyes() const {
        return state.address<gpu::EyeView>(offsetof(FrameState, views));
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> visibleBits() const {
        return visibility.address<gpu::uint>();
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> groupCounts() const {
        return visibility.address<gpu::uint>(cullGroups() * (gpu::kCullBlock / 8));
    }
    [[nodiscard]] std::uint64_t cullGroups() const {
        return (std::uint64_t{splat_count} + gpu::kCullBlock - 1) / gpu::kCullBlock;
    }
    [[nodiscard]] std::uint64_t pageWords() const { return (cullGroups() + 31) / 32; }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> pageList() const { return pages.address<gpu::uint>(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> pageBits() const {
        return pageList().at(cullGroups() + gpu::kSumRuns);
    }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> pageWordOffsets() const { return pageBits().at(pageWords()); }
    // Offsets of the lists within `state`.
    static std::uint64_t visibleList(int i) {
        return offsetof(FrameState, visible) + static_cast<std::uint64_t>(i) * sizeof(gpu::ListState);
    }
    static std::uint64_t visiblePages(int i) {
        return offsetof(FrameState, visible_pages) + static_cast<std::uint64_t>(i) * sizeof(gpu::ListState);
    }
    // Of a field of TargetState.
    static std::uint64_t targetField(int target, std::uint64_t offset) {
        return offsetof(FrameState, targets) + static_cast<std::uint64_t>(target) * sizeof(TargetState) +
               offset;
    }
};

FrameBuffers makeFrameBuffers(const Context& context, std::uint32_t splat_count, bool in_pages = false);
// Provides capacity; the lists' contents are lost, and memory for more than the new size is never held.
void growFrameBuffers(const Context& context, FrameBuffers& buffers, FrameCapacity capacity);
// What lists of the capacity `now` lack for `wanted`; those that are long enough are left out. On any thread.
// Throws Error if the device lacks the memory.
FrameLists makeLongerLists(const Context& context, FrameCapacity now, FrameCapacity wanted);
// Puts them into `buffers`, which have the capacity that they were made for, and returns what was there.
FrameLists exchangeLists(FrameBuffers& buffers, FrameLists longer);

}  // namespace binosplat
