// The environment of the simulated headset.
#include "app/simulate.h"

#include "engine/error.h"

#include <cstdlib>
#include <filesystem>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// A headset that rests has been seen after a second.
constexpr std::uint64_t kFramesAtRest = 90;

bool isSet(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
}

bool hasDisplay() { return isSet("DISPLAY") || isSet("WAYLAND_DISPLAY"); }

}  // namespace

void simulateHeadset(ViewOptions& options) {
    const fs::path manifest = fs::read_symlink("/proc/self/exe").parent_path() / "simulated_runtime.json";
    if (!fs::exists(manifest)) {
        throw Error(ExitCode::kNoDevice, fmt::format("no simulated headset: looked for {}, which the build makes", manifest.string()));
    }
    setenv("XR_RUNTIME_JSON", manifest.c_str(), 1);
    if (!options.script.empty()) {
        std::error_code ignored;
        check(fs::is_regular_file(options.script, ignored), "--simulate: {} is not a file, must be a script (see docs/simulated_script.md)",
              options.script);
        setenv("SIMULATED_OPENXR_SCRIPT", fs::absolute(options.script).c_str(), 1);
    }
    if (!hasDisplay()) {
        if (options.out.empty()) { options.out = "out/view"; }
        if (options.script.empty() && options.frames == 0) { options.frames = kFramesAtRest; }
    }
    if (!options.out.empty()) {
        std::error_code error;
        fs::create_directories(options.out, error);
        check(!error, "--out: {} cannot be made ({})", options.out.string(), error.message());
        setenv("SIMULATED_OPENXR_OUT", fs::absolute(options.out).c_str(), 1);
    } else if (!isSet("BINOSPLAT_SIMULATED_CLOCK")) {
        setenv("SIMULATED_OPENXR_CLOCK", "real", 0);  // somebody watches
    }
}

}  // namespace binosplat
