// The results of `stability`: a table, all figures, and a plot for each family of cases.
#pragma once

#include "app/stability_cases/run_case.h"

#include <string>
#include <utility>
#include <vector>

namespace binosplat {

struct StabilityRun {
    std::string device;
    std::vector<std::pair<stability::Case, stability::CaseScore>> cases;
    std::vector<std::pair<stability::Path, stability::PathScore>> paths;
    std::vector<std::pair<stability::Sequence, stability::SequenceScore>> sequences;

    // Names of the cases that miss their bounds.
    [[nodiscard]] std::vector<std::string> failures() const;
};

std::string stabilityTable(const StabilityRun& run);
std::string stabilityCsv(const StabilityRun& run);
std::string stabilityPlot(const StabilityRun& run);

}  // namespace binosplat
