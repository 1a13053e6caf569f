// Operations in frames that may wait, as counted by two layers (tests/faults/waits.h).
#pragma once

#include "tests/app/view/view_acts.h"

namespace binosplat::test {

// Frames take no time, so none is drawn smaller to save time.
inline const std::string kWatched =
    withXrFaults("", withFaults("BINOSPLAT_FAULT_WAITS=waits.txt BINOSPLAT_FAULT_TICKS=1", kAlone));

// For each frame, what it did that may wait.
inline std::vector<std::set<std::string>> waitsOf(const Workplace& work) {
    std::vector<std::set<std::string>> kinds;
    for (const std::string& line : linesIn(work.bytesOf("waits.txt"))) {
        const std::vector<std::string> words = wordsIn(line);
        CHECK(words.at(0) == std::to_string(kinds.size()));
        kinds.emplace_back();
        for (std::size_t i = 1; i < words.size(); i += 2) { kinds.back().insert(words[i]); }
    }
    return kinds;
}

inline std::string listed(const std::set<std::string>& all) { return fmt::format("{}", fmt::join(all, " ")); }

// No frame but the first ones waited or made anything.
inline void checkQuiet(const Workplace& work, std::size_t first_frames = 45) {
    const std::vector<std::set<std::string>> waits = waitsOf(work);
    REQUIRE(waits.size() > first_frames + 45);
    for (std::size_t frame = first_frames; frame < waits.size(); ++frame) {
        CHECK_MESSAGE(waits[frame].empty(), frame, ": ", listed(waits[frame]));
    }
}

// Runs the viewer, which complains of nothing.
inline ViewRun runWatched(const Workplace& work, const std::string& script, const std::string& arguments,
                          const std::string& environment = "") {
    ViewRun run = runView(work, "run", script, arguments, kWatched + " " + environment);
    checkEnded(run);
    return run;
}

// Without hands; every frame is complete.
inline ViewRun runQuiet(const Workplace& work, const std::string& script, const std::string& arguments,
                        const std::string& environment = "", std::size_t first_frames = 45) {
    ViewRun run = runWatched(work, script, arguments + " --hide-hands", environment);
    CHECK_FALSE(run.says("frames shown incomplete"));
    checkQuiet(work, first_frames);
    return run;
}

}  // namespace binosplat::test
