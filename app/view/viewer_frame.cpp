// One frame of the viewer, from where the eyes are to what the runtime is told to show.
#include "app/view/viewer.h"

#include "app/view/panel/message_picture.h"
#include "app/view/placement/view_eyes.h"
#include "app/view/wearer/follow_ground.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

// While the scene loads, unless a background is set.
constexpr glm::vec3 kWaitingColour(0.06f, 0.07f, 0.09f);
constexpr double kMessageSeconds = 6.0;
// A tour stays longer than in a window, where moving between viewpoints takes time: for five seconds.
constexpr double kTourPace = ViewpointList::kRestSeconds / 5.0;

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
    if (canTakeScene(true) && hasKeptPicture()) { takeScene(); }
    if (scenes_.isOtherMet()) { takeOther(); }
    FrameViews& views = *located;
    room_from_head_ = views.room_from_head;
    const double step_seconds = headset().session.stepSeconds();
    WearerNow wearer{headset().input.read(), room_from_head_, headset().session.floorBelowMetres(),
                     step_seconds, probes_seen_.hands};
    wearer.measures = ruler_.isOpen();
    wearer.ground_scene = std::move(probes_seen_.ground);
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr && scene->floor) {
        wearer.scene_floor = SceneFloor{scene->up, *scene->floor};
    }
    controls_.update(wearer, panel_.inRoom(), state_);
    measure(wearer.hands);
    probeScene(wearer.floor_m.value_or(kUsualFloorMetres));
    if (const double clear_deg = state_.settings().stereo.foveation_deg; clear_deg > 0.0 && !views.insets) {
        views.gazes =
            gaze_.update(headset().input.gaze(), views.room_from_eyes, glm::radians(clear_deg), step_seconds);
    } else {
        gaze_ = {};
    }
    if (const int step = controls_.viewpointStep(); step != 0) {
        viewpoints_.endTour();
        goTo(viewpoints_.goBy(step));
    }
    // A wearer must not be moved smoothly, so the tour jumps, with a fade.
    goTo(viewpoints_.pass(kTourPace * step_seconds, true));
    if (scenes_.other() != nullptr) {
        showOther();
    } else {
        moveTime(controls_.playPressed(), 0, {});
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
    const bool fits = prepareScene(views);
    if (fits) { meetComing(views); }
    onWindow(&MirrorWindow::acquire);
    const bool takes_picture = std::exchange(picture_asked_, false) && scenes_.get() != nullptr && fits;
    if (scenes_.get() != nullptr && fits) {
        meetOther();
        waiting_.passOver();
        renderer_.render(headset(), scenes_, drawn_, window_.get(), [this](Commands& commands) {
            recordPanel(commands);
            recordProbe(commands);
            recordCopy(commands);
        });
        ++frames_of_scene_;
        for (LoadedScene* const scene : {scenes_.get(), scenes_.other()}) {
            if (scene != nullptr && scene->live) { sayLive(*scene); }
        }
    } else {
        renderWaiting();
    }
    // After a frame that was cut short, the view fades in, too.
    const bool is_new = std::exchange(is_new_view_, false) || renderer_.wasCutShort();
    fade_.update(state_.sceneFromRoom(), room_from_head_, is_new, step_seconds);
    headset().things.darken(fade_.darkness(), coverMetres(views.eyes));
    sayPicture(pictures_.takeOutcome());
    onWindow(&MirrorWindow::show);
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

bool Viewer::prepareScene(FrameViews& views) {
    ViewSettings asked = state_.settings();
    if (headset().inset) { asked.stereo.half_periphery = false; }         // as the renderer does
    const bool begins = scenes_.get() == nullptr || options_.load_first;  // then what lacks is made at once
    const ImagesFor images =
        renderer_.imagesFor(headset(), begins ? drawn_ : asked, views, window_ != nullptr);
    scenes_.expect(asked, renderer_.sizePx(asked), images);
    const ViewSettings drawable = scenes_.drawable(asked);
    const bool waits = drawable != asked;
    ViewSettings resized = drawable;
    resized.stereo.axes = asked.stereo.axes;
    resized.resolution_scale = asked.resolution_scale;
    const bool waits_for_method = resized != asked;
    if (std::exchange(waits_for_method_, waits_for_method) && !waits_for_method) {
        log_.say(fmt::format("{} is ready", nameOf(state_.settings().stereo.mode)));
    }
    drawn_ = waits ? drawable : state_.settings();
    const auto prepare = [&] {
        renderer_.govern(headset(), drawn_, views, scenes_, window_.get());
        if (scenes_.get() != nullptr) {
            const Similarity drawn = scenes_.drawnFrom(state_.sceneFromRoom());
            const std::optional<Similarity> there = scenes_.toRemake();
            if (there && renderer_.knowsLens(headset(), state_.settings(), views)) {
                scenes_.remakeFrames(
                    renderer_.framesWanted(headset(), drawn, state_.settings(), views, *there));
            }
            renderer_.prepare(headset(), scenes_, drawn, drawn_, views);
            scenes_.keepDrawn(drawn_, headset().images->sizePx());
        }
        state_.keepFitting(drawn_);
    };
    try {
        try {
            prepare();
        } catch (const Error&) {
            // Images that have just made way may hold what it lacks.
            waitForQueue();
            if (!headset().images_ahead.freeGone()) { throw; }
            prepare();
        }
        return true;
    } catch (const Error& error) {
        if (scenes_.drawsOther()) {
            say(scenes_.goOnAlone(error));
            return false;
        }
        const std::string change = state_.changeSinceFitting();
        if (change.empty()) { throw; }
        say(fmt::format("{} does not fit: {}", change, error.what()));
    }
    scenes_.forgetDrawn();
    state_.goBack();
    drawn_ = state_.settings();
    renderer_.govern(headset(), drawn_, views, scenes_, window_.get());
    return false;
}

void Viewer::chooseThings(const WearerNow& wearer, const FrameViews& views) {
    for (const int h : {kLeft, kRight}) {
        if (panel_.inRoom().pulses(h)) { headset().input.pulse(h); }
    }
    vignette_.update(state_.settings().vignette && controls_.isMoving(), wearer.step_seconds);
    std::array<std::optional<double>, 2> meets_m;
    for (std::size_t h = 0; h < 2 && !controls_.aimingHand(); ++h) {
        if (probes_seen_.hands[h].meets) { meets_m[h] = probeMetres(*probes_seen_.hands[h].meets); }
    }
    RoomSight sight;
    sight.eye = wearer.room_from_head.position;
    if (state_.settings().hands) { sight.hands = wearer.hands; }
    sight.things = panel_.inRoom().rays(sight.eye, controls_.aimingHand(), meets_m);
    std::ranges::copy(controls_.things(sight.eye), std::back_inserter(sight.things));
    sight.arc = controls_.arc();
    sight.vignette_m = vignette_.widthMetres(views.eyes);
    showMessage(sight, wearer.step_seconds);
    headset().things.choose(sight);
}

void Viewer::probeScene(double feet_m) {
    std::array<std::optional<ProbePath>, kProbePaths> paths;
    if (state_.settings().follow_ground && !scenes_.drawsOther()) {
        paths[kGroundPath] = groundAhead(room_from_head_, feet_m);
    }
    for (const int h : {kLeft, kRight}) {
        if (!state_.settings().hands) { break; }  // hidden hands do not point
        if (const std::optional<Pose> aim = panel_.inRoom().missesWith(h)) {
            paths[static_cast<std::size_t>(h)] = probeRay(*aim);
        }
    }
    if (const Arc* const arc = controls_.arc(); controls_.aimingHand() && arc != nullptr) {
        ProbePath& path = paths[static_cast<std::size_t>(*controls_.aimingHand())].emplace();
        for (std::size_t i = 0; i < path.size(); ++i) {
            path[i] = pointAlong(arc->points, static_cast<double>(i) / static_cast<double>(path.size() - 1));
        }
    }
    probes_seen_ = probe_.ask(paths);
}

void Viewer::recordProbe(Commands& commands) {
    const std::size_t eye = eyeOfPicture();
    probe_.record(commands, scenes_.frame().picture(static_cast<int>(eye)), renderer_.pictures().at(eye),
                  scenes_.drawnFrom(state_.sceneFromRoom()));
}

void Viewer::showMessage(RoomSight& sight, double step_seconds) {
    const std::string message = std::exchange(message_, {});
    message_seconds_ = state_.settings().panel ? 0.0 : std::max(message_seconds_ - step_seconds, 0.0);
    if (!message.empty() && !state_.settings().panel) {
        sight.message = drawMessage(message, headset().things.layout());
        message_seconds_ = kMessageSeconds;
    }
    if (const auto gesture = message_seconds_ > 0.0 ? std::nullopt : first_steps_.update(step_seconds)) {
        sight.message = drawGesture(*gesture, headset().things.layout());
    }
    sight.has_message = message_seconds_ > 0.0 || first_steps_.areShown();
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
    waiting_.submit(window_ ? window_->drawn() : vk::Semaphore());
}

void Viewer::showFrame(const FrameViews& views) {
    headset().images->release();
    if (headset().inset) { headset().inset_images->release(); }
    panel_.release(headset());
    headset().things.release();
    submitFrame(views);
}

void Viewer::submitFrame(const FrameViews& views) {
    std::vector<const char*> things;
    std::string refusal;
    const bool has_room = renderer_.seesThrough(state_.settings());
    const auto isTaken = [&](const LayersWanted& wanted) {
        headset().session.seeThrough(has_room && wanted.room);
        xr::Layers layers(headset().session, wanted.most_things);
        addEyes(layers, views, has_room && wanted.room);
        headset().things.addBehindPanel(layers);
        if (panel_hangs_ && wanted.panel) {
            layers.addPanel(panel_.inRoom().roomFromPanel(), panel_.inRoom().sizeMetres(),
                            headset().panel_images);
        }
        headset().things.addBeforePanel(layers);
        things = layers.quadNames();
        try {
            headset().session.endFrame(layers.list());
        } catch (const Error& error) {
            refusal = error.what();
            return false;
        }
        return true;
    };
    if (isTaken({})) { return; }
    std::optional<LayersWanted> taken = findTaken(things.size(), panel_hangs_, has_room, isTaken);
    if (!taken && renderer_.dropDepth(headset())) {
        log_.say("the runtime refuses depth; going on without depth");
        if (isTaken({})) { return; }
        taken = findTaken(things.size(), panel_hangs_, has_room, isTaken);
    }
    if (!taken) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: it refuses the eyes' pictures", refusal));
    }
    goOnWith(*taken, things, refusal);
}

