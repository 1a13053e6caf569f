// The panel in a frame.
#include "app/view/panel/panel.h"

#include "app/view/panel/panel_style.h"

#include <utility>

namespace binosplat {

namespace {

constexpr std::size_t kPlottedFrames = 120;
// How long a frame's times are shown. The panel is drawn only when it changes.
constexpr double kTimesSeconds = 0.25;

}  // namespace

Panel::Panel(const Context& context, vk::Format format) : canvas_(context, kPanelPx, format), in_room_(kPanelPx, kPanelWidthMetres) {}

void Panel::keepFrameTime() {
    const auto now = std::chrono::steady_clock::now();
    if (last_end_ != std::chrono::steady_clock::time_point()) {
        frame_ms_.push_back(std::chrono::duration<float, std::milli>(now - last_end_).count());
    }
    if (frame_ms_.size() > kPlottedFrames) { frame_ms_.erase(frame_ms_.begin()); }
    last_end_ = now;
}

void Panel::showTimes(const FrameResult& last, const std::string& governor, double step_seconds) {
    times_age_s_ += step_seconds;
    const bool has_times = !last.counters.targets.empty();
    if (has_times && status_.frame != nullptr && times_age_s_ < kTimesSeconds) { return; }
    times_age_s_ = 0.0;
    shown_frame_ = last;
    status_.frame = has_times ? &shown_frame_ : nullptr;
    status_.frame_ms = frame_ms_;
    status_.governor = governor;
}

void Panel::askFor(FileWorker& files, const ViewSettings& settings) {
    status_.files = files.now();
    status_.pictures = &canvas_.font().pictures();
    if (canvas_.font().want(namesOn(settings, chooser_, status_), picturesOn(settings, chooser_))) {
        files.read("reading fonts", [this]() -> FileWorker::Done {
            canvas_.font().build();
            return [this] { canvas_.takeLetters(); };
        });
    }
    if (const std::optional<SceneListWish> wish = chooser_.takeWish()) {
        files.read(std::string("reading ") + wish->name(), [this, wish = *wish]() -> FileWorker::Done {
            return [this, wish, list = makeSceneList(wish)] { chooser_.show(list, wish); };
        });
    }
}

PanelRequests Panel::layOut(ConnectedHeadset* hung, const PanelPointer& mouse, bool uses_mouse, const ViewSettings& settings,
                            double step_seconds) {
    // A mouse at rest does not count while a hand points, and a moving one takes over only once the hand has released the trigger.
    const PanelPointer& hand = in_room_.pointer();
    const bool mouse_pointed = mouse_points_;
    mouse_points_ = hung != nullptr && hand.place_px ? uses_mouse && !hand.pressed : mouse_points_ || uses_mouse;
    PanelPointer pointer = mouse_points_ ? mouse : hand;
    if (mouse_points_ != mouse_pointed) { pointer.pressed = false; }  // the other one must not continue a drag
    canvas_.begin(pointer, step_seconds);
    PanelRequests requests = drawPanel(kPanelPx, settings, chooser_, status_);
    canvas_.end();
    if (hung != nullptr && hung->panel_revision != canvas_.revision()) { image_ = hung->panel_images.acquire(); }
    return requests;
}

void Panel::record(Commands& commands, ConnectedHeadset* headset, bool copied) {
    if (!image_ && !copied) { return; }
    commands.beginPass({Role::kNone, FrameStage::kPresent, "panel"});
    canvas_.record(commands);
    if (image_) {
        canvas_.copyTo(commands, image_);
        commands.makeMips(image_, kPanelPx, headset->panel_images.levels());
    }
}

void Panel::release(ConnectedHeadset& headset) {
    if (!std::exchange(image_, nullptr)) { return; }
    headset.panel_images.release();
    headset.panel_revision = canvas_.revision();
}

void Panel::giveUp() {
    image_ = nullptr;
    canvas_.giveUp();
}

}  // namespace binosplat
