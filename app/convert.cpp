// `binosplat convert`: writes any scene that can be read as a PLY, an SPZ or a SOG file, or with levels of
// detail as a streamed SOG scene.
#include "app/commands.h"
#include "app/convert_levels.h"
#include "app/keep.h"
#include "app/load.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/files/scene_targets.h"

#include <filesystem>

namespace binosplat {

namespace {

void cropScene(const ConvertOptions& options, Scene& scene, LoadNotes& notes) {
    const std::size_t before = scene.size();
    keepWithin(scene, glm::dvec3(*options.crop) - scene.origin, options.crop->w);
    check(scene.size() > 0, "{}: none of its {} splats lies within --crop {},{},{},{}", options.scene, before,
          options.crop->x, options.crop->y, options.crop->z, options.crop->w);
    notes.lines.push_back(
        fmt::format("{} of {} splats lie within the sphere of --crop", scene.size(), before));
}

void thinOutScene(const ConvertOptions& options, const SceneTarget& target, Scene& scene, LoadNotes& notes) {
    const std::size_t before = scene.size();
    JudgedScene judged(options, scene);
    scene = judged.keep(judged.countOf(*options.keep, target));
    notes.lines.push_back(
        fmt::format("{} of {} splats are kept, those that show most", scene.size(), before));
}

// The size of a file, or of everything in its folder.
std::uintmax_t bytesWritten(const ConvertOptions& options) {
    if (!options.isStreamed()) { return std::filesystem::file_size(options.out); }
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(options.out.parent_path())) {
        if (entry.is_regular_file()) { bytes += entry.file_size(); }
    }
    return bytes;
}

}  // namespace

void runConvert(const ConvertOptions& options) {
    const std::string out = options.out.string();
    const bool is_streamed = options.isStreamed();
    const SceneTarget& target = findSceneTarget(is_streamed ? "chunk.sog" : options.out);
    const std::filesystem::path folder = options.out.has_parent_path() ? options.out.parent_path() : ".";
    check(is_streamed || std::filesystem::is_directory(folder),
          "{}: cannot be written, {} must be a directory", out, folder.string());

    LoadNotes notes;
    const auto load = [&] {
        Scene scene = loadWithProgress(options.scene, options.load, notes);
        if (options.crop) { cropScene(options, scene, notes); }
        if (options.keep) { thinOutScene(options, target, scene, notes); }
        return scene;
    };
    WrittenLevels written;
    if (is_streamed) {
        written = writeLevels(options, load, notes);
    } else {
        written.sample = load();
        written.splats = written.sample.size();
        target.write(written.sample, out, ProgressLine("writing " + out).progress());
    }
    const Scene& scene = written.sample;
    const std::string what = fmt::format("{} splats ({}), SH degree {}", written.splats,
                                         scene.isGaussian3d() ? "3D Gaussians" : "discs", scene.sh_degree);
    const std::string loses = target.describeLoss(scene);
    fmt::print("{}: {}, {} bytes\n  loses: {}\n", out, what, bytesWritten(options), loses);
    for (const std::string& line : notes.lines) { fmt::print("  note: {}\n", line); }
}

}  // namespace binosplat
