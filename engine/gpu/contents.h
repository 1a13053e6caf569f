// What memory holds that serves one purpose after another within a frame, followed while the frame is recorded.
#pragma once

#include <cstdint>
#include <map>

namespace binosplat {

enum class Content {
    kDepthKeys,  // of visible splats, then the counts of tiles in their place
    kOrder,      // visible splats front to back
    kSorting,    // the other half of a sort
    kTileSets,   // in its place, once that is done
    kTileCounts,
    kGroupSums,  // of tiles, before the sort's histograms
    kHistograms,
    kPairs,        // of tile and splat, unsorted
    kLargeSplats,  // and where they begin, until the pairs are sorted
    kSortedPairs,
    kMovingPixels,  // and where they arrive, in rows that become the target's colours
    kPicture,
    kTileDepths,  // then prices in their place, then the tiles with pairs
    kTilePrices,
    kTilesWithPairs,
    kDepthBins,
    kPriceBins,
};

class Contents {
public:
    // From now on the bytes hold this, whatever was there.
    void fill(std::uint64_t begin, std::uint64_t bytes, Content content);
    // Whether none of them was given to anything else since.
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
