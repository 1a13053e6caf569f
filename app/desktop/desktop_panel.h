// The panel beside the scene in a window: what mouse and keys do about it, and when it is laid out.
#pragma once

#include "app/desktop/desktop_window.h"
#include "app/terminal/frame_log.h"
#include "app/view/panel/panel_picture.h"
#include "app/view/settings/view_state.h"
#include "app/view/window/window_drawing.h"

namespace binosplat {

// What a key asks for, if it does what buttons of a panel with this status do; `key` is GLFW's.
[[nodiscard]] PanelRequests requestsOf(int key, const ViewSettings& settings, const PanelStatus& now);

class DesktopPanel {
public:
    // Both must outlive this.
    DesktopPanel(const Context& context, const FrameLog& log);

    [[nodiscard]] PanelPicture& picture() { return picture_; }
    [[nodiscard]] bool isTyping() const { return picture_.entry().isOpen(); }
    // In the log and on the panel.
    void say(const std::string& message);
    void toggleHelp(ViewState& state);
    void setFillsScreen(bool fills_screen) { picture_.status().window->fills_screen = fills_screen; }

    // True if an event is meant for the panel. After one of the mouse it is to be laid out before the next
    // one, since a click may begin and end between two pictures. `part`: of the window, where it is;
    // `is_free`: the mouse drags nothing else.
    bool takesText(const DesktopEvent& event);
    bool takesMouse(const DesktopEvent& event, const WindowPart& part, bool is_free);
    // True if it is to be laid out without a wait.
    [[nodiscard]] bool isDue() const { return layouts_due_ > 0; }
    PanelRequests layOut(const ViewSettings& settings, double seconds);
    // The scene was drawn.
    void keepFrameTime();

private:
    const FrameLog& log_;
    PanelPicture picture_;
    PanelPointer pointer_;
    int layouts_due_ = 2;  // widgets settle one layout after input
};

}  // namespace binosplat
