// `binosplat scene`: a built-in scene as a 2DGS PLY file.
#include "app/commands.h"
#include "app/terminal/progress.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/files/ply.h"

#include <filesystem>

namespace binosplat {

void runScene(const SceneOptions& options) {
    check(options.out.extension() == ".ply", "{}: --out must be a file whose name ends in .ply",
          options.out.string());
    const std::filesystem::path folder = options.out.has_parent_path() ? options.out.parent_path() : ".";
    check(std::filesystem::is_directory(folder), "{}: cannot be written, {} must be a directory",
          options.out.string(), folder.string());
    const std::string source = isBuiltin(options.name) ? options.name : "builtin:" + options.name;
    const Scene scene = makeBuiltin(source, options.splats, ProgressLine("making " + source).progress());
    writePly(scene, options.out.string(), ProgressLine("writing " + options.out.string()).progress());
}

}  // namespace binosplat
