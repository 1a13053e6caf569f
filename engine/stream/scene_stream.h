// A streamed scene as frames see it: what the eyes ask for comes while frames go on, within a budget of splats and of memory.
#pragma once

#include "engine/stream/level_planner.h"
#include "engine/stream/shown_leaves.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

struct StreamSettings {
    std::uint64_t splat_budget = 0;  // of the levels that are shown, together; 0: as many as the memory takes
    std::uint64_t memory_bytes = 0;  // of the device, for splats; 0: half of what it has or, if less is allowed, two fifths of that
    double fade_seconds = 0.2;       // that each half of an exchange takes
    double look_ahead_rad = 0.35;    // see ChoiceSettings
    bool pictures = false;           // frames may take their time
    // How splats are drawn, see LoadOptions.
    std::optional<int> sh_degree = {};
    bool flatten = false, antialiased = false;
    LoaderSettings loader = {};  // but its `finish`
};

struct StreamCounters {
    std::uint64_t splats_resident = 0, splats_read = 0;  // on the device; of these, those that the next frame goes through
    std::uint64_t chunks_resident = 0;                   // levels of leaves
    std::uint64_t frames_waited_for_loading = 0;         // update() never waits
};

class SceneStream {
public:
    // Takes the device memory, and begins to load when it is told where the eyes are. Throws Error where that memory is not to be had, and
    // where no chunk of the coarsest level can be opened.
    SceneStream(const Context& context, std::unique_ptr<ChunkSource> source, StreamSettings settings);

    // What frames render.
    [[nodiscard]] const GpuScene& scene() const { return leaves_->resident().scene(); }
    [[nodiscard]] const SceneTraits& traits() const { return leaves_->resident().traits(); }
    [[nodiscard]] const ChunkSource& source() const { return loader_->source(); }
    // What the memory holds, or the whole scene has, if that is less.
    [[nodiscard]] std::uint64_t mostSplats() const;
    // Splats that are chosen, at most; from the next choice on.
    void setSplatBudget(std::uint64_t splats);

    // For whoever shows frame after frame, before each: follows the eyes, takes what was loaded, and goes on with exchanges by a frame of
    // `step_seconds`. Never waits.
    void update(std::span<const Eye> eyes, double step_seconds);
    // For whoever renders pictures: returns when all that these eyes ask for is on the device or goes there with the next frame, apart from
    // what cannot be had. Always the same splats in the same order for the same calls.
    void settle(std::span<const Eye> eyes, const Progress& progress = {});
    // The same of the coarsest level of every leaf alone, so that there is something to see.
    void settleCoarsest(std::span<const Eye> eyes, const Progress& progress = {});

    // Whether update() has nothing left to do for the eyes that it was told last, apart from what cannot be had.
    [[nodiscard]] bool isSettled() const;
    // Of what the eyes ask for, the share that is there, 0 to 1.
    [[nodiscard]] double share() const;
    [[nodiscard]] StreamCounters counters() const;
    // What is wrong with files and servers, one sentence each, once.
    [[nodiscard]] std::vector<std::string> takeLines() { return loader_->takeLines(); }
    // The same for who must not wait: perhaps later.
    [[nodiscard]] std::vector<std::string> tryTakeLines() { return loader_->tryTakeLines(); }

private:
    // Wishes for what is chosen and not there.
    [[nodiscard]] std::vector<LeafLevel> missing(const std::vector<LeafLevel>& chosen) const;
    void wish(bool coarsest_only = false);
    // What did not find room before, and what was loaded since.
    void takeLoaded(bool at_once);
    void ask(std::span<const Eye> eyes);
    void settleChosen(std::span<const Eye> eyes, bool coarsest_only, const Progress& progress);
    void flushIfMuch();

    const Context& context_;
    StreamSettings settings_;
    ChoiceSettings choice_;
    std::uint64_t page_bytes_ = 0, bytes_a_frame_ = 0;
    std::unique_ptr<ChunkLoader> loader_;
    std::unique_ptr<ShownLeaves> leaves_;
    LevelChoices chosen_;
    std::deque<LoadedPart> held_;  // that found no room yet
    bool has_wishes_ = false;      // to tell the loader
    // Of settle, and of update.
    std::unique_ptr<LevelChooser> chooser_;
    std::unique_ptr<LevelPlanner> planner_;
    std::optional<LevelQuestion> asked_;  // the last one
    bool answered_ = false;
};

}  // namespace binosplat
