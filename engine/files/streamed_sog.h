// Streamed SOG scenes: a lod-meta.json beside folders or bundles that are SOG scenes themselves, in levels of
// detail. Reads one whole level.
#pragma once

#include "engine/files/input_file.h"
#include "engine/files/load_scene.h"

#include <string>

namespace binosplat {

// True if the directory holds a lod-meta.json.
bool isStreamedSogFolder(const std::string& folder);

// True if the file is a lod-meta.json, by its name, as the format has it, or by its keys.
bool isStreamedSogFile(InputFile& file);

// All splats that the leaves have at the chosen level, and the environment's: chunk by chunk in the order of
// the list of names, and those of a chunk in their own order. A leaf without that level shows its next
// coarser one, or nothing if it only has finer ones. A missing environment is left out. Throws Error in a
// build that cannot decode WebP.
Scene readStreamedSogFolder(const std::string& folder, const LevelChoice& choice, LoadNotes& notes,
                            const Progress& progress);
Scene readStreamedSogFile(InputFile& file, const LevelChoice& choice, LoadNotes& notes,
                          const Progress& progress);

}  // namespace binosplat
