// .ksplat scenes (GaussianSplats3D), version 0.1: sections of splats as floats (level 0), or as half floats
// with positions relative to the centre of a bucket (levels 1 and 2; level 2 has harmonics in bytes).
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

namespace binosplat {

// True if the file begins with such a header; the format has no magic number.
bool isKsplat(InputFile& file);

Scene readKsplat(InputFile& file, LoadNotes& notes, const Progress& progress);

}  // namespace binosplat
