// Reads and requests the display's rates.
#include "xr/extensions/refresh_rate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat::xr {

std::vector<double> RefreshRate::list() const {
    if (!isThere()) { return {}; }
    std::vector<float> rates;
    instance_.troubles().tryFor("a choice of refresh rates", [&] {
        const auto get =
            instance_.function<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB");
        rates = listAll<float>(
            [&](auto... step) { checkResult(get(session_, step...), "xrEnumerateDisplayRefreshRatesFB"); });
    });
    return {rates.begin(), rates.end()};
}

XrDuration RefreshRate::period() const {
    if (!isThere()) { return 0; }
    float rate_hz = 0.0f;
    const bool is_known = instance_.troubles().tryFor("the display's refresh rate", [&] {
        const auto get = instance_.function<PFN_xrGetDisplayRefreshRateFB>("xrGetDisplayRefreshRateFB");
        checkResult(get(session_, &rate_hz), "xrGetDisplayRefreshRateFB");
    });
    return is_known && rate_hz > 0.0f ? std::llround(1e9 / static_cast<double>(rate_hz)) : 0;
}

std::string RefreshRate::request(double rate_hz) {
    if (rate_hz == std::exchange(requested_hz_, rate_hz)) { return {}; }
    const std::vector<double> rates = list();
    if (rates.empty()) { return "refresh-rate: this headset's rate cannot be chosen"; }
    // Rates as people write them: 72 for 71.999.
    const auto isIt = [&](double rate) { return std::abs(rate - rate_hz) < 0.5; };
    const auto found = std::ranges::find_if(rates, isIt);
    if (rate_hz != 0.0 && found == rates.end()) {
        std::string offered;
        for (const double rate : rates) {
            offered += fmt::format("{}{:g}", offered.empty() ? "" : ", ", rate);
        }
        return fmt::format("refresh-rate is {:g}, this headset has {}", rate_hz, offered);
    }
    PFN_xrVoidFunction ask = nullptr;
    XrResult result = xrGetInstanceProcAddr(instance_.handle(), "xrRequestDisplayRefreshRateFB", &ask);
    if (XR_SUCCEEDED(result)) {
        const float asked_hz = rate_hz == 0.0 ? 0.0f : static_cast<float>(*found);
        result = reinterpret_cast<PFN_xrRequestDisplayRefreshRateFB>(ask)(session_, asked_hz);
    }
    if (XR_SUCCEEDED(result)) { return {}; }
    if (result == XR_ERROR_SESSION_LOST || result == XR_ERROR_INSTANCE_LOST) {
        checkResult(result, "xrRequestDisplayRefreshRateFB");
    }
    return fmt::format("refresh-rate is {:g}, this headset refuses it ({})", rate_hz, nameOf(result));
}

}  // namespace binosplat::xr
