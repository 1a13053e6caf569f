// Chooses levels beside the frames, for the latest eyes.
#pragma once

#include "engine/stream/level_chooser.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace binosplat {

struct LevelQuestion {
    std::vector<Eye> eyes;
    ChoiceSettings settings;
    LevelsThere there;
};

class LevelPlanner {
public:
    // `leaves` outlives this.
    explicit LevelPlanner(std::span<const LodLeaf> leaves);
    LevelPlanner(const LevelPlanner&) = delete;
    LevelPlanner& operator=(const LevelPlanner&) = delete;
    ~LevelPlanner();

    // Replaces a question that has not been begun yet. False if the planner is reading it right now: ask
    // again. Never waits.
    [[nodiscard]] bool ask(const LevelQuestion& question);
    // The latest answer, once. Never waits.
    [[nodiscard]] std::optional<LevelChoices> take();

private:
    void run();

    LevelChooser chooser_;  // of the thread
    std::mutex mutex_;      // of what follows
    std::condition_variable asked_;
    bool stops_ = false;
    std::optional<LevelQuestion> question_;
    std::optional<LevelChoices> answer_;
    std::thread thread_;  // last
};

}  // namespace binosplat
