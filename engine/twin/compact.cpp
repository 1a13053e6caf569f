// Twin of compact: lists the visible splats without gaps, with the camera z of their centres or their
// distance.
#include "engine/parallel.h"
#include "engine/twin/splat.h"

namespace binosplat::reference {

Visible compact(const Scene& scene, std::span<const std::uint8_t> visible, const Eye& order_eye,
                const Settings& settings) {
    Visible result;
    for (std::size_t i = 0; i < visible.size(); ++i) {
        if (visible[i] != 0) { result.splats.push_back(static_cast<std::uint32_t>(i)); }
    }
    result.depths.resize(result.splats.size());
    const EyeFrame frame(order_eye);
    forBlocks(result.splats.size(), 16384, settings.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 position(scene.positions[result.splats[i]]);
            if (settings.order_from) {
                const glm::dvec3 from_middle = position - *settings.order_from;
                result.depths[i] = glm::dot(from_middle, from_middle);
            } else {
                // The same product as in `project`, so that equal depths are equal in both.
                result.depths[i] = (frame.camera_from_world * (position - frame.position_world)).z;
            }
        }
    });
    return result;
}

}  // namespace binosplat::reference
