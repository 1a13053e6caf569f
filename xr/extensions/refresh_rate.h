// XR_FB_display_refresh_rate: the display's refresh rate, and a choice of rates.
#pragma once

#include "xr/instance.h"

#include <string>
#include <vector>

namespace binosplat::xr {

class RefreshRate {
public:
    RefreshRate(const Instance& instance, XrSession session) : instance_(instance), session_(session) {}

    // In hertz, in the headset's order; empty if it offers no choice.
    [[nodiscard]] std::vector<double> list() const;
    // The display's period; 0 if the runtime does not report it.
    [[nodiscard]] XrDuration period() const;
    // Requests a rate, unless it was the last one requested; 0: the runtime's choice. Returns a message for
    // people if that fails, otherwise empty.
    std::string request(double rate_hz);

private:
    [[nodiscard]] bool isThere() const {
        return instance_.hasExtension(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME);
    }

    const Instance& instance_;
    XrSession session_;
    double requested_hz_ = 0.0;
};

}  // namespace binosplat::xr
