// Streamed SOG scenes: a lod-meta.json beside folders or bundles that are SOG scenes themselves, in levels of detail. One level is read,
// whole.
#pragma once

#include "engine/files/input_file.h"
#include "engine/files/load_scene.h"

#include <string>

namespace binosplat {

// True if the directory holds a lod-meta.json.
bool isStreamedSogFolder(const std::string& folder);

// True if the file is a lod-meta.json, by its name, as in the format, or by its keys.
bool isStreamedSogFile(InputFile& file);

// All splats that the leaves have at the chosen level, and the environment's: chunk by chunk in the order of their names' list, those of a
// chunk in its own order. A leaf without the level shows its next coarser one, or has no splats there if it has finer ones alone. A missing
// environment is left out. Throws Error in a build that cannot decode WebP.
Scene readStreamedSogFolder(const std::string& folder, const LevelChoice& choice, LoadNotes& notes, const Progress& progress);
Scene readStreamedSogFile(InputFile& file, const LevelChoice& choice, LoadNotes& notes, const Progress& progress);

}  // namespace binosplat
