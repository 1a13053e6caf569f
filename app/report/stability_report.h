// What `stability` found: a table, all figures, and a plot a family of cases.
#pragma once

#include "engine/stability/run_case.h"

#include <string>
#include <vector>

namespace binosplat {

struct StabilityRun {
    std::string device;
    std::vector<stability::Case> cases;
    std::vector<stability::CaseScore> scores;  // of the cases, in their order
    std::vector<stability::Path> paths;
    std::vector<stability::PathScore> path_scores;
    std::vector<stability::Sequence> sequences;
    std::vector<stability::SequenceScore> sequence_scores;

    // Names of what misses its bounds.
    [[nodiscard]] std::vector<std::string> failures() const;
};

std::string stabilityTable(const StabilityRun& run);
std::string stabilityCsv(const StabilityRun& run);
std::string stabilityPlot(const StabilityRun& run);

}  // namespace binosplat
