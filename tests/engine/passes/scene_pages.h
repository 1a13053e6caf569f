// Scenes whose chunks come and go, for tests: neighbouring splats are loaded together.
#pragma once

#include "engine/files/sog_pack.h"
#include "engine/scene/pick_splats.h"
#include "engine/stream/resident_scene.h"
#include "tests/engine/frame/gpu_scenes.h"

namespace binosplat::test {

// All of it along a Morton curve.
inline Scene inMortonOrder(const Scene& scene) {
    return pickSplats(scene, mortonOrder(findSogPlaces(scene)));
}

inline std::uint32_t pagesOf(std::size_t splats) {
    return static_cast<std::uint32_t>((splats + gpu::kPageSplats - 1) / gpu::kPageSplats);
}

// A whole scene as one part, which the first frame brings to the device; `more` pages stay free.
class WholeInPages {
public:
    WholeInPages(const Context& context, const Scene& scene, std::uint32_t more = 0)
        : resident(context, traitsOf(scene),
                   {.capacity_pages = pagesOf(scene.size()) + more, .most_bytes_a_frame = 1u << 30}),
          part(resident.add(PackedPages(scene, resident.traits())).value()) {}

    ResidentScene resident;
    ResidentScene::Part part;
};

}  // namespace binosplat::test
