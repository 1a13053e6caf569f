// Scenes within gzip (garden.ply.gz), or alone in a zip archive.
#pragma once

#include "engine/disk_room.h"
#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace binosplat {

// True if a file's name ends as those of scenes do, packed or not.
bool hasSceneName(const std::filesystem::path& file);
// False if it ends in other letters: nobody needs to look into that file. True for names that say nothing, such as 1 and frame.0001.
bool mayHaveScene(const std::filesystem::path& file);

// True for gzip and zip but those of SPZ and SOG, which are formats of their own.
bool isPacked(InputFile& file);

struct Unpacking {
    std::uint64_t first_bytes = ~std::uint64_t{0};  // what lies behind them is not unpacked
    DiskRoom::Measure room = roomIn;
};

// The scene in a packed file, as a file of its own; what it names beside it is looked for in its archive. Throws Error for an archive that
// is broken or encrypted, or that holds no scene or several, and for a scene that is more than 256 times as long as what it is packed in,
// or has no room where temporary files are.
std::unique_ptr<InputFile> unpackScene(std::unique_ptr<InputFile> file, const Progress& progress, const Unpacking& how = {});
// A scene's file, unpacked if it is packed.
std::unique_ptr<InputFile> openUnpacked(const std::string& path, const Unpacking& how = {});

}  // namespace binosplat
