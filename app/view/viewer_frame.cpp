// One frame of the viewer, from where the eyes are to what the runtime is told to show.
#include "app/view/viewer.h"

#include "app/view/placement/view_eyes.h"
#include "engine/error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

// While the scene loads, unless a background is set.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
// How often the window is drawn while there are no frames.
constexpr std::chrono::milliseconds kWindowAlone(16);

}  // namespace

void Viewer::settle() {
    xr::Session& session = headset().session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    seen_.beginView();
    controls_.letGo();
    const std::optional<double> floor_m = session.floorBelowMetres();
    log_.say("the room now begins where the wearer stands" +
             (floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : std::string()));
    panel_.inRoom().hangBefore({});
}

void Viewer::takeScenes(bool at_once) {
    const SceneExchange::Taken taken = exchange_.take(at_once);
    if (taken == SceneExchange::Taken::kNone) { return; }
    pointing_.forget();
    controls_.letGo();
    taken == SceneExchange::Taken::kFirst ? seen_.beginFirstView() : seen_.beginView();
}

void Viewer::drawFrame() {
    settle();
    std::optional<FrameViews> located = locateViews(headset().session);
    if (!located) {
        headset().session.endFrame({});
        drawWindowAlone("The headset cannot tell where it is");
        return;
    }
    renderer_.meetDisplay(headset().session);
    files_.deliver();
    takeScenes(false);
    FrameViews& views = *located;
    place_.setHead(views.room_from_head);
    const double step_seconds = headset().session.stepSeconds();
    WearerNow wearer{headset().input.read(), views.room_from_head, headset().session.floorBelowMetres(),
                     step_seconds, pointing_.hands()};
    wearer.measures = place_.measures();
    wearer.ground_scene = pointing_.takeGround();
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr && scene->floor) {
        wearer.scene_floor = SceneFloor{scene->up, *scene->floor};
    }
    control(wearer, views);
    takeWindowInput(step_seconds);
    if (const std::string complaint = headset().session.askForRate(state_.settings().refresh_rate);
        !complaint.empty()) {
        say(complaint);
    }
    panel_.status().state.clear();
    const bool hangs = state_.settings().panel;
    if (hangs || window_) { layOutPanel(hangs, step_seconds); }
    // By now the runtime knows better where the eyes will be.
    if (std::optional<FrameViews> later = locateViews(headset().session)) {
        later->gazes = views.gazes;
        views = *later;
    }
    const bool shows = renderScene(views);
    seen_.darken(headset(), state_.sceneFromRoom(), place_.roomFromHead(), renderer_.wasCutShort(),
                 step_seconds, views.eyes);
    sayPicture(pictures_.takeOutcome());
    window_.show();
    headset().images->release();
    if (headset().inset) { headset().inset_images->release(); }
    panel_.release(headset());
    headset().things.release();
    const ViewSettings& drawn = drawn_.get();
    const bool shares = scenes_.get() != nullptr && drawn.showsOneEye();
    submission_.end(headset(), views, hangs ? &panel_.inRoom() : nullptr,
                    shares ? std::optional<int>(drawn.stereo.dominant) : std::nullopt);
    if (std::exchange(picture_asked_, false) && shows) {
        pictures_.begin(
            renderer_.shotOf(scenes_, scenes_.drawnFrom(state_.sceneFromRoom()), state_.settings(), views),
            scenes_.drawn()->name);
    }
    sayChange();
    panel_.keepFrameTime();
}

void Viewer::control(const WearerNow& wearer, FrameViews& views) {
    controls_.update(wearer, panel_.inRoom(), state_);
    if (place_.measure(wearer.hands, panel_.inRoom(), pointing_, panel_.entry()) &&
        !state_.settings().panel) {
        togglePanel();
    }
    pointing_.ask(panel_.inRoom(), controls_, state_.settings(),
                  state_.settings().follow_ground && !scenes_.drawsOther(), views.room_from_head,
                  wearer.floor_m.value_or(kUsualFloorMetres));
    if (const double clear_deg = state_.settings().stereo.foveation_deg; clear_deg > 0.0 && !views.insets) {
        views.gazes = gaze_.update(headset().input.gaze(), views.room_from_eyes, glm::radians(clear_deg),
                                   wearer.step_seconds);
    } else {
        gaze_ = {};
    }
    if (place_.goBy(controls_.viewpointStep()) || place_.passTour(wearer.step_seconds)) { controls_.letGo(); }
    if (scenes_.other() == nullptr) {
        scenes_.moveTime(controls_.playPressed(), 0, {});
    } else if (const std::array<bool, 2>& held = controls_.playHeld();
               exchange_.showOther(held[kLeft] || held[kRight])) {
        pointing_.forget();
        for (const int h : {kLeft, kRight}) {
            if (held[static_cast<std::size_t>(h)]) { headset().input.pulse(h); }
        }
    }
    seen_.choose(headset(), wearer, controls_, panel_.inRoom(), pointing_, state_.settings(), views.eyes);
}

bool Viewer::renderScene(FrameViews& views) {
    // Last, since the panel and the window may change the settings.
    const bool fits = drawn_.prepare(headset(), views, window_.get());
    if (fits) { exchange_.meetComing(headset(), drawn_.get(), views); }
    window_.acquire();
    if (scenes_.get() == nullptr || !fits) {
        renderWaiting();
        return false;
    }
    exchange_.meetOther(headset());
    waiting_.passOver();
    renderer_.render(headset(), scenes_, drawn_.get(), window_.get(), [this](Commands& commands) {
        recordPanel(commands);
        pointing_.record(commands, scenes_, renderer_, state_.sceneFromRoom());
        kept_picture_.record(commands);
    });
    kept_picture_.countFrame();
    exchange_.sayLive();
    return true;
}

void Viewer::renderWaiting() {
    std::vector<EyeImages*> all{headset().images.get()};
    if (headset().inset) { all.push_back(headset().inset_images.get()); }
    for (EyeImages* images : all) {
        for (const int e : {kLeft, kRight}) { images->acquire(e, false); }
    }
    scenes_.passOver(true);
    Commands& commands = waiting_.begin();
    const glm::dvec3& background = options_.run.camera.background;
    const glm::vec3 behind = background == glm::dvec3(0.0) ? kWaitingColour : glm::vec3(background);
    const glm::vec4 colour =
        renderer_.seesThrough(state_.settings()) ? glm::vec4(0.0f) : glm::vec4(behind, 1.0f);
    for (EyeImages* images : all) {
        for (const int e : {kLeft, kRight}) { images->clear(commands, e, colour); }
    }
    recordPanel(commands);
    waiting_.submit(window_.drawn());
}

void Viewer::recordPanel(Commands& commands) {
    if (connection_.headset() != nullptr) { headset().things.record(commands); }
    panel_.record(commands, connection_.headset(), static_cast<bool>(window_));
    if (window_) { window_.get()->record(commands); }
}

void Viewer::drawWindowAlone(const std::string& why) {
    const auto now = std::chrono::steady_clock::now();
    if (!window_ || now - last_alone_ < kWindowAlone) { return; }
    const double step_seconds = std::min(std::chrono::duration<double>(now - last_alone_).count(), 0.1);
    last_alone_ = now;
    files_.deliver();
    takeScenes(true);
    takeWindowInput(step_seconds);
    panel_.status().state = why;
    layOutPanel(false, step_seconds);
    sayPicture(pictures_.takeOutcome());
    window_.acquire();
    if (!window_) { return; }
    scenes_.passOver(true);
    recordPanel(waiting_.begin());
    waiting_.submit(window_.drawn());
    window_.show();
    sayChange();
}

}  // namespace binosplat
