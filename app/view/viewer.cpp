// The viewer from its first session to its last.
#include "app/view/viewer.h"

#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/shader_reload.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"

#include <cmath>
#include <thread>

namespace binosplat {

namespace {

// How often to check whether the session has begun to run.
constexpr std::chrono::milliseconds kIdle(5);

}  // namespace

Viewer::Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance,
               const Context& context, EventWindow* window)
    : options_(options),
      instance_(instance),
      context_(context),
      state_(settings),
      connection_(instance, context, kPanelPx, log_line_),
      renderer_(instance, context, options_.run, log_, connection_.format()),
      submission_(instance.troubles(), state_, renderer_, options_.run.camera.near.value_or(kUsualNear),
                  log_line_),
      panel_(context, connection_.format()),
      window_(say_),
      waiting_(context_),
      pointing_(context_),
      notes_(files_, say_),
      seen_(files_, settings.first_steps),
      place_(state_, notes_, files_, options_.run.metres_per_unit, say_, log_line_),
      scenes_(context_, options_, log_,
              FramesAhead{settings.stereo, renderer_.sizePx(settings), instance.takesDepth(), settings.tint}),
      drawn_(context_, state_, scenes_, renderer_, options_.load_first, say_, log_line_),
      requests_(state_, scenes_, notes_, files_, panel_, say_),
      kept_picture_(context_, scenes_, renderer_, notes_),
      exchange_(state_, scenes_, renderer_, place_, kept_picture_, notes_, pictures_, say_, log_line_) {
    for (const double rate_hz : headset().refresh_rates) {
        if (options_.usual_rate_hz == 0.0 || std::abs(rate_hz - options_.usual_rate_hz) > 0.5) { continue; }
        ViewSettings usual = state_.settings();
        usual.refresh_rate = rate_hz;
        state_.set(usual);
    }
    panel_.status().can_reload_shaders = !shaderFolder(options.shaders).empty();
    if (const std::string& complaint = panel_.canvas().font().complaint(); !complaint.empty()) {
        log_.print(complaint);
    }
    if (window == nullptr) { return; }
    if (const std::string why = window_.open(context_, panel_.canvas(), *window); !why.empty()) {
        log_.print(fmt::format("no window: {}", why));
    }
}

void Viewer::run() {
    try {
        while (options_.load_first && !scenes_.isComplete() && !leaving_) {
            if (isInterrupted()) { leave(); }
            takeScenes(true);
            drawWindowAlone("Loading the scene");
            std::this_thread::sleep_for(kIdle);
        }
        for (bool goes_on = true; goes_on;) {
            const bool is_enough =
                options_.frames != 0 && log_.frame - frames_without_scene_ >= options_.frames;
            if (!leaving_ && (isInterrupted() || is_enough)) { leave(); }
            try {
                goes_on = connection_.headset() != nullptr ? step() : comeBack();
            } catch (const xr::Lost& lost) {
                if (leaving_) { break; }
                loseHeadset(lost.what());
            }
        }
    } catch (const xr::InstanceLost& lost) {
        log_.print(fmt::format("{} frames; {}", log_.frame, lost.what()));
        throw;
    }
    while (const std::optional<std::string> outcome = pictures_.finish()) { say(*outcome); }
    kept_picture_.keepAtOnce();
    keepPreferences(0.0, true);
    files_.finish();
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr && scene->moving != nullptr) {
        const StreamCounters counters = scene->moving->counters();
        log_.print(fmt::format("scene frames that came late: {}; frames that waited for them: {}",
                               counters.scene_frames_late, counters.frames_waited_for_loading));
    }
    const std::string why = connection_.headset() != nullptr ? headset().session.whyEnded()
                                                             : "stopped while there was no headset";
    log_.print(
        fmt::format("{} frames; {}", log_.frame, why.empty() ? "the session was lost as it ended" : why));
}

bool Viewer::step() {
    for (const std::string& trouble : instance_.troubles().take()) { say(trouble); }
    switch (headset().session.beginFrame()) {
        case xr::FrameOutcome::kExit:
            return false;
        case xr::FrameOutcome::kWait:
            drawWindowAlone("Put the headset on");
            std::this_thread::sleep_for(kIdle);
            return true;
        case xr::FrameOutcome::kRender:
            drawFrame();
            connection_.showedFrame();
            break;
        case xr::FrameOutcome::kSkip:
            headset().session.endFrame({});
            drawWindowAlone("The headset is showing something else");
            break;
    }
    ++log_.frame;
    frames_without_scene_ += scenes_.get() == nullptr ? 1 : 0;
    return true;
}

void Viewer::leave() {
    if (std::exchange(leaving_, true)) { return; }
    if (connection_.headset() != nullptr) { headset().session.requestExit(); }
}

void Viewer::loseHeadset(const std::string& why) {
    connection_.lose(why);
    panel_.giveUp();
}

bool Viewer::comeBack() {
    if (leaving_) { return false; }
    const HeadsetConnection::Search came = connection_.search(say_);
    if (came == HeadsetConnection::Search::kLater) {
        drawWindowAlone("The headset is unplugged: plug it in");
        std::this_thread::sleep_for(kIdle);
    }
    return true;
}

void Viewer::say(const std::string& message) {
    panel_.status().message = message;
    seen_.say(message);
    log_.say(message);
}

void Viewer::keepPreferences(double step_seconds, bool at_once) {
    if (!options_.simulate) { notes_.keepPreferences(state_.settings(), step_seconds, at_once); }
}

void Viewer::sayChange() {
    const std::string change = state_.takeChange();
    if (!change.empty()) { log_.say(change); }
}

}  // namespace binosplat
