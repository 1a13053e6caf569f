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
}  // namespace

void Viewer::settle() {
    xr::Session& session = headset().session;
    if (!session.settle(recentre_asked_)) { return; }
    recentre_asked_ = false;
    is_new_view_ = true;
    controls_.letGo();
    const std::optional<double> floor_m = session.floorBelowMetres();
    log_.say("the room now begins where the wearer stands" +
             (floor_m ? fmt::format(", {:.2f} m above the floor", *floor_m) : std::string()));
    panel_.inRoom().hangBefore({});
}

std::optional<FrameViews> Viewer::locate() {
    const std::optional<std::array<xr::EyeView, 2>> located = headset().session.locateEyes();
    if (!located) { return std::nullopt; }
    const std::array<xr::EyeView, 2> eyes = withoutNoise(*located);
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(eyes);
    FrameViews views{eyes, room_from_eyes, roomFromHead(room_from_eyes), {}, {}, eyes};
    if (const auto& insets = headset().session.insets()) {
        views.insets = withoutNoise({xr::EyeView{eyes[kLeft].pose, (*insets)[kLeft]},
                                     xr::EyeView{eyes[kRight].pose, (*insets)[kRight]}});
    }
    return views;
}

void Viewer::drawFrame() {
    settle();
    std::optional<FrameViews> located = locate();
    if (!located) {
        headset().session.endFrame({});
        drawWindowAlone("The headset cannot tell where it is");
        return;
    }
    renderer_.meetDisplay(headset().session);
    files_.deliver();
    if (canTakeScene(true) && kept_picture_.isKept()) { takeScene(); }
    if (scenes_.isOtherMet()) { takeOther(); }
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
    controls_.update(wearer, panel_.inRoom(), state_);
    if (place_.measure(wearer.hands, panel_.inRoom(), pointing_, panel_.entry()) &&
        !state_.settings().panel) {
        togglePanel();
    }
    pointing_.ask(panel_.inRoom(), controls_, state_.settings(),
                  state_.settings().follow_ground && !scenes_.drawsOther(), views.room_from_head,
                  wearer.floor_m.value_or(kUsualFloorMetres));
    if (const double clear_deg = state_.settings().stereo.foveation_deg; clear_deg > 0.0 && !views.insets) {
        views.gazes =
            gaze_.update(headset().input.gaze(), views.room_from_eyes, glm::radians(clear_deg), step_seconds);
    } else {
        gaze_ = {};
    }
    if (place_.goBy(controls_.viewpointStep()) || place_.passTour(step_seconds)) { controls_.letGo(); }
    if (scenes_.other() != nullptr) {
        showOther();
    } else {
        scenes_.moveTime(controls_.playPressed(), 0, {});
    }
    chooseThings(wearer, views);
    takeWindowInput(step_seconds);
    if (const std::string complaint = headset().session.askForRate(state_.settings().refresh_rate);
        !complaint.empty()) {
        say(complaint);
    }
    panel_.status().state.clear();
    panel_hangs_ = state_.settings().panel;
    if (panel_hangs_ || window_) { layOutPanel(panel_hangs_, step_seconds); }
    // By now the runtime knows better where the eyes will be.
    if (std::optional<FrameViews> later = locate()) {
        later->gazes = views.gazes;
        views = *later;
    }
    // Last, since the panel and the window may change the settings.
    const bool fits = drawn_.prepare(headset(), views, window_.get());
    if (fits) { meetComing(views); }
    window_.acquire();
    const bool takes_picture = std::exchange(picture_asked_, false) && scenes_.get() != nullptr && fits;
    if (scenes_.get() != nullptr && fits) {
        meetOther();
        waiting_.passOver();
        renderer_.render(headset(), scenes_, drawn_.get(), window_.get(), [this](Commands& commands) {
            recordPanel(commands);
            pointing_.record(commands, scenes_, renderer_, state_.sceneFromRoom());
            kept_picture_.record(commands);
        });
        kept_picture_.countFrame();
        for (LoadedScene* const scene : {scenes_.get(), scenes_.other()}) {
            if (scene != nullptr && scene->live) { sayLive(*scene); }
        }
    } else {
        renderWaiting();
    }
    // After a frame that was cut short, the view fades in, too.
    const bool is_new = std::exchange(is_new_view_, false) || renderer_.wasCutShort();
    fade_.update(state_.sceneFromRoom(), place_.roomFromHead(), is_new, step_seconds);
    headset().things.darken(fade_.darkness(), coverMetres(views.eyes));
    sayPicture(pictures_.takeOutcome());
    window_.show();
    showFrame(views);
    if (takes_picture) {
        pictures_.begin(
            renderer_.shotOf(scenes_, scenes_.drawnFrom(state_.sceneFromRoom()), state_.settings(), views),
            scenes_.drawn()->name);
    }
    sayChange();
    panel_.keepFrameTime();
}

void Viewer::sayLive(LoadedScene& scene) {
    for (const std::string& line : scene.live->takeLines(Waits::kNever)) { say(line); }
    if (said_there_ || scene.stream == nullptr || !scene.stream->isSettled()) { return; }
    const std::optional<LoaderWork> work = scene.stream->tryWork();
    if (!work) { return; }
    said_there_ = true;
    const StreamCounters counters = scene.stream->counters();
    log_.say(fmt::format(
        "everything in view is loaded: {} splats, {} levels of leaves, {:.2f} million splats read in {:.1f} "
        "s; frames that "
        "waited for it: {}",
        counters.splats_resident, counters.chunks_resident, 1e-6 * static_cast<double>(work->splats),
        work->seconds, counters.frames_waited_for_loading));
}

void Viewer::chooseThings(const WearerNow& wearer, const FrameViews& views) {
    for (const int h : {kLeft, kRight}) {
        if (panel_.inRoom().pulses(h)) { headset().input.pulse(h); }
    }
    vignette_.update(state_.settings().vignette && controls_.isMoving(), wearer.step_seconds);
    std::array<std::optional<double>, 2> meets_m;
    for (std::size_t h = 0; h < 2 && !controls_.aimingHand(); ++h) {
        meets_m[h] = pointing_.meetsMetres(static_cast<int>(h));
    }
    RoomSight sight;
    sight.eye = wearer.room_from_head.position;
    if (state_.settings().hands) { sight.hands = wearer.hands; }
    sight.things = panel_.inRoom().rays(sight.eye, controls_.aimingHand(), meets_m);
    std::ranges::copy(controls_.things(sight.eye), std::back_inserter(sight.things));
    sight.arc = controls_.arc();
    sight.vignette_m = vignette_.widthMetres(views.eyes);
    message_line_.show(sight, headset().things.layout(), state_.settings().panel, wearer.step_seconds);
    headset().things.choose(sight);
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

void Viewer::showFrame(const FrameViews& views) {
    headset().images->release();
    if (headset().inset) { headset().inset_images->release(); }
    panel_.release(headset());
    headset().things.release();
    const bool shares = scenes_.get() != nullptr && drawn_.get().showsOneEye();
    submission_.end(headset(), views, panel_hangs_ ? &panel_.inRoom() : nullptr,
                    shares ? std::optional<int>(drawn_.get().stereo.dominant) : std::nullopt);
}

}  // namespace binosplat
