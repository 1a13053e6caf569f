// The environment of the simulated headset.
#include "app/view/simulate.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// One second is enough of a headset at rest.
constexpr std::uint64_t kFramesAtRest = 90;

// Beside the program in a build, or where it and its package are installed.
fs::path findManifest() {
    const fs::path folder = programFile().parent_path();
    const fs::path installed = fs::path("share") / "openxr" / "1" / "binosplat_simulated_runtime.json";
    const std::array candidates{folder / "simulated_runtime.json", folder.parent_path() / installed,
                                "/usr" / installed};
    const auto* found =
        std::ranges::find_if(candidates, [](const fs::path& path) { return fs::exists(path); });
    if (found == candidates.end()) {
        throw Error(
            ExitCode::kNoDevice,
            fmt::format("the simulated runtime is not installed: neither {} nor {} exists; install "
                        "binosplat-simulated-runtime, run ./run build or, on Windows, unpack the whole .zip",
                        candidates[0].string(), candidates[1].string()));
    }
    return *found;
}

}  // namespace

void simulateHeadset(ViewOptions& options) {
    const fs::path manifest = findManifest();
    setEnvironment("XR_RUNTIME_JSON", manifest.string());
    if (!options.script.empty()) {
        std::error_code ignored;
        check(fs::is_regular_file(options.script, ignored),
              "--simulate: {} is not a file, must be a script (see docs/simulated_script.md)",
              options.script);
        const std::uintmax_t bytes = fs::file_size(options.script, ignored);
        check(bytes <= kMostTextBytes,
              "--simulate: {} is longer than {} MiB, must be a script (see docs/simulated_script.md)",
              options.script, kMostTextBytes >> 20);
        setEnvironment("SIMULATED_OPENXR_SCRIPT", fs::absolute(options.script).string());
    }
    if (!hasDisplay()) {
        if (options.out.empty()) { options.out = "out/view"; }
        if (options.script.empty() && options.frames == 0) { options.frames = kFramesAtRest; }
    }
    if (!options.out.empty()) {
        std::error_code error;
        fs::create_directories(options.out, error);
        check(!error, "--out: {} cannot be made ({})", options.out.string(), error.message());
        setEnvironment("SIMULATED_OPENXR_OUT", fs::absolute(options.out).string());
    } else if (environment("SIMULATED_OPENXR_CLOCK").empty()) {
        setEnvironment("SIMULATED_OPENXR_CLOCK", "real");  // somebody is watching
    }
}

}  // namespace binosplat
