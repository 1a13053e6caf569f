// What `bench` measures, from a config's [bench] and [[series]].
#pragma once

#include "app/options.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

// Every scene is measured with every splat count at every size.
struct BenchSeries {
    std::string name;
    std::vector<std::uint64_t> splats;  // built-in scenes only; 0 is the scene's own number
    std::vector<glm::uvec2> sizes_px;
};

struct BenchPlan {
    std::vector<std::string> scenes;
    std::vector<std::string> modes{"two-pass", "shared", "reproject", "paper", "predicted"};
    std::uint32_t repeats = 5;
    std::uint32_t warm_up = 1;  // frames of each mode before those that count
    std::vector<BenchSeries> series;
};

// Scenes of the command line replace the config's; without a [[series]] there is one, at the frame's own size.
// Throws Error with file and line; kUsage if no scene is named anywhere.
BenchPlan planBench(const BenchOptions& options);

}  // namespace binosplat