void Viewer::goOnWith(const LayersWanted& taken, const std::vector<const char*>& things,
                      const std::string& refusal) {
    const auto say = [&](const std::string& lacks, const std::string& what) {
        instance_.troubles().add(fmt::format("{}; going on without {}: it refuses {}", refusal, lacks, what));
    };
    if (taken.most_things < things.size()) {
        say("hands, rays and the vignette", things[taken.most_things]);
        headset().things.giveUp();
    }
    ViewSettings less = state_.settings();
    if (panel_hangs_ && !taken.panel) {
        say("the panel", "it");
        less.panel = false;
    }
    if (less.passthrough && !taken.room) {
        say("the room behind the scene", "it");
        less.passthrough = false;
    }
    state_.set(less);
}

void Viewer::addEyes(xr::Layers& layers, const FrameViews& views, bool see_through) const {
    const auto layerEye = [&](const EyeImages& images, const std::array<xr::EyeView, 2>& eyes, int shown_to) {
        // If both eyes share a picture, both use the pose and angles of its eye.
        const int e = scenes_.get() != nullptr && drawn_.showsOneEye() ? drawn_.stereo.dominant : shown_to;
        return images.layerEye(e, eyes[static_cast<std::size_t>(e)],
                               options_.run.camera.near.value_or(kUsualNear));
    };
    const EyeImages& images = *headset().images;
    const xr::LayerEye left = layerEye(images, views.pictures, kLeft),
                       right = layerEye(images, views.pictures, kRight);
    if (!headset().inset) { return layers.addEyes({left, right}, see_through); }
    const EyeImages& insets = *headset().inset_images;
    layers.addEyesAndInsets(
        {left, right, layerEye(insets, *views.insets, kLeft), layerEye(insets, *views.insets, kRight)},
        see_through);
}

}  // namespace binosplat
