// Where eyes see what of a scene came, went or faded.
#pragma once

#include "engine/geometry.h"
#include "engine/gpu/gpu_scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace binosplat {

// A picture takes so many; of more changes those that came one after another are taken for one, about all of them.
inline constexpr std::size_t kMostChanges = 256;

// As far as anything of them lies beyond `near`, and in the picture. A change of all of a part's opacity counts for kChangedError.
std::vector<gpu::ChangedRect> rectsOf(std::span<const SceneChange> changes, const Eye& eye, double near);

// The share of an eye's tiles in which something is seen that came or went, or faded by more than half, 0 to 1.
double changedShare(std::span<const SceneChange> changes, const Eye& eye, double near);

}  // namespace binosplat
