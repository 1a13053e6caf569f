// Scenes within gzip (garden.ply.gz), or alone in a zip archive.
#pragma once

#include "engine/disk_space.h"
#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace binosplat {

// True if a file's name ends like a scene's, packed or not.
bool hasSceneName(const std::filesystem::path& file);
// False if the extension is a different one, so that the file need not be opened. True for names that say
// nothing, such as 1 and frame.0001.
bool mayHaveScene(const std::filesystem::path& file);

// True for gzip and zip, except those of SPZ and SOG, which are formats of their own.
bool isPacked(InputFile& file);

struct Unpacking {
    std::uint64_t first_bytes = ~std::uint64_t{0};  // anything after that is not unpacked
    DiskSpace::Measure space = spaceIn;
};

// The scene in a packed file, as a file of its own; other files that it names are looked up in its archive.
// Throws Error for an archive that is broken or encrypted, or contains no scene or several, and for a scene
// that is more than 256 times as long as its packed bytes, or does not fit where temporary files are.
std::unique_ptr<InputFile> unpackScene(std::unique_ptr<InputFile> file, const Progress& progress,
                                       const Unpacking& how = {});
// A scene's file, unpacked if it is packed.
std::unique_ptr<InputFile> openUnpacked(const std::string& path, const Unpacking& how = {});

}  // namespace binosplat
