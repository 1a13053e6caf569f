// `binosplat info`: the contents of a scene, and what rendering it will leave out.
#include "app/commands.h"
#include "app/load.h"
#include "app/options/start_view.h"
#include "app/summary/describe.h"
#include "app/summary/survey.h"
#include "engine/gpu/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace binosplat {

namespace {

template <typename... Args>
void printRow(const char* name, fmt::format_string<Args...> format, Args&&... args) {
    fmt::print("{:<18} {}\n", name, fmt::format(format, std::forward<Args>(args)...));
}

void printQuantiles(const char* name, const std::array<float, 5>& quantiles) {
    printRow(name, "{:.4g}  {:.4g}  {:.4g}  {:.4g}  {:.4g}", quantiles[0], quantiles[1], quantiles[2],
             quantiles[3], quantiles[4]);
}

std::string nameKind(const Scene& scene, const LoadNotes& notes) {
    if (!notes.three_scales) { return "2DGS: drawn as discs"; }
    const std::string how = !scene.isGaussian3d() ? "flattened to discs"
                            : scene.antialiased   ? "drawn as 3D Gaussians, antialiased"
                                                  : "drawn as 3D Gaussians";
    return fmt::format("3DGS: {}; the median splat is {:.3g} times as thick as its second axis", how,
                       notes.median_flatness);
}

double mebibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

void printOrigin(const Scene& scene, const LoadNotes& notes) {
    if (scene.origin != glm::dvec3(0.0)) {
        printRow("origin", "{}: positions in memory are relative to it", describeOrigin(scene));
    }
    printRow("axes", "{}",
             notes.axes.empty()
                 ? "the file does not say; taken as a training's: x right, y down, z front; right-handed"
                 : notes.axes);
    printRow("colour space", "{}",
             !notes.colour_space.empty()
                 ? notes.colour_space
                 : "the file does not say; taken as a training's: display-encoded (sRGB)");
    if (scene.is_linear) { printRow("", "blended as light, encoded at the end"); }
}

void printSurvey(const Scene& scene, const SceneSurvey& survey) {
    const auto share = [&](const char* name, std::uint64_t splats, const std::string& what) {
        printRow(
            name, "{:>6.2f} %  {} splats: {}",
            100.0 * static_cast<double>(splats) / static_cast<double>(std::max<std::size_t>(scene.size(), 1)),
            splats, what);
    };
    printRow("size",
             "{:.4g}: the longest side of the box with the middle 90 % of the centres along each axis",
             survey.size);
    share("made of", survey.transparent, "opacity under 1/255, never seen");
    share("", survey.opaque, "over 99 % opaque");
    share("", survey.thin,
          fmt::format("thinner than a millimetre ({}, one standard deviation; a unit is a metre)",
                      scene.isGaussian3d() ? "the shortest axis" : "the shorter axis of a disc"));
    share("", survey.large, "larger than a tenth of the size");
    share("", survey.floaters,
          fmt::format(
              "floaters: seen, but alone (fewer than {} splats within one to two fiftieths of the size)",
              kFewNeighbours));
}

// The scene's memory on the GPU, and ways to need less.
void printDeviceMemory(const Scene& scene, const LoadNotes& notes, const SceneSurvey& survey) {
    const auto bytesOf = [&](std::uint64_t splats, int sh_degree) {
        return splats * deviceBytesPerSplat(sh_degree, scene.isGaussian3d());
    };
    const std::uint64_t bytes = bytesOf(scene.size(), scene.sh_degree);
    printRow("", "{} bytes ({:.1f} MiB) on the GPU, {} a splat; a frame's own lists come on top", bytes,
             mebibytes(bytes), deviceBytesPerSplat(scene.sh_degree, scene.isGaussian3d()));
    std::vector<std::string> ways;
    if (notes.level + 1 < notes.level_splats.size()) {
        const std::uint64_t splats = notes.level_splats[notes.level + 1] + notes.environment_splats;
        ways.push_back(fmt::format("--lod {}: {:.1f} MiB", notes.level + 1,
                                   mebibytes(bytesOf(splats, scene.sh_degree))));
    }
    if (scene.sh_degree > 0) {
        ways.push_back(fmt::format("--sh-degree 0: {:.1f} MiB", mebibytes(bytesOf(scene.size(), 0))));
    }
    if (survey.half_radius > 0.0) {
        // The factor makes up for the rounding of the numbers, and more.
        ways.push_back(fmt::format("convert --crop={},{:.4g} keeps half of the splats",
                                   describePlace(survey.middle + scene.origin, survey.half_radius),
                                   1.002 * survey.half_radius));
    }
    for (std::size_t i = 0; i < ways.size(); ++i) { printRow(i == 0 ? "  if too much" : "", "{}", ways[i]); }
}

// The start view, and the reason for it.
void printStart(const Scene& scene) {
    const auto [view, why, up_why] = startView(scene);
    const double distance = glm::distance(view.eye, view.look);
    printRow("start", "{} looking at {}, {}", describePlace(view.eye + scene.origin, distance),
             describePlace(view.look + scene.origin, distance), why);
    printRow("up", "{}: {}", describePlace(0.001 * glm::round(1000.0 * view.up) + 0.0, 1.0), up_why);
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
    if (notes.environment_splats > 0) {
        printRow("", "environment: {} splats (loaded)", notes.environment_splats);
    }
    printRow("splats in file", "{}", notes.splats_in_file);
    printRow("skipped", "{} not finite, {} with a rotation of length zero", notes.skipped_not_finite,
             notes.skipped_zero_rotation);
    const glm::dvec3 low(summary.min_position), high(summary.max_position);
    const double extent = glm::distance(low, high);
    printRow("bounds", "{} to {}", describePlace(low + scene.origin, extent),
             describePlace(high + scene.origin, extent));
    printRow("SH degree", "{} (file: {})", summary.sh_degree, notes.sh_degree_in_file);
    for (int band = 1; band <= summary.sh_degree; ++band) {
        printRow("", "band {}: {} splats", band, summary.splats_using_band[static_cast<std::size_t>(band)]);
    }
    printRow("kind", "{}", nameKind(scene, notes));
    printOrigin(scene, notes);
    const SceneSurvey survey = surveyScene(scene);
    printSurvey(scene, survey);
    printRow("quantiles", "0, 5, 50, 95, 100 % of the splats");
    printQuantiles("  opacity", summary.opacity_quantiles);
    printQuantiles("  scale", summary.scale_quantiles);
    printQuantiles("  aspect", summary.aspect_quantiles);
    printRow("memory", "{} bytes ({:.1f} MiB) on the host", summary.host_bytes,
             mebibytes(summary.host_bytes));
    printDeviceMemory(scene, notes, survey);
    printStart(scene);
    for (const std::string& phrase : summary.left_out) { printRow("left out", "{}", phrase); }
    for (const std::string& line : notes.lines) { printRow("note", "{}", line); }
}

}  // namespace binosplat
