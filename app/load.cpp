// From the options to the loader.
#include "app/load.h"

#include "app/terminal/progress.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/scene/address.h"
#include "engine/web/web_files.h"

#include <fmt/format.h>

#include <algorithm>

namespace binosplat {

LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib) {
    if (memory_limit_mib == 0) { return {options.lod, {}}; }
    return {options.lod, [limit_bytes = memory_limit_mib << 20, options](std::uint64_t splats, int sh_degree) {
                const int kept = std::min(sh_degree, static_cast<int>(options.sh_degree.value_or(kMaxShDegree)));
                return splats <= limit_bytes / deviceBytesPerSplat(kept, !options.flatten);
            }};
}

namespace {

// Fewer colours, 3D Gaussians as discs, or dimmed, where the user says so; a file may itself say that its splats are to be dimmed.
void drawAs(const LoadOptions& options, Scene& scene, LoadNotes& notes) {
    if (options.sh_degree) { limitShDegree(scene, static_cast<int>(*options.sh_degree), notes); }
    if (options.flatten) { flatten(scene, notes); }
    if (options.antialiased) { scene.antialiased = scene.isGaussian3d(); }
}

}  // namespace

Scene loadAsAsked(const std::string& source, const LoadOptions& options, std::uint64_t memory_limit_mib, LoadNotes& notes,
                  const Progress& progress, std::uint64_t builtin_splats) {
    const WebSettings web{webCacheFolder(), options.cache_limit_mib << 20, {}};
    Scene scene = loadSceneFromAnywhere(source, builtin_splats, notes, progress, levelChoice(options, memory_limit_mib), web);
    drawAs(options, scene, notes);
    return scene;
}

Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes, std::uint64_t memory_limit_mib) {
    ProgressLine line("loading " + source);
    return loadAsAsked(source, options, memory_limit_mib, notes, [&](double share) { line.show(share); });
}

Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats) {
    LoadNotes notes;
    ProgressLine line("loading " + source);
    const Progress progress = isAddress(source) ? Progress([&](double share) { line.show(share); }) : Progress();
    Scene scene = loadAsAsked(source, run.load, run.memory_limit_mib, notes, progress, builtin_splats);
    if (!notes.stale.empty()) { fmt::print(stderr, "binosplat: {}\n", notes.stale); }
    return scene;
}

}  // namespace binosplat
