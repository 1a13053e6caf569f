// Numbers with a unit behind them.
#include "app/options/amounts.h"

#include "engine/error.h"
#include "engine/setup/values.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

constexpr double kMaxMs = 10'000.0, kMaxPercent = 1000.0;

// The number in front of a unit that the text ends with.
std::optional<double> numberBefore(std::string_view text, std::string_view unit) {
    if (!text.ends_with(unit)) { return {}; }
    return parseNumber(text.substr(0, text.size() - unit.size()));
}

}  // namespace

Keep readKeep(const Setting& setting) {
    constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{
        {{"KB", 1e3}, {"MB", 1e6}, {"GB", 1e9}}};
    const std::string text = setting.text();
    for (const auto& [unit, bytes] : kUnits) {
        const std::optional<double> number = numberBefore(text, unit);
        if (number && *number > 0.0) { return {*number * bytes, Keep::kBytes}; }
    }
    const std::optional<double> number = parseNumber(text);
    if (number && *number > 0.0 && *number <= 1.0) { return {*number, Keep::kShare}; }
    if (number && *number > 1.0 && *number <= static_cast<double>(kMaxSplats) &&
        *number == std::floor(*number)) {
        return {*number, Keep::kSplats};
    }
    fail("{} is {}, must be a share of the splats up to 1, a number of them, or a size such as 50MB",
         setting.origin, text.empty() ? "empty" : text);
}

FrameTime readFrameTime(const Setting& setting) {
    const std::string text = setting.text();
    const std::optional<double> percent = numberBefore(text, "%"), ms = parseNumber(text);
    if (percent && *percent > 0.0 && *percent <= kMaxPercent) {
        return {*percent / 100.0, FrameTime::kShareOfTwoPass};
    }
    if (ms && *ms >= 0.0 && *ms <= kMaxMs) { return {*ms, FrameTime::kMs}; }
    fail("{} is {}, must be a number of ms from 0 to {}, or a share of two-pass's time such as 70%",
         setting.origin, text.empty() ? "empty" : text, kMaxMs);
}

}  // namespace binosplat
