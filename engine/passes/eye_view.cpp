// Eyes in the device's numbers.
#include "engine/passes/eye_view.h"

#include "engine/passes/frame_buffers.h"

namespace binosplat {
namespace {

// Splits a value into the two floats that the device holds. Through memory: g++ 12 vectorizes two components
// and takes a double that was rounded to a float for the double itself, which leaves nothing of the
// remainder.
template <typename Wide, typename Narrow>
void split(const Wide& value, Narrow& high, Narrow& low) {
    for (glm::length_t i = 0; i < value.length(); ++i) {
        const volatile float rounded = static_cast<float>(value[i]);
        high[i] = rounded;
        low[i] = static_cast<float>(value[i] - static_cast<double>(rounded));
    }
}

}  // namespace

gpu::EyeView viewOf(const Eye& eye, double near) {
    const glm::dmat3 world_from_camera = glm::mat3_cast(eye.world_from_camera.orientation);
    const Intrinsics& k = eye.intrinsics;
    gpu::EyeView view{};
    split(world_from_camera[0], view.camera_from_world_x, view.camera_from_world_x_low);
    split(world_from_camera[1], view.camera_from_world_y, view.camera_from_world_y_low);
    split(world_from_camera[2], view.camera_from_world_z, view.camera_from_world_z_low);
    split(eye.world_from_camera.position, view.position, view.position_low);
    split(glm::dvec2(k.fx, k.fy), view.focal_px, view.focal_px_low);
    split(glm::dvec2(k.cx, k.cy), view.principal_px, view.principal_px_low);
    view.size_px = eye.size_px;
    view.size_tiles = tilesOf(eye.size_px);
    const auto own_pixel = static_cast<float>(eye.own_pixel_px);
    view.low_pass = gpu::kLowPass / (own_pixel * own_pixel);
    view.screen_variance = gpu::kScreenVariance * own_pixel * own_pixel;
    view.near = static_cast<float>(near);
    view.max_inverse_depth = static_cast<float>(1.0 / near);
    return view;
}

gpu::Place placeOf(const glm::dvec3& position) {
    gpu::Place place{};
    split(position, place.position, place.position_low);
    return place;
}

}  // namespace binosplat
