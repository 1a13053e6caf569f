// XR_FB_display_refresh_rate: the display's rates, including those of the script.
#include <algorithm>
#include <cmath>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

std::vector<float> ratesOf(const Script& script) {
    std::vector<float> rates{static_cast<float>(script.rate_hz)};
    if (!script.rate_is_fixed) { rates.insert(rates.end(), {72, 80, 90, 120}); }
    for (const ScriptEvent& event : script.events) {
        if (event.kind == ScriptEvent::Kind::kRate) { rates.push_back(static_cast<float>(event.value)); }
    }
    std::sort(rates.begin(), rates.end());
    rates.erase(std::unique(rates.begin(), rates.end()), rates.end());
    return rates;
}

}  // namespace

void changeRate(Instance& instance, double rate_hz) {
    Simulation& simulation = *instance.simulation;
    const auto before = static_cast<float>(std::exchange(simulation.rate_hz, rate_hz)),
               now = static_cast<float>(rate_hz);
    simulation.clock.setPeriod(std::llround(1e9 / rate_hz));
    if (now == before || !instance.extensions.contains(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)) { return; }
    instance.events.push(XrEventDataDisplayRefreshRateChangedFB{
        XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB, nullptr, before, now});
}

XrResult xrEnumerateDisplayRefreshRatesFB(XrSession session, uint32_t displayRefreshRateCapacityInput,
                                          uint32_t* displayRefreshRateCountOutput,
                                          float* displayRefreshRates) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        fillArray(displayRefreshRateCapacityInput, displayRefreshRateCountOutput, displayRefreshRates,
                  ratesOf(owner.instance.simulation->script));
    });
}

XrResult xrGetDisplayRefreshRateFB(XrSession session, float* displayRefreshRate) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        checkOutput(displayRefreshRate) = static_cast<float>(owner.instance.simulation->rate_hz);
    });
}

XrResult xrRequestDisplayRefreshRateFB(XrSession session, float displayRefreshRate) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        Simulation& simulation = *owner.instance.simulation;
        const auto before = static_cast<float>(simulation.rate_hz);
        // 0 leaves the choice to the runtime.
        const float wanted =
            displayRefreshRate == 0 ? static_cast<float>(simulation.script.rate_hz) : displayRefreshRate;
        const std::vector<float> rates = ratesOf(simulation.script);
        require(std::find(rates.begin(), rates.end(), wanted) != rates.end(),
                XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB, displayRefreshRate, " Hz was not enumerated");
        if (wanted == before) { return; }
        require(!simulation.script.rate_is_fixed, XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB,
                "the script says that the rate is fixed, and not at ", displayRefreshRate, " Hz");
        changeRate(owner.instance, wanted == static_cast<float>(simulation.script.rate_hz)
                                       ? simulation.script.rate_hz
                                       : wanted);
    });
}

}  // namespace simulated
