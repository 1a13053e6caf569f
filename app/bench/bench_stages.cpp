// Which pass belongs to which stage.
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
    if (label.role != Role::kAffiliated) { return "dominant"; }
    return mode && rendersBothInFull(*mode) ? "affiliated" : "patch";
}

}  // namespace

NamedTimes byLabel(const PassTimes& pass_ms) {
    NamedTimes times;
    for (const auto& [label, ms] : pass_ms) { times.emplace_back(label.text(), ms); }
    return times;
}

NamedTimes byPass(const PassTimes& pass_ms) {
    NamedTimes sums;
    for (const auto& [label, ms] : pass_ms) {
        const auto found = std::ranges::find(sums, label.pass, &std::pair<std::string, double>::first);
        if (found == sums.end()) {
            sums.emplace_back(label.pass, ms);
        } else {
            found->second += ms;
        }
    }
    return sums;
}

NamedTimes stagesOf(std::optional<Mode> mode, const PassTimes& pass_ms) {
    NamedTimes stages;
    for (const char* stage : kStages) {
        double sum = 0.0;
        bool ran = false;
        for (const auto& [label, ms] : pass_ms) {
            if (columnOf(mode, label) != stage) { continue; }
            sum += ms;
            ran = true;
        }
        if (ran) { stages.emplace_back(stage, sum); }
    }
    return stages;
}

double sumOf(const NamedTimes& times, const std::string& name) {
    double sum = 0.0;
    for (const auto& [time_name, ms] : times) { sum += time_name == name ? ms : 0.0; }
    return sum;
}

}  // namespace binosplat
