// The panel's content and its letters.
#include "app/view/panel/panel_picture.h"

#include "app/view/panel/panel_style.h"

namespace binosplat {

namespace {

constexpr std::size_t kPlottedFrames = 120;
// How long a frame's times are shown: the panel is drawn only when it changes.
constexpr double kTimesSeconds = 0.25;

}  // namespace

PanelPicture::PanelPicture(const Context& context, vk::Format format) : canvas_(context, kPanelPx, format) {
    status_.entry = &entry_;
}

void PanelPicture::keepFrameTime() {
    const auto now = std::chrono::steady_clock::now();
    if (last_end_ != std::chrono::steady_clock::time_point()) {
        frame_ms_.push_back(std::chrono::duration<float, std::milli>(now - last_end_).count());
    }
    if (frame_ms_.size() > kPlottedFrames) { frame_ms_.erase(frame_ms_.begin()); }
    last_end_ = now;
}

void PanelPicture::showTimes(const FrameResult& last, const std::string& governor, double step_seconds) {
    times_age_s_ += step_seconds;
    const bool has_times = !last.counters.targets.empty();
    if (has_times && status_.frame != nullptr && times_age_s_ < kTimesSeconds) { return; }
    times_age_s_ = 0.0;
    shown_frame_ = last;
    status_.frame = has_times ? &shown_frame_ : nullptr;
    status_.frame_ms = frame_ms_;
    status_.governor = governor;
}

void PanelPicture::askFor(FileWorker& files, const ViewSettings& settings) {
    status_.files = files.now();
    status_.pictures = &canvas_.font().pictures();
    if (canvas_.font().want(namesOn(settings, chooser_, status_), picturesOn(settings, chooser_))) {
        files.read("reading fonts", [this]() -> FileWorker::Done {
            canvas_.makeLetters();
            return [this] { canvas_.takeLetters(); };
        });
    }
    if (const std::optional<SceneListWish> wish = chooser_.takeWish()) {
        files.read(std::string("reading ") + wish->name(), [this, wish = *wish]() -> FileWorker::Done {
            return [this, wish, list = makeSceneList(wish)] { chooser_.show(list, wish); };
        });
    }
}

PanelRequests PanelPicture::layOut(const PanelPointer& pointer, const ViewSettings& settings,
                                   double step_seconds) {
    canvas_.begin(pointer, step_seconds);
    PanelRequests requests = drawPanel(kPanelPx, settings, chooser_, status_);
    canvas_.end();
    return requests;
}

void PanelPicture::record(Commands& commands) {
    commands.beginPass({Role::kNone, FrameStage::kPresent, "panel"});
    canvas_.record(commands);
}

}  // namespace binosplat
