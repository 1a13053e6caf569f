// The panel in a frame.
#include "app/view/panel/panel.h"

#include "app/view/panel/panel_style.h"
#include "xr/images.h"

#include <utility>

namespace binosplat {

Panel::Panel(const Context& context, vk::Format format)
    : PanelPicture(context, format), in_room_(kPanelPx, kPanelWidthMetres) {}

PanelRequests Panel::layOut(ConnectedHeadset* hung, const PanelPointer& mouse, bool uses_mouse,
                            const ViewSettings& settings, double step_seconds) {
    // A mouse at rest does not count while a hand points, and a moving one takes over only once the hand has
    // released the trigger.
    const PanelPointer& hand = in_room_.pointer();
    const bool mouse_pointed = mouse_points_;
    mouse_points_ =
        hung != nullptr && hand.place_px ? uses_mouse && !hand.pressed : mouse_points_ || uses_mouse;
    PanelPointer pointer = mouse_points_ ? mouse : hand;
    // The other pointer must not continue a drag.
    if (mouse_points_ != mouse_pointed) { pointer.pressed = false; }
    PanelRequests requests = PanelPicture::layOut(pointer, settings, step_seconds);
    if (hung != nullptr && hung->panel_revision != canvas().revision()) {
        image_ = hung->panel_images.acquire();
    }
    return requests;
}

void Panel::record(Commands& commands, ConnectedHeadset* headset, bool copied) {
    if (!image_ && !copied) { return; }
    PanelPicture::record(commands);
    if (image_) {
        canvas().copyTo(commands, image_);
        makeMips(commands.buffer(), image_, kPanelPx, headset->panel_images.levels());
    }
}

void Panel::release(ConnectedHeadset& headset) {
    if (!std::exchange(image_, nullptr)) { return; }
    headset.panel_images.release();
    headset.panel_revision = canvas().revision();
}

void Panel::giveUp() {
    image_ = nullptr;
    canvas().giveUp();
}

}  // namespace binosplat
