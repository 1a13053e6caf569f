// The simulation: the script that moves the headset, the clock that moves the script, and where the wearer's
// view is written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "xr/simulated/api/clock.h"
#include "xr/simulated/log/frame_log.h"
#include "xr/simulated/script/script.h"

namespace simulated {

constexpr std::size_t kEyes = 2;

struct Output {
    std::filesystem::path folder;
    FrameLog log;
};

// The script in SIMULATED_OPENXR_SCRIPT, or a headset at rest. Throws ScriptError.
Script loadScriptOfEnvironment();

struct Simulation {
    // The environment's settings when it began.
    std::string origin;
    Script script;
    Clock clock;
    // None: nothing is read back, composed or written.
    std::optional<Output> output;
    // The interaction profile that the controllers play if the application knows it.
    std::string favourite_profile;
    // The display's rate, which the application may change.
    double rate_hz = 90;
    std::uint64_t frames_shown = 0;
    std::uint32_t calls_without_headset = 0;
    // Calls of xrGetSystem until the headset is plugged in again.
    std::uint32_t calls_until_plugged = 0;
    double events_until_s = -std::numeric_limits<double>::infinity();
    // Something was lost: time goes on for the next instance, so that the same loss does not happen again.
    bool survives = false;

    // By SIMULATED_OPENXR_SCRIPT, _CLOCK, _OUT and _PROFILE. Throws ScriptError, std::runtime_error.
    static std::unique_ptr<Simulation> begin();
    static void end(std::unique_ptr<Simulation> simulation);

    [[nodiscard]] State at(XrTime time) const { return script.at(clock.secondsAt(time)); }
};

}  // namespace simulated
