// loadScene: which reader a source belongs to.
#include "engine/scene/scene.h"

#include "engine/error.h"
#include "engine/scene/input_file.h"
#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"

#include <array>
#include <filesystem>

namespace binosplat {

namespace {

// A file format: known by its content, never by its name. A new one is one more file and one more line below.
struct FileFormat {
    const char* name;
    bool (*matches)(InputFile& file);
    Scene (*read)(InputFile& file, LoadNotes& notes, const Progress& progress);
};
constexpr std::array<FileFormat, 1> kFileFormats{{
    {"PLY (2DGS or 3DGS)", isPly, readPly},
}};

std::string listFormats() {
    std::string names;
    for (const FileFormat& format : kFileFormats) { names += (names.empty() ? "" : ", ") + std::string(format.name); }
    return names;
}

}  // namespace

Scene loadScene(const std::string& source, std::uint64_t builtin_splats, LoadNotes* notes, const Progress& progress) {
    LoadNotes ignored;
    LoadNotes& met = notes != nullptr ? *notes : ignored;
    met = {};
    if (isBuiltin(source)) {
        Scene scene = makeBuiltin(source, builtin_splats, progress);
        met.splats_in_file = scene.size();
        met.sh_degree_in_file = scene.sh_degree;
        return scene;
    }
    check(!std::filesystem::is_directory(source), "{}: is a directory, expected a scene file: {}", source, listFormats());
    InputFile file(source);
    check(file.sizeBytes() > 0, "{}: is empty, expected a scene file: {}", source, listFormats());
    for (const FileFormat& format : kFileFormats) {
        if (format.matches(file)) { return format.read(file, met, progress); }
    }
    fail("{}: not a scene file of a known format, expected {} or builtin:NAME", source, listFormats());
}

}  // namespace binosplat
