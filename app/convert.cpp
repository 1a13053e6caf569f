// `binosplat convert`: any scene that can be read, as a PLY, an SPZ or a SOG file, or with levels of detail as a streamed SOG scene.
#include "app/commands.h"
#include "app/keep.h"
#include "app/load.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/files/scene_targets.h"
#include "engine/files/streamed_write.h"
#include "engine/levels/scene_levels.h"
#include "engine/places/standpoint.h"

#include <filesystem>

namespace binosplat {

namespace {

constexpr std::uint64_t kFewSplats = 50000;  // that no level halves
constexpr std::uint32_t kMostLevels = 10;

void cropScene(const ConvertOptions& options, Scene& scene, LoadNotes& notes) {
    const std::size_t before = scene.size();
    keepWithin(scene, glm::dvec3(*options.crop) - scene.origin, options.crop->w);
    check(scene.size() > 0, "{}: none of its {} splats lies within --crop {},{},{},{}", options.scene, before, options.crop->x,
          options.crop->y, options.crop->z, options.crop->w);
    notes.lines.push_back(fmt::format("{} of {} splats lie within the sphere of --crop", scene.size(), before));
}

void thinOutScene(const ConvertOptions& options, const SceneTarget& target, Scene& scene, LoadNotes& notes) {
    const std::size_t before = scene.size();
    JudgedScene judged(options, scene);
    scene = judged.keep(judged.countOf(*options.keep, target));
    notes.lines.push_back(fmt::format("{} of {} splats are kept, those that show most", scene.size(), before));
}

std::uint32_t levelsFor(std::uint64_t splats) {
    std::uint32_t levels = 1;
    while (levels < kMostLevels && splats >> levels >= kFewSplats / 2) { ++levels; }
    return levels;
}

// Of a file, or of all that lies beside it in its folder.
std::uintmax_t bytesWritten(const ConvertOptions& options) {
    if (!options.isStreamed()) { return std::filesystem::file_size(options.out); }
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(options.out.parent_path())) {
        if (entry.is_regular_file()) { bytes += entry.file_size(); }
    }
    return bytes;
}

void writeLevels(const ConvertOptions& options, Scene scene, LoadNotes& notes) {
    StreamedWriteSettings files;
    if (options.chunk_splats != 0) { files.chunk_splats = options.chunk_splats; }
    StreamedWriter writer(options.out, files);
    LevelSettings settings;
    settings.levels = options.levels != 0 ? options.levels : levelsFor(scene.size());
    settings.near = usualNear(scene);
    ProgressLine line("writing " + options.out.string());
    if (settings.levels > 1) {
        settings.eyes = judgingEyes(options, scene);
        const Context context({.device = options.device});
        writeSceneLevels(context, std::move(scene), settings, writer, line.progress());
    } else {
        writer.cutLeaves(scene.positions);
        writer.add(0, scene, {}, 0, line.progress());
    }
    writer.finish();
    for (std::size_t level = 0; level < writer.counts().size(); ++level) {
        notes.lines.push_back(fmt::format("level {}: {} splats", level, writer.counts()[level]));
    }
}

}  // namespace

void runConvert(const ConvertOptions& options) {
    const std::string out = options.out.string();
    const bool is_streamed = options.isStreamed();
    const SceneTarget& target = findSceneTarget(is_streamed ? "chunk.sog" : options.out);
    const std::filesystem::path folder = options.out.has_parent_path() ? options.out.parent_path() : ".";
    check(is_streamed || std::filesystem::is_directory(folder), "{}: cannot be written, {} must be a directory", out, folder.string());

    LoadNotes notes;
    Scene scene = loadWithProgress(options.scene, options.load, notes);
    if (options.crop) { cropScene(options, scene, notes); }
    if (options.keep) { thinOutScene(options, target, scene, notes); }
    const std::string what =
        fmt::format("{} splats ({}), SH degree {}", scene.size(), scene.isGaussian3d() ? "3D Gaussians" : "discs", scene.sh_degree);
    const std::string loses = target.describeLoss(scene);
    if (is_streamed) {
        writeLevels(options, std::move(scene), notes);
    } else {
        target.write(scene, out, ProgressLine("writing " + out).progress());
    }
    fmt::print("{}: {}, {} bytes\n  loses: {}\n", out, what, bytesWritten(options), loses);
    for (const std::string& line : notes.lines) { fmt::print("  note: {}\n", line); }
}

}  // namespace binosplat
