// SOG scenes, version 1 and 2: attributes as WebP pictures beside a meta.json, in a directory or bundled as .sog. Bundles of version 2 are
// written.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <string>

namespace binosplat {

// True if the directory holds a meta.json.
bool isSogFolder(const std::string& folder);

// True if the file is a zip archive, as every .sog is, by its first bytes; or a meta.json itself, by its keys.
bool isSogFile(InputFile& file);

// Throws Error in a build that cannot decode WebP.
Scene readSogFolder(const std::string& folder, LoadNotes& notes, const Progress& progress);
Scene readSogFile(InputFile& file, LoadNotes& notes, const Progress& progress);

// Splats go along a Morton curve. Positions keep 16 bits of their logarithms' range, rotations and opacities bytes; scales, colours and
// harmonics are one of 256 values each, and harmonics one of up to 65536 rows. Discs stay discs where readers know "model": "2dgs". The
// file appears whole or not at all. Throws Error in a build that cannot encode WebP, and for more splats than pictures have pixels.
void writeSog(const Scene& scene, const std::string& path, const Progress& progress = {});
// The same with the splats in the scene's order, for a chunk whose parts somebody names by their places.
void writeSogInOrder(const Scene& scene, const std::string& path, const Progress& progress = {});
// The same as the files of a folder, which is made: meta.json and pictures. A failure leaves what was written so far.
void writeSogFolder(const Scene& scene, const std::string& folder, const Progress& progress = {});
// How many rows of harmonics at most.
std::size_t sogPaletteSize(const Scene& scene);

}  // namespace binosplat
