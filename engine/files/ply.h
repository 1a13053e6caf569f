// Reads and writes PLY files of Gaussian splats as the training of 2DGS and 3DGS makes them.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <functional>
#include <string>

namespace binosplat {

// True if the file is a PLY, by its first line.
bool isPly(InputFile& file);

// Reads element `vertex` with x y z, f_dc_0..2, f_rest_0.. (none, 9, 24, 45, or 72 of which the highest band
// is left out; channel-major), opacity (logit), scale_0 scale_1 [scale_2] (logarithms) and rot_0..3 (w, x, y,
// z), each also as scalar_NAME; in any order and scalar type, ascii or binary. Splats that move are read as
// the still of one moment. Anything else in the file is ignored, except a comment that asks for antialiasing.
// For a point cloud, a mesh or anchors, throws an Error that says so.
Scene readPly(InputFile& file, LoadNotes& notes, const Progress& progress);

// The same in parts of about `part_splats` splats each, one after the other, for a scene larger than the
// memory. A part has only the bands that its own splats use. The notes are about all parts.
void readPlyParts(InputFile& file, std::uint64_t part_splats, LoadNotes& notes,
                  const std::function<void(Scene)>& take);

// The number of splats that the header states.
std::uint64_t countPly(InputFile& file);

// The Scene::origin that the reader of that file would choose.
glm::dvec3 originOfPly(InputFile& file);

// Writes the 2DGS layout in binary little-endian: x y z nx ny nz f_dc f_rest opacity scale_0 scale_1
// rot_0..3, with the normal along t_w, and for an antialiased scene a comment that says so. If the scene has
// an origin, positions are float64 and relative to 0 again. Opacities 0 and 1 and scale 0 are stored as large
// finite numbers that read back exactly. The file appears whole or not at all.
void writePly(const Scene& scene, const std::string& path, const Progress& progress = {});

}  // namespace binosplat
