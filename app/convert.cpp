// `binosplat convert`: any scene that can be read, as a PLY, an SPZ or a SOG file.
#include "app/commands.h"
#include "app/load.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/scene/scene_targets.h"

#include <filesystem>

namespace binosplat {

void runConvert(const ConvertOptions& options) {
    const std::string out = options.out.string();
    const SceneTarget& target = findSceneTarget(options.out);
    const std::filesystem::path folder = options.out.has_parent_path() ? options.out.parent_path() : ".";
    check(std::filesystem::is_directory(folder), "{}: cannot be written, {} must be a directory", out, folder.string());

    LoadNotes notes;
    Scene scene = loadWithProgress(options.scene, options.load, notes);
    if (options.crop) {
        const std::size_t before = scene.size();
        keepWithin(scene, glm::dvec3(*options.crop) - scene.origin, options.crop->w);
        check(scene.size() > 0, "{}: none of its {} splats lies within --crop {},{},{},{}", options.scene, before, options.crop->x,
              options.crop->y, options.crop->z, options.crop->w);
        notes.lines.push_back(fmt::format("{} of {} splats lie within the sphere of --crop", scene.size(), before));
    }
    target.write(scene, out, ProgressLine("writing " + out).progress());
    fmt::print("{}: {} splats ({}), SH degree {}, {} bytes\n", out, scene.size(), scene.isGaussian3d() ? "3D Gaussians" : "discs",
               scene.sh_degree, std::filesystem::file_size(options.out));
    fmt::print("  loses: {}\n", target.describeLoss(scene));
    for (const std::string& line : notes.lines) { fmt::print("  note: {}\n", line); }
}

}  // namespace binosplat
