// The device memory of a frame: what grows with the visible splats (60 bytes each), with the pairs (4 to 16),
// with the pixels.
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
    Buffer colours;            // four floats a pixel, or four half floats
    bool half_floats = false;  // which
    Buffer depths = {};        // D, a float a pixel, if it is wanted and not in the words
    // If later pictures are made from this one:
    Buffer words = {};  // a word a pixel, lib/moving_pixel.glsl
    Buffer tiles = {};  // gpu::HistoryTile
    glm::uvec2 size_px{0, 0};
};

// The arrays over the visible splats lie in one buffer, one after the other.
class VisibleBuffers {
public:
    VisibleBuffers() = default;
    VisibleBuffers(const Context& context, std::uint32_t capacity);

    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    // Depth keys and splat indices; sorting begins in `spare`. Once they are sorted, the counts of tiles
    // replace the keys, and the sets of tiles replace `spare`.
    [[nodiscard]] KeyValues order() const { return {at<gpu::uint>(0), at<gpu::uint>(4)}; }
    [[nodiscard]] KeyValues spare() const { return {at<gpu::uint>(8), at<gpu::uint>(12)}; }
    [[nodiscard]] gpu::DeviceAddress<gpu::uvec2> tileSets() const { return at<gpu::uvec2>(8); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> tileCounts() const { return at<gpu::uint>(0); }
    [[nodiscard]] gpu::DeviceAddress<gpu::ProjectedSplat> splats() const {
        return at<gpu::ProjectedSplat>(16);
    }
    [[nodiscard]] std::uint64_t bytes() const { return buffer_.bytes(); }
    // Of the sums of tiles that project leaves for bin.
    static std::uint64_t groupSumBytes(std::uint64_t capacity) {
        return (capacity + gpu::kListBlock - 1) / gpu::kListBlock * sizeof(gpu::uint);
    }

private:
    template <typename T>
    [[nodiscard]] gpu::DeviceAddress<T> at(std::uint64_t bytes_before_per_splat) const {
        return buffer_.address<T>(bytes_before_per_splat * capacity_);
    }
    static constexpr std::uint64_t kBytesPerSplat = 16 + sizeof(gpu::ProjectedSplat);
    std::uint32_t capacity_ = 0;
    Buffer buffer_;
};

// Where an eye's (tile, splat) pairs are: a sort goes from one buffer to the other and back, and its result
// is in either.
struct PairArrays {
    KeyValues pairs, spare;
    std::uint32_t capacity = 0;
};

// Four words a pair. Only one of them outlives the sort: the splats by tile. For an eye that is rendered
// whole the others are in its picture, which is empty until then, as far as they fit.
class PairBuffers {
public:
    static constexpr std::uint64_t kBytesPerPair = 4 * sizeof(gpu::uint);

    PairBuffers() = default;
    PairBuffers(const Context& context, std::uint32_t capacity);

    // Of pairs of four words.
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    // The same for an eye with this many pairs if the rest is in `colours`.
    static std::uint32_t capacityBeside(const Buffer& colours, std::uint32_t pairs);
    [[nodiscard]] PairArrays arrays() const;
    // For as many pairs as fit here and in `colours`, where nothing remains after a sort by `key_bits`.
    [[nodiscard]] PairArrays arraysBeside(const Buffer& colours, unsigned key_bits) const;
    [[nodiscard]] std::uint64_t bytes() const { return buffer_.bytes(); }

private:
    static constexpr std::uint32_t kMostWordsBeside = 3;
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
// Provides capacity; the lists' contents are lost, and never more than the new size is held.
void growFrameBuffers(const Context& context, FrameBuffers& buffers, FrameCapacity capacity);
// What lists of the capacity `now` lack for `wanted`; those that are long enough are left out. On any thread.
// Throws Error if the device lacks the memory.
FrameLists makeLongerLists(const Context& context, FrameCapacity now, FrameCapacity wanted);
// Puts them into `buffers`, which have the capacity that they were made for, and returns what was there.
FrameLists exchangeLists(FrameBuffers& buffers, FrameLists longer);

}  // namespace binosplat
