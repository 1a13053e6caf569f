// Things in the room besides the panel: hands or controllers, rays, the teleport target, and the vignette.
// All are layers of their own, which the runtime blends over the scene, so that our frames take no longer for
// them.
#pragma once

#include "app/view/room/arc_picture.h"
#include "app/view/room/hand_picture.h"
#include "engine/gpu/commands.h"
#include "xr/input.h"
#include "xr/layers.h"

namespace binosplat {

// How wide a message is, a metre away: like a newspaper.
inline constexpr double kMessageMetres = 0.8;

// The things to draw in a frame.
struct RoomSight {
    glm::dvec3 eye{0.0};                           // the midpoint between the wearer's eyes
    std::optional<std::array<xr::Hand, 2>> hands;  // absent: not to be drawn
    std::vector<Thing> things;                     // rays and others
    const Arc* arc = nullptr;                      // of a teleport; null: none
    std::optional<double> vignette_m;              // its width
    // A line of text in front of the head: redrawn if there is a picture, otherwise as it was.
    bool has_message = false;
    std::optional<TexelPicture> message;
    glm::dvec3 message_place{0.0};  // of its middle, in the head's axes
};

// Together they fit into the 16 layers that every runtime accepts: the vignette, two parts of each
// controller, a ray, the arc's pieces and its end, a message.
class RoomThings {
public:
    // For the session's lifetime, with images of `format`. Things whose images the runtime cannot make are
    // not drawn: see xr::Troubles.
    RoomThings(const xr::Session& session, const Context& context, vk::Format format);

    // Before anything is recorded: acquires the images that this frame needs.
    void choose(const RoomSight& sight);
    // After choose(): darkens the whole view, in place of a vignette; 0: not at all. `width_m`: see
    // coverMetres().
    void darken(double darkness, double width_m);
    // Between begin and submitAndWait.
    void record(Commands& commands);
    // After submitAndWait: releases what choose() acquired.
    void release();
    // The layout for pictures of it.
    [[nodiscard]] const TexelLayout& layout() const { return layout_; }
    // True if that frame has any things.
    [[nodiscard]] bool areShown() const { return vignette_.has_value() || !quads_.empty(); }
    // For a runtime that does not show them: from now on nothing is drawn.
    void giveUp();
    // Add the layers of the last chosen frame: those behind the panel, and those in front of it.
    void addBehindPanel(xr::Layers& layers) const;
    void addBeforePanel(xr::Layers& layers) const;

private:
    struct DrawnImage {
        xr::Swapchain images;
        Buffer texels;
        vk::Image now;         // of this frame; null: not acquired
        TexelPicture picture;  // of this frame
    };
    [[nodiscard]] std::array<DrawnImage*, 4> drawnImages() {
        return {&hands_[kLeft], &hands_[kRight], &arc_, &message_};
    }
    void chooseMessage(const std::optional<TexelPicture>& picture, const glm::dvec3& place);
    void makeSheet(const xr::Session& session, const Context& context, vk::Format format);
    void chooseHand(const xr::Hand& hand, DrawnImage& image, const glm::dvec3& eye);
    void chooseArc(const Arc& arc, const glm::dvec3& eye);
    [[nodiscard]] xr::LayerQuad quadOf(const Thing& thing) const;
    void add(const Thing& thing);

    xr::Troubles& troubles_;
    TexelLayout layout_;
    xr::Swapchain sheet_;  // none: nothing is drawn from it
    HandDrawing hand_drawing_;
    std::array<DrawnImage, 2> hands_;
    DrawnImage arc_;
    DrawnImage message_;
    std::vector<xr::LayerQuad> quads_;  // before the panel
    std::optional<xr::LayerQuad> vignette_;
};

}  // namespace binosplat
