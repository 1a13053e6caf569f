// Times by the stages of a frame, for tables and plots.
#pragma once

#include "engine/mode.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

using NamedTimes = std::vector<std::pair<std::string, double>>;

// The stages that have a column, by the names of stagesOf().
inline constexpr const char* kStages[] = {"cull+sort", "dominant", "reprojection", "ROI choice", "patch", "affiliated"};

// The times by bare pass: "dominant 4_project" and "affiliated 4_project" add up to "4_project".
NamedTimes byPass(const NamedTimes& pass_ms);

// The times by stage: "cull+sort" (1 to 3), "dominant" (4 to 7), "reprojection" (8d and 8e), "ROI choice" (the rest of 8), and of the
// affiliated eye's 4 to 7 "patch", or "affiliated" where it is rendered in full. Stages that did not run are left out.
NamedTimes stagesOf(std::optional<Mode> mode, const NamedTimes& pass_ms);

// Of all times with this name; 0 of none.
double sumOf(const NamedTimes& times, const std::string& name);

}  // namespace binosplat
