// Assigning passes to stages.
#include "app/bench/bench_stages.h"

#include <algorithm>

namespace binosplat {

namespace {

std::string columnOf(std::optional<Mode> mode, const PassLabel& label) {
    switch (label.stage) {
        case FrameStage::kSort:
            return "cull+sort";
        case FrameStage::kWarp:
            return "reprojection";
        case FrameStage::kChoose:
            return "ROI choice";
        case FrameStage::kPresent:
            return "present";
        case FrameStage::kSplat:
            break;
    }
    if (mode == Mode::kTemporal) { return "patch"; }
    if (label.role == Role::kBoth) { return "both eyes"; }
    if (label.role != Role::kAffiliated) { return "dominant"; }
    return mode && rendersBothInFull(*mode) ? "affiliated" : "patch";
}

void add(NamedTimes& sums, const std::string& name, double ms) {
    const auto found = std::ranges::find(sums, name, &std::pair<std::string, double>::first);
    (found == sums.end() ? sums.emplace_back(name, 0.0) : *found).second += ms;
}

}  // namespace

NamedTimes byLabel(const PassTimes& pass_ms) {
    NamedTimes times;
    for (const auto& [label, ms] : pass_ms) { times.emplace_back(label.text(), ms); }
    return times;
}

NamedTimes byPass(const PassTimes& pass_ms) {
    NamedTimes sums;
    for (const auto& [label, ms] : pass_ms) { add(sums, label.pass, ms); }
    return sums;
}

NamedTimes stagesOf(std::optional<Mode> mode, const PassTimes& pass_ms) {
    NamedTimes stages;
    for (const char* stage : kStages) {
        for (const auto& [label, ms] : pass_ms) {
            if (columnOf(mode, label) == stage) { add(stages, stage, ms); }
        }
    }
    return stages;
}

std::optional<double> sumOf(const NamedTimes& times, const std::string& name) {
    std::optional<double> sum;
    for (const auto& [time_name, ms] : times) {
        if (time_name == name) { sum = sum.value_or(0.0) + ms; }
    }
    return sum;
}

}  // namespace binosplat
