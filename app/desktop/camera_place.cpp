// Drags, clicks and requests that move the camera.
#include "app/desktop/camera_place.h"

#include "app/view/panel/measure.h"
#include "app/view/placement/placement.h"

#include <algorithm>

namespace binosplat {

namespace {

constexpr double kUsualAngleDeg = 60.0;
constexpr double kDoubleClickSeconds = 0.4, kDoubleClickPx = 6.0;
constexpr double kTourWaySeconds = 4.0;  // from one viewpoint to the next
// The point to orbit around is at most this many times as far as the centre, so that it is not a hill behind
// a window.
constexpr double kFarthestPivot = 8.0;

View viewOf(const OrbitCamera& camera) { return {camera.position(), camera.centre(), camera.up(), 0.0}; }

}  // namespace

CameraPlace::CameraPlace(const RunOptions& options, ScenePictures& pictures, ViewState& state,
                         SceneNotes& notes, FileWorker& files, const FrameLog& log, const Say& say)
    : options_(options),
      pictures_(pictures),
      state_(state),
      notes_(notes),
      log_(log),
      say_(say),
      angle_rad_(glm::radians(options.camera.fov_x_deg.value_or(kUsualAngleDeg))),
      viewpoints_(files, say) {}

void CameraPlace::show(LoadedScene* scene) {
    if (scene_ != nullptr) { left_[place_] = mover_.camera(); }
    scene_ = scene;
    viewpoints_.show(scene);
    ruler_.close();
    if (scene == nullptr) { return; }
    place_ = scene->place;
    OrbitCamera camera(scene->start_view);
    if (const Similarity& placed = state_.sceneFromRoom(); !(placed == scene->start)) {  // where it was saved
        const glm::dvec3 ahead = placed.orientation * glm::dvec3(0.0, 0.0, camera.distance());
        camera = OrbitCamera(View{placed.position, placed.position + ahead,
                                  placed.orientation * glm::dvec3(0.0, -1.0, 0.0), 0.0});
    }
    if (const auto left = left_.find(place_); left != left_.end()) { camera = left->second; }
    mover_.set(camera);
}

void CameraPlace::handle(const DesktopEvent& event, const WindowLayout& layout, TextEntry& entry) {
    using Kind = DesktopEvent::Kind;
    if (event.kind == Kind::kMove) {
        if (mover_.isDragging()) { mover_.dragTo(event.place_px); }
        // This is then not the first click of two.
        if (glm::distance(event.place_px, pressed_px_) > kDoubleClickPx) { pressed_at_ = {}; }
        return;
    }
    if (event.kind == Kind::kRelease) { return mover_.endDrag(); }
    if (event.kind == Kind::kLeave || event.kind == Kind::kDrop) { return; }
    viewpoints_.endTour();
    if (event.kind == Kind::kPress && scene_ != nullptr) { press(event, layout, entry); }
    if (event.kind == Kind::kWheel) { mover_.turnWheel(event.steps, under(event.place_px, layout)); }
}

void CameraPlace::press(const DesktopEvent& event, const WindowLayout& layout, TextEntry& entry) {
    if (event.isLeft() && ruler_.isOpen()) {
        say_(measureAt(pictures_.seenAt(layout.parts, event.place_px), ruler_, state_.sceneFromRoom().scale,
                       entry));
        if (!ruler_.isOpen()) { state_.showPanel(); }
        return;
    }
    const OrbitCamera& camera = mover_.camera();
    if (event.isLeft() && isSecondClick(event.place_px)) {
        mover_.endDrag();
        if (const std::optional<glm::dvec3> seen = pictures_.seenAt(layout.parts, event.place_px)) {
            mover_.glideTo(camera.centredOn(*seen));
            log_.say(fmt::format("the centre is {:.4g}, {:.4g}, {:.4g}", seen->x, seen->y, seen->z));
        }
        return;
    }
    glm::dvec3 pivot = under(event.place_px, layout);
    if (event.isLeft()) {
        const double farthest = kFarthestPivot * camera.distance(),
                     far = glm::distance(camera.position(), pivot);
        pivot = glm::mix(camera.position(), pivot, std::min(farthest / far, 1.0));
    }
    mover_.beginDrag(event.isLeft() ? CameraMover::Drag::kOrbit : CameraMover::Drag::kPan, event.place_px,
                     pivot, eyesOf(camera, layout.sight, layout.partPx()).front().intrinsics.fx,
                     layout.partPx().y);
}

bool CameraPlace::isSecondClick(const glm::dvec2& place_px) {
    const auto now = std::chrono::steady_clock::now();
    const bool is_second = std::chrono::duration<double>(now - pressed_at_).count() < kDoubleClickSeconds &&
                           glm::distance(place_px, pressed_px_) < kDoubleClickPx;
    pressed_at_ = is_second ? std::chrono::steady_clock::time_point() : now;
    pressed_px_ = place_px;
    return is_second;
}

glm::dvec3 CameraPlace::under(const glm::dvec2& place_px, const WindowLayout& layout) const {
    const OrbitCamera& camera = mover_.camera();
    if (const auto seen = pictures_.seenAt(layout.parts, place_px)) { return *seen; }
    const std::optional<EyePart> part = partAt(layout.parts, place_px);
    if (!part) { return camera.centre(); }
    const std::vector<Eye> eyes = eyesOf(camera, layout.sight, part->size_px);
    return pointAt(eyes[eyes.size() == 1 ? 0 : static_cast<std::size_t>(part->eye)],
                   place_px - glm::dvec2(part->at_px), camera.distance());
}

void CameraPlace::pass(const HeldMotion& held, double seconds) {
    const bool was_on_way = mover_.isGliding();
    mover_.pass(held, seconds);
    if (was_on_way && !mover_.isGliding()) { log_.say("arrived"); }
    if (held.isAny()) { viewpoints_.endTour(); }
    goTo(viewpoints_.pass(seconds, !mover_.isGliding()), kTourWaySeconds);
}

void CameraPlace::goTo(const Viewpoint* viewpoint, double within_seconds) {
    if (viewpoint == nullptr) { return; }
    mover_.glideTo(OrbitCamera(viewpoint->view), within_seconds);
    log_.say(viewpoints_.words());
}

void CameraPlace::follow(const PanelRequests& requests, TextEntry& entry) {
    if (scene_ == nullptr) { return; }
    if (const SceneFacts& facts = scene_->facts; requests.show_whole && facts.size_units > 0.0) {
        mover_.glideTo(mover_.camera().framing(facts.middle, 0.5 * facts.size_units, angle_rad_));
    }
    if (requests.reset_scene) { mover_.glideTo(OrbitCamera(scene_->start_view)); }
    if (requests.viewpoint) { goTo(viewpoints_.go(*requests.viewpoint)); }
    if (requests.viewpoint_step != 0) { goTo(viewpoints_.goBy(requests.viewpoint_step)); }
    if (requests.keep_viewpoint) { viewpoints_.keep(viewOf(mover_.camera())); }
    followViewpoints(requests, entry, viewpoints_);
    measure(requests);
    if (!requests.save) { return; }
    // Level, for a wearer who stands there later.
    Similarity level = startPlacement(viewOf(mover_.camera()), options_.metres_per_unit);
    level.scale = state_.sceneFromRoom().scale;
    state_.place(level);
}

void CameraPlace::measure(const PanelRequests& requests) {
    if (requests.measure) { say_(openRuler(ruler_)); }
    const std::optional<double> measured = takeMeasure(requests, ruler_, *scene_);
    if (!measured) { return; }
    Similarity placement = state_.sceneFromRoom();
    placement.scale = 1.0 / *measured;
    state_.place(placement);
    notes_.save(scene_->name, savedPlace(state_, *scene_));
}

}  // namespace binosplat
