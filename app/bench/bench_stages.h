// Times by the stages of a frame, for tables and plots.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/mode.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

using NamedTimes = std::vector<std::pair<std::string, double>>;

// The stages that have a column, by the names of stagesOf().
inline constexpr const char* kStages[] = {"cull+sort",  "dominant", "both eyes", "reprojection",
                                          "ROI choice", "patch",    "affiliated"};

// The times by the labels of their passes: "dominant project".
NamedTimes byLabel(const PassTimes& pass_ms);

// The times by bare pass, in the order of first appearance: "dominant project" and "affiliated project" add
// up to "project".
NamedTimes byPass(const PassTimes& pass_ms);

// The times by stage: "cull+sort" (FrameStage::kSort), "dominant" (FrameStage::kSplat), "both eyes" (the same
// if they are rendered at once), "reprojection" (FrameStage::kWarp), "ROI choice" (FrameStage::kChoose), and
// for the affiliated eye's FrameStage::kSplat "patch", or "affiliated" if it is rendered in full. Stages that
// did not run are left out.
NamedTimes stagesOf(std::optional<Mode> mode, const PassTimes& pass_ms);

// The sum of all times with this name; empty if there are none.
std::optional<double> sumOf(const NamedTimes& times, const std::string& name);

}  // namespace binosplat
