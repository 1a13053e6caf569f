// Which pass belongs to which stage.
#include "app/bench/bench_stages.h"

#include <map>

namespace binosplat {

namespace {

// Bare pass: without the eyes in front.
std::string bareName(const std::string& pass) { return pass.substr(pass.rfind(' ') + 1); }

std::string stageOf(std::optional<Mode> mode, const std::string& pass) {
    const std::string bare = bareName(pass);
    if (bare.starts_with("8d") || bare.starts_with("8e")) { return "reprojection"; }
    if (bare.starts_with("8")) { return "ROI choice"; }
    if (bare < "4") { return "cull+sort"; }
    if (!pass.starts_with("affiliated ")) { return "dominant"; }
    return mode && rendersBothInFull(*mode) ? "affiliated" : "patch";
}

}  // namespace

NamedTimes byPass(const NamedTimes& pass_ms) {
    std::map<std::string, double> sums;  // by the number in front of a pass's name, nearly the order of the frame
    for (const auto& [name, ms] : pass_ms) { sums[bareName(name)] += ms; }
    return {sums.begin(), sums.end()};
}

NamedTimes stagesOf(std::optional<Mode> mode, const NamedTimes& pass_ms) {
    NamedTimes stages;
    for (const char* stage : kStages) {
        double sum = 0.0;
        bool ran = false;
        for (const auto& [pass, ms] : pass_ms) {
            if (stageOf(mode, pass) != stage) { continue; }
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
