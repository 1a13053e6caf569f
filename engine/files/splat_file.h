// .splat files: 32 bytes per splat, no header.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

namespace binosplat {

// The format has no magic number: a file is taken for one if its first splats have finite positions, scales
// of plausible size and quaternions of length 1. Ask this after all other formats.
bool isSplatFile(InputFile& file);

// Reads for each splat: position (3 floats), scale (3 floats, not logarithmic), red, green, blue, opacity
// (bytes), and quaternion w, x, y, z (bytes; 128 is zero). The colour is display-encoded; there are no SH.
Scene readSplatFile(InputFile& file, LoadNotes& notes, const Progress& progress);

}  // namespace binosplat
