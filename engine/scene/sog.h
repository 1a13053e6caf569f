// SOG scenes, version 1 and 2: attributes as WebP pictures beside a meta.json, in a directory or bundled as .sog.
#pragma once

#include "engine/scene/input_file.h"
#include "engine/scene/scene.h"

#include <string>

namespace binosplat {

// Whether the directory holds a meta.json.
bool isSogFolder(const std::string& folder);

// Whether the file is a zip archive, as every .sog is, by its first bytes; or a meta.json itself, by its keys.
bool isSogFile(InputFile& file);

// Throws Error in a build that cannot decode WebP.
Scene readSogFolder(const std::string& folder, LoadNotes& notes, const Progress& progress);
Scene readSogFile(InputFile& file, LoadNotes& notes, const Progress& progress);

}  // namespace binosplat
