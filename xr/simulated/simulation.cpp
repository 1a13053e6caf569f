#include "xr/simulated/simulation.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "xr/simulated/profiles.h"
#include "xr/simulated/script_profile.h"

namespace simulated {
namespace {

const char* environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr || *value == '\0' ? nullptr : value;
}

bool wantsRealClock() {
    const char* const name = environment("BINOSPLAT_SIMULATED_CLOCK");
    const std::string_view clock = name == nullptr ? "lockstep" : name;
    if (clock != "lockstep" && clock != "real") {
        throw std::runtime_error("BINOSPLAT_SIMULATED_CLOCK is '" + std::string(clock) + "', must be lockstep or real");
    }
    return clock == "real";
}

std::optional<Output> makeOutput() {
    const char* const folder = environment("BINOSPLAT_SIMULATED_OUT");
    if (folder == nullptr) return std::nullopt;
    std::filesystem::create_directories(folder);
    return Output{folder, FrameLog(std::filesystem::path(folder) / "frames.jsonl")};
}

// The environment's word counts before the script's.
std::string favouriteProfile(const Script& script) {
    const char* const wanted = environment("BINOSPLAT_SIMULATED_PROFILE");
    const std::string name = wanted == nullptr ? script.profile : wanted;
    if (name.empty()) return {};
    const Profile* const profile = findHandProfile(name);
    if (profile == nullptr) throw std::runtime_error("BINOSPLAT_SIMULATED_PROFILE is '" + name + "', must be one of: " + handProfiles());
    checkInputs(script, *profile);
    return std::string(profile->path);
}

std::unique_ptr<Simulation>& survivor() {
    // The loader closes the library between two instances; it is linked so that it stays loaded, or this would be forgotten.
    static std::unique_ptr<Simulation> simulation;
    return simulation;
}

std::string originOfEnvironment() {
    std::string origin;
    for (const char* name :
         {"BINOSPLAT_SIMULATED_SCRIPT", "BINOSPLAT_SIMULATED_CLOCK", "BINOSPLAT_SIMULATED_OUT", "BINOSPLAT_SIMULATED_PROFILE"}) {
        const char* const value = environment(name);
        origin.append(value == nullptr ? "" : value).append("\n");
    }
    return origin;
}

}  // namespace

Script scriptOfEnvironment() {
    const char* const file = environment("BINOSPLAT_SIMULATED_SCRIPT");
    return file == nullptr ? Script() : Script::load(file);
}

std::unique_ptr<Simulation> Simulation::begin() {
    // Another script or folder is another run within the same process.
    const std::string origin = originOfEnvironment();
    std::unique_ptr<Simulation> survived = std::move(survivor());
    if (survived != nullptr && survived->origin == origin) {
        survived->survives = false;
        return survived;
    }
    Script script = scriptOfEnvironment();
    const Clock clock(wantsRealClock(), std::llround(1e9 / script.rate_hz));
    std::string profile = favouriteProfile(script);
    const double rate_hz = script.rate_hz;
    return std::make_unique<Simulation>(Simulation{origin, std::move(script), clock, makeOutput(), std::move(profile), rate_hz});
}

void Simulation::end(std::unique_ptr<Simulation> simulation) {
    if (simulation != nullptr && simulation->survives) survivor() = std::move(simulation);
}

}  // namespace simulated
