// Where eyes see the parts of a scene that came, went or faded.
#pragma once

#include "engine/geometry.h"
#include "engine/gpu/gpu_scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace binosplat {

// The most that a picture can handle. Beyond that, consecutive changes are merged into one, around all of
// them.
inline constexpr std::size_t kMostChanges = 256;

// The parts of the changes that are beyond `near` and in the picture. A change of a part's whole opacity
// counts as kChangedError.
std::vector<gpu::ChangedRect> rectsOf(std::span<const SceneChange> changes, const Eye& eye, double near);

// The share of an eye's tiles, 0 to 1, that show something that came or went, or faded by more than half.
double changedShare(std::span<const SceneChange> changes, const Eye& eye, double near);

}  // namespace binosplat
