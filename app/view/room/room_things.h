// What hangs in the room besides the panel: hands or controllers, rays, where a wearer will stand, and the vignette. All are layers of
// their own, which the runtime blends over the scene: no frame of ours takes longer for them.
#pragma once

#include "app/view/room/hand_picture.h"
#include "engine/gpu/commands.h"
#include "xr/input.h"
#include "xr/layers.h"

namespace binosplat {

// What there is to draw in a frame.
struct RoomSight {
    glm::dvec3 eye{0.0};                           // the middle between the wearer's
    std::optional<std::array<xr::Hand, 2>> hands;  // absent: not to be drawn
    std::vector<Thing> things;                     // rays and what else there is
    std::optional<double> vignette_m;              // how wide
};

// At most so many layers, of 16 that every runtime takes: the vignette, two parts of each controller, a ray, the arc and its end.
class RoomThings {
public:
    // For as long as the session lasts, with images of `format`. What the runtime does not make is not drawn: see xr::Troubles.
    RoomThings(const xr::Session& session, const Context& context, vk::Format format);

    // Before anything is recorded: takes the images that a frame of this needs.
    void choose(const RoomSight& sight);
    // Between begin and submitAndWait.
    void record(Commands& commands);
    // After submitAndWait: gives back what choose() took.
    void release();
    // Whether that frame has any.
    [[nodiscard]] bool areShown() const { return vignette_.has_value() || !quads_.empty(); }
    // The runtime does not show them: from now on there are none.
    void giveUp();
    // Of the frame that was chosen last: behind the panel, and before it.
    void addBehindPanel(xr::Layers& layers) const;
    void addBeforePanel(xr::Layers& layers) const;

private:
    struct HandImage {
        xr::Swapchain images;
        Buffer texels;
        vk::Image now;         // of this frame; null: not taken
        TexelPicture picture;  // of this frame
    };
    void makeSheet(const xr::Session& session, const Context& context, vk::Format format);
    void chooseHand(const xr::Hand& hand, HandImage& image, const glm::dvec3& eye);
    [[nodiscard]] xr::LayerQuad quadOf(const Thing& thing) const;
    void add(const Thing& thing);

    xr::Troubles& troubles_;
    TexelLayout layout_;
    xr::Swapchain sheet_;  // none: nothing is drawn from it
    std::array<HandImage, 2> hands_;
    std::vector<xr::LayerQuad> quads_;  // before the panel
    std::optional<xr::LayerQuad> vignette_;
};

}  // namespace binosplat
