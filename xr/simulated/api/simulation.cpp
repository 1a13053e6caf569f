// Begins a simulation as the environment variables say; after a loss it is kept for the next instance.
#include "xr/simulated/api/simulation.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string_view>

#include "xr/simulated/api/profiles.h"
#include "xr/simulated/compose/old_output.h"
#include "xr/simulated/environment.h"
#include "xr/simulated/script/script_profile.h"

namespace simulated {
namespace {

bool wantsRealClock() {
    const Setting setting = settingOf("CLOCK");
    const std::string clock = setting.isSet() ? setting.value : "lockstep";
    if (clock != "lockstep" && clock != "real") {
        throw std::runtime_error(setting.variable + " is '" + clock + "', must be lockstep or real");
    }
    return clock == "real";
}

std::optional<Output> makeOutput(const Script& script) {
    const Setting setting = settingOf("OUT");
    if (!setting.isSet()) { return std::nullopt; }
    const std::filesystem::path folder(setting.value);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw std::runtime_error(setting.variable + ": " + folder.string() + " cannot be made (" +
                                 error.message() + ")");
    }
    removeOldOutput(folder, script.writes_pictures, script.frames);
    return Output{folder, FrameLog(folder / kLogName)};
}

// The environment overrides the script.
std::string findFavouriteProfile(const Script& script) {
    const Setting setting = settingOf("PROFILE");
    const std::string name = setting.isSet() ? setting.value : script.profile;
    if (name.empty()) { return {}; }
    const Profile* const profile = findHandProfile(name);
    if (profile == nullptr) {
        throw std::runtime_error(setting.variable + " is '" + name +
                                 "', must be one of: " + listHandProfiles());
    }
    checkInputs(script, *profile);
    return std::string(profile->path);
}

std::unique_ptr<Simulation>& getSurvivor() {
    // The loader closes the library between two instances; the library is linked so that it stays loaded, or
    // this would be forgotten.
    static std::unique_ptr<Simulation> simulation;
    return simulation;
}

std::string originOfEnvironment() {
    std::string origin;
    for (const char* name : {"SCRIPT", "CLOCK", "OUT", "PROFILE"}) {
        origin.append(settingOf(name).value).append("\n");
    }
    return origin;
}

}  // namespace

Script loadScriptOfEnvironment() {
    const Setting setting = settingOf("SCRIPT");
    return setting.isSet() ? Script::load(setting.value) : Script();
}

std::unique_ptr<Simulation> Simulation::begin() {
    // Another script or folder means another run in the same process.
    const std::string origin = originOfEnvironment();
    std::unique_ptr<Simulation> survived = std::move(getSurvivor());
    if (survived != nullptr && survived->origin == origin) {
        survived->survives = false;
        return survived;
    }
    Script script = loadScriptOfEnvironment();
    for (const std::string& note : script.notes) {
        std::fprintf(stderr, "simulated runtime: %s\n", note.c_str());
    }
    const Clock clock(wantsRealClock(), std::llround(1e9 / script.rate_hz), script.irregularity);
    std::string profile = findFavouriteProfile(script);
    std::optional<Output> output = makeOutput(script);
    const double rate_hz = script.rate_hz;
    return std::make_unique<Simulation>(
        Simulation{origin, std::move(script), clock, std::move(output), std::move(profile), rate_hz});
}

void Simulation::end(std::unique_ptr<Simulation> simulation) {
    if (simulation != nullptr && simulation->survives) { getSurvivor() = std::move(simulation); }
}

}  // namespace simulated
