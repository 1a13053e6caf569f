// The panel, frame by frame: its content, what points at it, and where it is drawn: in the headset, in the
// window, or in both.
#pragma once

#include "app/view/headset/connected_headset.h"
#include "app/view/panel/panel_picture.h"
#include "app/view/room/panel_in_room.h"

namespace binosplat {

class Panel : public PanelPicture {
public:
    // `format` is the format of every session's images.
    Panel(const Context& context, vk::Format format);

    // The panel as a thing in the room.
    [[nodiscard]] PanelInRoom& inRoom() { return in_room_; }
    // Lays out the widgets, for the hand that points or for `mouse`; `uses_mouse`: the mouse did something
    // there. If they have changed, acquires an image of `hung`, the headset in whose room the panel hangs;
    // null: it does not hang in a room.
    PanelRequests layOut(ConnectedHeadset* hung, const PanelPointer& mouse, bool uses_mouse,
                         const ViewSettings& settings, double step_seconds);
    // Draws the widgets on that image. The canvas is also drawn if it is to be `copied` to a window.
    void record(Commands& commands, ConnectedHeadset* headset, bool copied);
    // After submission: the runtime may show that image.
    void release(ConnectedHeadset& headset);
    // Discards the last layout.
    void giveUp();

private:
    PanelInRoom in_room_;
    bool mouse_points_ = false;  // the mouse, not a hand
    vk::Image image_;            // to be drawn; null: none
};

}  // namespace binosplat
