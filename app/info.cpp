// `binosplat info`: what a scene holds and what rendering it will leave out.
#include "app/commands.h"
#include "app/load.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/scene/describe.h"

#include <fmt/format.h>

namespace binosplat {

namespace {

template <typename... Args>
void printRow(const char* name, fmt::format_string<Args...> format, Args&&... args) {
    fmt::print("{:<18} {}\n", name, fmt::format(format, std::forward<Args>(args)...));
}

void printQuantiles(const char* name, const std::array<float, 5>& quantiles) {
    printRow(name, "{:.4g}  {:.4g}  {:.4g}  {:.4g}  {:.4g}", quantiles[0], quantiles[1], quantiles[2], quantiles[3], quantiles[4]);
}

std::string nameKind(const Scene& scene, const LoadNotes& notes) {
    if (!notes.three_scales) { return "2DGS: drawn as discs"; }
    const std::string how = !scene.isGaussian3d() ? "flattened to discs"
                            : scene.antialiased   ? "drawn as 3D Gaussians, antialiased"
                                                  : "drawn as 3D Gaussians";
    return fmt::format("3DGS: {}; the median splat is {:.3g} times as thick as its second axis", how, notes.median_flatness);
}

}  // namespace

void runInfo(const InfoOptions& options) {
    LoadNotes notes;
    const Scene scene = loadWithProgress(options.scene, options.load, notes);
    const SceneSummary summary = describeScene(scene, &notes);

    printRow("scene", "{}", options.scene);
    printRow("splats", "{}", summary.splats);
    for (std::size_t level = 0; level < notes.level_splats.size(); ++level) {
        printRow(level == 0 ? "levels of detail" : "", "{}: {} splats{}", level, notes.level_splats[level],
                 level == notes.level ? " (loaded)" : "");
    }
    if (notes.environment_splats > 0) { printRow("", "environment: {} splats (loaded)", notes.environment_splats); }
    printRow("splats in file", "{}", notes.splats_in_file);
    printRow("skipped", "{} not finite, {} with a rotation of length zero", notes.skipped_not_finite, notes.skipped_zero_rotation);
    const glm::vec3 &low = summary.min_position, &high = summary.max_position;
    printRow("bounds", "{:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g}", low.x, low.y, low.z, high.x, high.y, high.z);
    printRow("SH degree", "{} (file: {})", summary.sh_degree, notes.sh_degree_in_file);
    for (int band = 1; band <= summary.sh_degree; ++band) {
        printRow("", "band {}: {} splats", band, summary.splats_using_band[static_cast<std::size_t>(band)]);
    }
    printRow("kind", "{}", nameKind(scene, notes));
    printRow("invisible splats", "{} (opacity under 1/255)", summary.invisible_splats);
    printRow("quantiles", "0, 5, 50, 95, 100 % of the splats");
    printQuantiles("  opacity", summary.opacity_quantiles);
    printQuantiles("  scale", summary.scale_quantiles);
    printQuantiles("  aspect", summary.aspect_quantiles);
    printRow("memory", "{} bytes ({:.1f} MiB) on the host", summary.host_bytes,
             static_cast<double>(summary.host_bytes) / (1024.0 * 1024.0));
    const std::uint64_t device_bytes = summary.splats * deviceBytesPerSplat(summary.sh_degree, summary.gaussian_3d);
    printRow("", "{} bytes ({:.1f} MiB) on the GPU, {} a splat", device_bytes, static_cast<double>(device_bytes) / (1024.0 * 1024.0),
             deviceBytesPerSplat(summary.sh_degree, summary.gaussian_3d));
    for (const std::string& phrase : summary.left_out) { printRow("left out", "{}", phrase); }
    for (const std::string& line : notes.lines) { printRow("note", "{}", line); }
}

}  // namespace binosplat
