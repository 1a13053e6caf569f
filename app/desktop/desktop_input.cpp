// Handles the window's mouse and keys.
#include "app/desktop/desktop_shell.h"
#include "app/view/panel/measure.h"
#include "app/view/panel/panel_style.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace binosplat {

namespace {

constexpr double kDoubleClickSeconds = 0.4, kDoubleClickPx = 6.0;
// The point to orbit around is at most this many times as far as the centre, so that it is not a hill behind
// a window.
constexpr double kFarthestPivot = 8.0;

bool isIn(const WindowPart& part, const glm::dvec2& place_px) {
    const glm::dvec2 low(part.at_px), high(part.at_px + part.size_px);
    return glm::all(glm::greaterThanEqual(place_px, low)) && glm::all(glm::lessThan(place_px, high));
}

}  // namespace

void DesktopShell::handle(const DesktopEvent& event) {
    using Kind = DesktopEvent::Kind;
    const WindowPart part = panelPart();
    const bool on_panel = event.kind != Kind::kLeave && !mover_.isDragging() &&
                          (pointer_.pressed || isIn(part, event.place_px));
    const bool is_left = event.code == GLFW_MOUSE_BUTTON_LEFT;
    layouts_due_ = 2;
    if (takesText(event)) { return; }
    // The panel sees each event by itself: a click may begin and end between two pictures.
    if (on_panel && event.kind != Kind::kKey && event.kind != Kind::kDrop) {
        pointer_.place_px =
            (event.place_px - glm::dvec2(part.at_px)) * glm::dvec2(kPanelPx) / glm::dvec2(part.size_px);
        if (event.kind == Kind::kPress && is_left) { pointer_.pressed = true; }
        if (event.kind == Kind::kRelease && is_left) { pointer_.pressed = false; }
        pointer_.wheel = event.kind == Kind::kWheel ? event.steps : 0.0;
        layOutPanel(pointer_, 0.0);
        pointer_.wheel = 0.0;
        return;
    }
    if (moveCurtain(event)) { return; }
    switch (event.kind) {
        case Kind::kMove:
            pointer_.place_px.reset();
            if (mover_.isDragging()) { mover_.dragTo(event.place_px); }
            // This is then not the first click of two.
            if (glm::distance(event.place_px, pressed_px_) > kDoubleClickPx) { pressed_at_ = {}; }
            break;
        case Kind::kLeave:
            pointer_.place_px.reset();
            break;
        case Kind::kPress:
            press(event);
            break;
        case Kind::kRelease:
            mover_.endDrag();
            break;
        case Kind::kWheel:
            viewpoints_.endTour();
            mover_.turnWheel(event.steps, under(event.place_px));
            break;
        case Kind::kKey:
            pressKey(event.code);
            break;
        case Kind::kDrop:
            openDropped(event);
            break;
        case Kind::kText:
            break;
    }
}

void DesktopShell::press(const DesktopEvent& event) {
    if (scenes_.get() == nullptr) { return; }
    viewpoints_.endTour();
    const bool is_left = event.code == GLFW_MOUSE_BUTTON_LEFT;
    if (is_left && ruler_.isOpen()) {
        say(measureAt(seenAt(event.place_px), ruler_, state_.sceneFromRoom().scale, panel_.entry()));
        if (!ruler_.isOpen()) { showPanel(); }
        return;
    }
    if (is_left) {
        const auto now = Clock::now();
        const bool is_double =
            std::chrono::duration<double>(now - pressed_at_).count() < kDoubleClickSeconds &&
            glm::distance(event.place_px, pressed_px_) < kDoubleClickPx;
        pressed_at_ = is_double ? Clock::time_point() : now;
        pressed_px_ = event.place_px;
        if (is_double) {
            mover_.endDrag();
            if (const std::optional<glm::dvec3> seen = seenAt(event.place_px)) {
                mover_.glideTo(mover_.camera().centredOn(*seen));
                log_.say(fmt::format("the centre is {:.4g}, {:.4g}, {:.4g}", seen->x, seen->y, seen->z));
            }
            return;
        }
    }
    const glm::uvec2 part_px = parts().front().size_px;
    const std::vector<Eye> eyes = eyesOf(mover_.camera(), windowSight(), part_px);
    const OrbitCamera& camera = mover_.camera();
    glm::dvec3 pivot = under(event.place_px);
    if (is_left) {
        const double farthest = kFarthestPivot * camera.distance(),
                     far = glm::distance(camera.position(), pivot);
        pivot = glm::mix(camera.position(), pivot, std::min(farthest / far, 1.0));
    }
    mover_.beginDrag(is_left ? CameraMover::Drag::kOrbit : CameraMover::Drag::kPan, event.place_px, pivot,
                     eyes.front().intrinsics.fx, part_px.y);
}

