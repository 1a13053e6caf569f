// PlayCanvas compressed PLY: 16 bytes per splat, relative to the bounds of its chunk of 256 splats.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

namespace binosplat {

// True if the file is a PLY whose header names a property packed_position.
bool isCompressedPly(InputFile& file);

// Reads, in this order, the elements chunk (min and max of position and logarithmic scale, optionally of
// colour, as float), vertex (packed_position, packed_rotation, packed_scale, packed_color, as uint) and, if
// present, sh (9, 24 or 45 f_rest, as uchar).
Scene readCompressedPly(InputFile& file, LoadNotes& notes, const Progress& progress);

}  // namespace binosplat
