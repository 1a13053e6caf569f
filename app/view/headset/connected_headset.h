// The viewer's objects of one session with the headset. A session may be lost, and another one takes its
// place.
#pragma once

#include "app/view/headset/images_ahead.h"
#include "app/view/headset/lens_mask.h"
#include "app/view/room/room_things.h"
#include "xr/extensions/foveated_inset.h"
#include "xr/input.h"
#include "xr/layers.h"

#include <memory>
#include <optional>

namespace binosplat {

struct ConnectedHeadset {
    // `panel_px` is the size of the panel's picture. The session has foveated insets if `instance` was asked
    // for them and the headset takes them. Throws xr::Lost if the session is lost at once.
    ConnectedHeadset(const xr::Instance& instance, const Context& context, glm::uvec2 panel_px);

    // Both eyes' images, and those of their insets: to be drawn, filled with a colour, and to be shown.
    void acquireEyes();
    void clearEyes(Commands& commands, const glm::vec4& colour);
    void releaseEyes();

    std::optional<xr::InsetSizes> inset;  // as recommended
    xr::Session session;
    vk::Format format;
    std::vector<double> refresh_rates;
    xr::Input input;
    xr::Swapchain panel_images;
    std::uint64_t panel_revision = 0;  // of the canvas that they show; 0: none yet
    RoomThings things;
    std::unique_ptr<EyeImages> images;        // once their size is known
    std::unique_ptr<EyeImages> inset_images;  // with them, in a session with insets
    ImagesAhead images_ahead;
    LensMask lens_mask;

private:
    template <typename Act>
    void forEyes(const Act& act);
};

}  // namespace binosplat
