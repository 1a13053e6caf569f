// What the viewer has of the headset for as long as one session lasts. A session may be lost, and another one takes its place.
#pragma once

#include "app/view/headset/eye_images.h"
#include "app/view/headset/lens_mask.h"
#include "app/view/room/room_things.h"
#include "xr/input.h"
#include "xr/layers.h"

#include <memory>

namespace binosplat {

struct ConnectedHeadset {
    // `panel_px` is the size of the panel's picture. Throws xr::Lost where the session is lost at once.
    ConnectedHeadset(const xr::Instance& instance, const Context& context, glm::uvec2 panel_px);

    xr::Session session;
    vk::Format format;
    std::vector<double> refresh_rates;
    xr::Input input;
    xr::Swapchain panel_images;
    std::uint64_t panel_revision = 0;  // of the canvas, that they show; 0: none yet
    RoomThings things;
    std::unique_ptr<EyeImages> images;  // once their size is known
    LensMask lens_mask;
};

}  // namespace binosplat
