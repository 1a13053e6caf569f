// A streamed scene as frames see it: what the eyes need arrives while frames go on, within a budget of splats
// and of memory.
#pragma once

#include "engine/stream/live_scene.h"
#include "engine/stream/shown_leaves.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

struct StreamSettings {
    std::uint64_t splat_budget = 0;  // of the shown levels together; 0: as many as fit into the memory
    // Device memory for splats; 0: half of what the device has or, if less is allowed, two fifths of that.
    std::uint64_t memory_bytes = 0;
    double fade_seconds = 0.2;     // that each half of an exchange takes
    double look_ahead_rad = 0.35;  // see ChoiceSettings
    bool pictures = false;         // frames may take their time
    // How splats are drawn; see LoadOptions.
    std::optional<int> sh_degree = {};
    bool flatten = false, antialiased = false;
    LoaderSettings loader = {};  // but its `finish`
};

struct LevelQuestion {
    std::vector<Eye> eyes;
    ChoiceSettings settings;
    LevelsThere there;
};

class SceneStream final : public LiveScene {
public:
    // Takes the device memory, and begins to load when it is told where the eyes are. Throws Error if there
    // is not enough memory, or if none of the coarsest level's chunks can be opened.
    SceneStream(const Context& context, std::unique_ptr<ChunkSource> source, StreamSettings settings);

    [[nodiscard]] const std::string& name() const override { return source().name(); }
    [[nodiscard]] const GpuScene& scene() const override { return leaves_->resident().scene(); }
    [[nodiscard]] const SceneTraits& traits() const override { return leaves_->resident().traits(); }
    [[nodiscard]] const ChunkSource& source() const { return loader_->source(); }
    // As many splats as the memory holds, or as the whole scene has, if that is less.
    [[nodiscard]] std::uint64_t mostSplats() const;
    // Sets the most splats that are chosen, from the next choice on.
    void setSplatBudget(std::uint64_t splats);

    void update(std::span<const Eye> eyes, double step_seconds) override;
    void settle(std::span<const Eye> eyes, const Progress& progress = {}) override;
    // The same for only the coarsest level of every leaf, so that there is something to see.
    void settleCoarsest(std::span<const Eye> eyes, const Progress& progress = {});

    [[nodiscard]] bool isSettled() const override;
    [[nodiscard]] double share() const override;
    [[nodiscard]] StreamCounters counters() const override;
    [[nodiscard]] std::optional<LoaderWork> tryWork() const { return loader_->tryWork(); }
    [[nodiscard]] std::vector<std::string> takeLines(Waits waits) override {
        return loader_->takeLines(waits);
    }

private:
    // The chosen levels that are not loaded, to be requested.
    [[nodiscard]] std::vector<LeafLevel> missing(const std::vector<LeafLevel>& chosen) const;
    void wish(Waits waits, bool coarsest_only = false);
    // Adds the parts for which there was no capacity before, and those loaded since.
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
    std::deque<LoadedPart> held_;         // parts for which there was no capacity yet
    bool has_wishes_ = false;             // that the loader has not been told
    std::optional<LevelQuestion> asked_;  // the last one
    bool answered_ = false;
    // For settle, and for update.
    std::optional<LevelChooser> chooser_;
    std::optional<Mailbox<LevelQuestion, LevelChoices>> planner_;
};

}  // namespace binosplat