std::optional<glm::dvec3> DesktopShell::seenAt(const glm::dvec2& place_px) {
    if (pictures_.eyes().empty()) { return std::nullopt; }
    const std::optional<EyePart> part = partAt(parts(), place_px);
    if (!part) { return std::nullopt; }
    const int e = pictures_.eyes().size() == 1 ? 0 : part->eye;
    const Eye& eye = pictures_.eyes()[static_cast<std::size_t>(e)];
    const glm::dvec2 pixel =
        (place_px - glm::dvec2(part->at_px)) * glm::dvec2(eye.size_px) / glm::dvec2(part->size_px);
    const std::optional<double> depth = (isOtherAt(place_px) ? scenes_.otherFrame() : scenes_.frame())
                                            .depthAt(e, glm::min(glm::uvec2(pixel), eye.size_px - 1u));
    return depth ? std::optional(pointAt(eye, pixel, *depth)) : std::nullopt;
}

glm::dvec3 DesktopShell::under(const glm::dvec2& place_px) {
    const OrbitCamera& camera = mover_.camera();
    if (const std::optional<glm::dvec3> seen = seenAt(place_px)) { return *seen; }
    const std::optional<EyePart> part = partAt(parts(), place_px);
    if (!part) { return camera.centre(); }
    const std::vector<Eye> eyes = eyesOf(camera, windowSight(), part->size_px);
    return pointAt(eyes[eyes.size() == 1 ? 0 : static_cast<std::size_t>(part->eye)],
                   place_px - glm::dvec2(part->at_px), camera.distance());
}

void DesktopShell::pressKey(int key) {
    viewpoints_.endTour();
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
        return goTo(viewpoints_.go(static_cast<std::size_t>(key - GLFW_KEY_1)));
    }
    PanelRequests requests;
    requests.settings = state_.settings();
    switch (key) {
        case GLFW_KEY_TAB:
            requests.settings.panel = !requests.settings.panel;
            break;
        case GLFW_KEY_H:
            requests.help = true;
            break;
        case GLFW_KEY_F:
            requests.show_whole = true;
            break;
        case GLFW_KEY_R:
            requests.reset_scene = true;
            break;
        case GLFW_KEY_O:
            requests.open_file = true;
            break;
        case GLFW_KEY_C:
            if (scenes_.other() != nullptr) { return; }  // while held, it shows the other scene
            requests.compare = true;
            break;
        case GLFW_KEY_P:
            requests.take_picture = true;
            break;
        case GLFW_KEY_F11:
            requests.fill_screen = true;
            break;
        case GLFW_KEY_SPACE:
            requests.play = true;
            break;
        case GLFW_KEY_PERIOD:
        case GLFW_KEY_COMMA:
            requests.frame_step = key == GLFW_KEY_PERIOD ? 1 : -1;
            break;
        case GLFW_KEY_ESCAPE:
            (panel_.status().window->fills_screen ? requests.fill_screen : requests.quit) = true;
            break;
        default:
            return;
    }
    follow(requests);
}

void DesktopShell::goTo(const Viewpoint* viewpoint, double within_seconds) {
    if (viewpoint == nullptr) { return; }
    mover_.glideTo(OrbitCamera(viewpoint->view), within_seconds);
    log_.say(viewpoints_.words());
}

bool DesktopShell::takesText(const DesktopEvent& event) {
    TextEntry& entry = panel_.entry();
    if (event.kind == DesktopEvent::Kind::kText && entry.isOpen()) { entry.type(event.path); }
    if (event.kind != DesktopEvent::Kind::kKey || !entry.isOpen()) {
        return event.kind == DesktopEvent::Kind::kText;
    }
    if (event.code == GLFW_KEY_BACKSPACE) { entry.eraseLast(); }
    if (event.code == GLFW_KEY_ESCAPE) { entry.close(); }
    if (event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER) { entry.confirm(); }
    return true;
}

void DesktopShell::showWhole() {
    const SceneFacts& facts = scenes_.get()->facts;
    if (facts.size_units > 0.0) {
        mover_.glideTo(mover_.camera().framing(facts.middle, 0.5 * facts.size_units, angle_rad_));
    }
}

void DesktopShell::showStart() { mover_.glideTo(OrbitCamera(scenes_.get()->start_view)); }

}  // namespace binosplat
