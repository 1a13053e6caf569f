// SOG scenes, version 1 and 2: attributes as WebP pictures beside a meta.json, in a directory or bundled as
// .sog. Writes bundles of version 2.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <string>

namespace binosplat {

// True if the directory holds a meta.json.
bool isSogFolder(const std::string& folder);

// True if the file is a zip archive by its first bytes, as every .sog is, or a meta.json by its keys.
bool isSogFile(InputFile& file);

// Throws Error in a build that cannot decode WebP.
Scene readSogFolder(const std::string& folder, LoadNotes& notes, const Progress& progress);
Scene readSogFile(InputFile& file, LoadNotes& notes, const Progress& progress);

// Splats follow a Morton curve. Positions keep 16 bits of the range of their logarithms, rotations and
// opacities bytes; scales, colours and harmonics become one of 256 values each, and harmonics one of up to
// 65536 rows. Discs stay discs for readers that know "model": "2dgs". The file appears whole or not at all.
// Throws Error in a build that cannot encode WebP, and for more splats than a picture can have pixels.
void writeSog(const Scene& scene, const std::string& path, const Progress& progress = {});
// The same as the files of a new folder, meta.json and pictures, with the splats in the scene's order, for a
// chunk whose parts are identified by their places. A failure leaves the files written so far.
void writeSogFolder(const Scene& scene, const std::string& folder, const Progress& progress = {});
// The largest number of rows of harmonics.
std::size_t sogPaletteSize(const Scene& scene);

}  // namespace binosplat
