// glTF 2.0 scenes with KHR_gaussian_splatting: a .gltf with its buffers inside or beside it, or a .glb.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

namespace binosplat {

// True if the file is a GLB, by its first bytes, or JSON with the keys of glTF.
bool isGltf(InputFile& file);

// All splats that the default scene's nodes place, in that scene's axes, with their harmonics rotated. Nodes
// without splats are left out, with a note.
Scene readGltf(InputFile& file, LoadNotes& notes, const Progress& progress);

// The Scene::origin that the reader of that file would choose.
glm::dvec3 originOfGltf(InputFile& file);

}  // namespace binosplat
