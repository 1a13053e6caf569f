// XR_EXT_conformance_automation: a program's own test sets inputs, poses and profiles; the rest follows the
// script.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "xr/simulated/script/script.h"

namespace simulated {

struct Profile;

struct DeviceOverride {
    const Profile* profile = nullptr;
    std::optional<bool> is_active;
    // By the path after /input/: "trigger/value".
    std::map<std::string, double, std::less<>> inputs;
    std::optional<Pose> stage_from_grip, stage_from_aim;
};

struct Automation {
    std::array<DeviceOverride, kDevices> devices;

    void applyTo(State& state) const;
};

}  // namespace simulated
