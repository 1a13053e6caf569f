// The plan of `bench`, from a config's [bench], [[methods]], [[series]] and [[views]].
#pragma once

#include "app/bench/bench_methods.h"
#include "app/scores/lpips.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// Every scene is measured with every splat count at every size.
struct BenchSeries {
    std::string name;
    std::vector<std::uint64_t> splats;  // built-in scenes only; 0 is the scene's own number
    std::vector<glm::uvec2> sizes_px;   // per eye; 0x0: the camera's or the headset's
};

// A view of a scene.
struct BenchView {
    std::string name;
    std::vector<std::string> scenes;  // its scenes, by file name or builtin:NAME; empty: any
    RunOptions run;                   // the run's options with the view's own on top
};

// Views for which the scene is drawn in the same way.
struct DrawnViews {
    RunOptions run;  // with the `load` of these views
    std::vector<BenchView> views;
};

struct BenchPlan {
    std::vector<std::string> scenes;
    std::vector<BenchMethod> methods;  // two-pass and shared are always among them
    std::vector<BenchSeries> series;
    std::vector<BenchView> views;
    std::vector<std::string> headsets{""};  // measured one after the other; "": the run's own camera
    std::uint32_t repeats = 5;
    std::uint32_t warm_up = 1;  // frames of each method before the measured ones
    bool psnr = true, ssim = true, flip = true;
    std::optional<Lpips> lpips;  // if it is among the scores
    bool twin = false;           // also the float64 twin on the CPU, for one eye
};

// Scenes of the command line replace the config's; without a [[series]] there is one, at the frame's own
// size; a scene without a [[views]] of its own is seen by the camera options. A camera on the command line
// replaces all views, a size those of all series. Throws Error with file and line; kUsage if no scene is
// named anywhere.
BenchPlan planBench(const BenchOptions& options);

// The scene's own name, or its whole path if another scene of the plan has the same name.
std::string nameIn(const BenchPlan& plan, const std::string& scene);

// A scene's views, grouped by how they draw it; a single unnamed one if the plan has none.
std::vector<DrawnViews> viewsOf(const BenchPlan& plan, const std::string& scene, const RunOptions& run);

}  // namespace binosplat
