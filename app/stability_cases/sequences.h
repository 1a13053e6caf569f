// Frames one after another, each made from the ones before, and the bounds that their pictures must keep to
// against full renders.
#pragma once

#include "app/stability_cases/catalogue.h"
#include "engine/mode.h"

#include <optional>

namespace binosplat::stability {

struct Sequence {
    std::string name;
    Mode mode = Mode::kTemporal;
    std::function<Stage()> make;
    std::function<std::array<Eye, 2>(const Stage& stage, int frame)> eyes;  // of any frame
    int frames = 1;
    double budget = 0.2;
    bool half_floats = false;               // of pictures, as viewers keep them
    int first_scored = 1, score_every = 1;  // frames that are compared with full renders
    // From this frame on the scene is another one.
    std::optional<int> exchanged_at = {};
    std::function<Stage()> make_other = {};
    // Bounds.
    double psnr_db = 0.0;  // of the worst scored frame, at least
    double drift_db = std::numeric_limits<double>::infinity();
    double beyond = std::numeric_limits<double>::infinity();
    double bias = std::numeric_limits<double>::infinity();
    std::optional<int> equal_from = {};  // at the latest
    std::string reason;

    [[nodiscard]] std::string title() const;  // with its mode
};

std::vector<Sequence> makeSequences();

}  // namespace binosplat::stability
