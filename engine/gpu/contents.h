// Tracks which content aliased memory holds while a frame is recorded.
#pragma once

#include <cstdint>
#include <map>

namespace binosplat {

enum class Content {
    kDepthKeys,  // of visible splats, later replaced by their counts of tiles
    kOrder,      // visible splats front to back
    kSorting,    // the other half of a sort
    kTileSets,   // in place of kSorting, once that is done
    kTileCounts,
    kGroupSums,  // of tiles, before the sort's histograms
    kHistograms,
    kPairs,        // of tile and splat, unsorted
    kLargeSplats,  // and where their pairs begin, until the pairs are sorted
    kSortedPairs,
    kMovingPixels,  // and where they arrive, in rows that become the target's colours
    kPicture,
    kTileDepths,  // later replaced by prices, and then by the tiles with pairs
    kTilePrices,
    kTilesWithPairs,
    kDepthBins,
    kPriceBins,
};

class Contents {
public:
    // From now on the bytes hold this, whatever was there before.
    void fill(std::uint64_t begin, std::uint64_t bytes, Content content);
    // True if all of them still hold it.
    [[nodiscard]] bool hold(std::uint64_t begin, std::uint64_t bytes, Content content) const;
    void forget() { parts_.clear(); }

private:
    struct Part {
        std::uint64_t end;
        Content content;
    };
    std::map<std::uint64_t, Part> parts_;  // by where they begin; none overlap
};

}  // namespace binosplat
