// How scripts of the panel's and the controls' tests begin, and the scenes that they show.
#pragma once

#include "tests/app/view/view_panel.h"

namespace binosplat::test {

// The left hand points at the floor.
inline const std::string kLeftHand = "controller left 0 position -0.2 1.2 -0.35 turn 0 -80\n";
inline const std::string kSmall = "rate 45\nsize 160 160\nframes every 2\n" + kLeftHand,
                         kStill = "rate 90\nsize 160 160\nframes every 8\n" + kLeftHand;
// Where nobody looks at what the headset shows; dense where it counts within which frame something happens.
inline const std::string kBlind = "rate 45\nsize 64 64\nframes none\n" + kLeftHand,
                         kDense = "rate 90\nsize 64 64\nframes none\n" + kLeftHand;
// Few splats where any picture will do; bars with holes between them where it is looked at.
inline const std::string kWall = "builtin:slanted-wall --load-first --hide-hands", kScene = kWall + " --mode mono",
                         kFence = "fence.ply --load-first --hide-hands";

// Where the panel hangs at the start.
inline const Panel& startPanel(const Workplace& work) {
    static const Panel panel = panelOf(runView(work, "look", kDense + "at 0.1 exit\n", kScene), 8);
    return panel;
}

inline bool says(const ViewRun& run, const std::string& words) { return run.outcome.output.find(words) != std::string::npos; }

}  // namespace binosplat::test
