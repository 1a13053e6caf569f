// Which level of detail each leaf of a streamed scene is to show, by how the eyes see it.
//
// n splats across a leaf that takes up a square of s x s pixels are s / sqrt(n) pixels apart. A step from a
// level of m splats to the next finer one, of n, is worth s^2 / sqrt(m n): the mean square of that distance
// in pixels, which is also what its splats gain each if the error of a leaf is its area times the square of
// the distance. Where the errors of levels were measured, a step is worth what the error falls by, times the
// area, for each splat that it adds; a step that gains less than the next one is taken together with it.
// Steps are taken from the greatest worth down while the budget lasts, and not at all where splats are closer
// than pixels. Splats thus end up as dense on the screen everywhere as the budget allows, or denser where
// they are missed more: if a level's error is known to be worse than 36 dB, steps are taken until its splats
// are twice as close.
#pragma once

#include "engine/files/lod_tree.h"
#include "engine/geometry.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

// A level of a leaf, given by its place in LodLeaf::levels.
struct LeafLevel {
    std::uint32_t leaf = 0, level = 0;
    bool operator==(const LeafLevel&) const = default;
};

struct ChoiceSettings {
    std::uint64_t splats = 0;  // at most
    std::uint64_t pages = 0;   // at most, of page_splats; each level of a leaf begins a page of its own
    std::uint32_t page_splats = 512;
    // Splats need not be closer than this on the screen, or than half of it where levels have large errors.
    double finest_px = 0.5;
    // Beyond the edge of the view, the worth of a step falls by a factor of e for each of these.
    double look_ahead_rad = 0.35;
    double nearest = 0.2;  // nothing is nearer to an eye than this, in scene units
    bool operator==(const ChoiceSettings&) const = default;
};

struct LevelChoices {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    // For each leaf, the place of its level in LodLeaf::levels; kNone if not even the coarsest fits.
    std::vector<std::uint32_t> levels;
    // The levels to load, in order: the coarsest level of every leaf, then the finer ones that leaves are to
    // show.
    std::vector<LeafLevel> coarsest, finer;
    std::uint64_t splats = 0, pages = 0;  // of `levels`
};

// The levels to choose from: all except those in files that cannot be loaded, unless they are loaded already.
struct LevelsThere {
    std::vector<bool> broken;  // by file; may be shorter than there are files
    // For each leaf, one bit for each of LodLeaf::levels; may be shorter than the number of leaves.
    std::vector<std::uint64_t> loaded;

    [[nodiscard]] bool has(LeafLevel at, std::uint32_t file) const {
        const bool is_loaded = at.leaf < loaded.size() && (loaded[at.leaf] >> at.level & 1) != 0;
        return is_loaded || file >= broken.size() || !broken[file];
    }
    bool operator==(const LevelsThere&) const = default;
};

class LevelChooser {
public:
    // `leaves` must outlive this.
    explicit LevelChooser(std::span<const LodLeaf> leaves) : leaves_(leaves) {}

    // For the eyes of one head. A level that was chosen the previous time is worth a quarter more, and one
    // that was not, a fifth less, so that small motions change nothing. The same calls always give the same
    // levels.
    const LevelChoices& choose(std::span<const Eye> eyes, const ChoiceSettings& settings,
                               const LevelsThere& there = {});

private:
    // A step of a leaf, from nothing or from the next coarser level that counts.
    struct Step {
        double worth = 0.0;
        std::uint32_t leaf = 0, level = 0, order = 0;  // order: its place among those of its leaf
        // In addition to the previous step; all of the level's if order is 0.
        std::uint64_t splats = 0, pages = 0;
    };
    void addSteps(std::uint32_t leaf, double area_px, double weight, const ChoiceSettings& settings,
                  const LevelsThere& there);

    std::span<const LodLeaf> leaves_;
    LevelChoices choices_;
    bool is_first_ = true;     // nothing has been chosen yet
    std::vector<Step> steps_;  // kept for their memory
};

}  // namespace binosplat
