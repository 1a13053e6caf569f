// Which levels of a streamed scene's leaves are on the device, and how one takes the place of another: the
// new one fades in over the old one, and then the old one fades out, so that there is no moment without
// either.
#pragma once

#include "engine/stream/chunk_loader.h"
#include "engine/stream/resident_scene.h"

#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace binosplat {

// For the thread that records frames.
class ShownLeaves {
public:
    // `leaves` must outlive this.
    ShownLeaves(const Context& context, const SceneTraits& traits, const ResidentScene::Options& options,
                std::span<const LodLeaf> leaves);

    [[nodiscard]] const ResidentScene& resident() const { return resident_; }
    // Copies everything that was added to the device, and waits for that. Frames do not learn where it was.
    void flush(const Context& context);

    // The level that each leaf is to show, as LevelChoices::levels. Until it is loaded a leaf goes on showing
    // what it shows.
    void want(const std::vector<std::uint32_t>& levels);
    // Takes a part that is wanted, or the first of its leaf; others are dropped. False if it does not fit
    // now: the part is then unchanged.
    [[nodiscard]] bool add(LoadedPart& part);
    // A step of all exchanges, as a share of a fade; at 1 or more they end at once.
    void step(float share);
    // Ends all exchanges, and counts parts on their way to the device as arrived: for callers that bring them
    // there before the next frame.
    void exchangeAtOnce();

    [[nodiscard]] bool has(LeafLevel at) const;
    [[nodiscard]] bool isEmpty(std::uint32_t leaf) const { return leaves_[leaf].empty(); }
    // True if fewer splats of the leaf are wanted than there are.
    [[nodiscard]] bool isTooFine(std::uint32_t leaf) const;
    // For LevelsThere.
    [[nodiscard]] std::vector<std::uint64_t> loadedLevels() const;
    [[nodiscard]] std::uint32_t partCount() const { return part_count_; }
    [[nodiscard]] bool isExchanging() const { return !changing_.empty(); }
    // Splats of the wanted levels, and how many of these are on the device.
    [[nodiscard]] std::uint64_t splatsWanted() const { return splats_wanted_; }
    [[nodiscard]] std::uint64_t splatsThere() const;

private:
    struct Shown {
        std::uint32_t level;
        ResidentScene::Part part;
        float fade;
    };
    [[nodiscard]] std::uint64_t splatsOf(std::uint32_t leaf, std::uint32_t level) const {
        return tree_[leaf].levels[level].splats.count;
    }
    // The part that a leaf ends with as things are; end() if there will be none.
    [[nodiscard]] std::vector<Shown>::iterator goalOf(std::uint32_t leaf);
    void remove(std::uint32_t leaf, std::vector<Shown>::iterator shown);
    // False: there is nothing left to change in this leaf.
    bool stepLeaf(std::uint32_t leaf, float share, bool at_once);
    // Removes parts that go anyway, now.
    void reserve();

    ResidentScene resident_;
    std::span<const LodLeaf> tree_;
    std::vector<std::vector<Shown>> leaves_;
    std::vector<std::uint32_t> wanted_;
    std::set<std::uint32_t> changing_;
    std::uint64_t splats_wanted_ = 0;
    std::uint32_t part_count_ = 0;
};

}  // namespace binosplat
