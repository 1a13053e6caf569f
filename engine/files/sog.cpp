// A SOG scene as a whole.
#include "engine/files/sog.h"

#include "engine/error.h"
#include "engine/files/json_node.h"
#include "engine/files/scene_builder.h"
#include "engine/files/sog_splats.h"

#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {

Scene readSog(const std::string& source, std::unique_ptr<SogFiles> files, LoadNotes& notes,
              const Progress& progress) {
    SogSplats splats(std::move(files));
    splats.expect();
    if (progress) { progress(0.0); }
    const SogPictures pictures = splats.decode();
    SceneBuilder builder(source, splats.count(), splats.shDegree(), true);
    const auto second_half = [&](double share) { progress(0.5 + 0.5 * share); };
    splats.append(pictures, {0, splats.count()}, splats.shDegree(), builder,
                  progress ? Progress(second_half) : Progress());
    if (progress) { progress(1.0); }
    Scene scene = builder.finish(notes);
    scene.antialiased = splats.antialiased();
    if (splats.discs()) { takeAsDiscs(scene, notes); }
    return scene;
}

bool isArchive(InputFile& file) { return file.peek(4) == std::string_view("PK\x03\x04", 4); }

}  // namespace

bool isSogFolder(const std::string& folder) {
    std::error_code unreadable;
    return std::filesystem::is_regular_file(std::filesystem::path(folder) / "meta.json", unreadable);
}

bool isSogFile(InputFile& file) {
    if (isArchive(file)) { return true; }
    const std::string_view start = file.peek(4096);
    return startsObject(start) && start.find("\"means\"") != std::string_view::npos;
}

Scene readSogFolder(const std::string& folder, LoadNotes& notes, const Progress& progress) {
    requireSogDecoder(folder);
    return readSog(folder, openSogFolder(folder), notes, progress);
}

Scene readSogFile(InputFile& file, LoadNotes& notes, const Progress& progress) {
    requireSogDecoder(file.name());
    if (isArchive(file)) { return readSog(file.name(), openSogBundle(file), notes, progress); }
    if (file.others() != nullptr) {
        return readSog(file.name(), openSogFolder(*file.others(), ""), notes, progress);
    }
    const std::filesystem::path path(file.name());
    check(path.filename() == "meta.json",
          "{}: the meta.json of a SOG scene under another name, expected that name", file.name());
    return readSogFolder(path.has_parent_path() ? path.parent_path().string() : ".", notes, progress);
}

}  // namespace binosplat
