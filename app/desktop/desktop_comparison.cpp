// Two scenes in one window.
#include "app/desktop/desktop_shell.h"
#include "engine/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <utility>

namespace binosplat {

void DesktopShell::takeOther() {
    const std::string complaint = scenes_.takeOther();
    if (!complaint.empty()) { return say(complaint); }
    if (!comparison_) { comparison_.emplace(context_); }
    comparison_->pictures.forget();
    comparison_->is_whole_asked = false;
    notes_.remember(scenes_.other()->name, {});
    say(fmt::format("left of the line {}, right of it {}: drag it, or hold C", scenes_.get()->name,
                    scenes_.other()->name));
}

void DesktopShell::followComparison() {
    if (const std::string title = scenes_.names();
        scenes_.get() != nullptr && std::exchange(title_, title) != title) {
        window_.setTitle(title + " - binosplat");
    }
    if (scenes_.other() == nullptr) { return; }
    const bool is_whole =
        comparison_->is_whole_asked != (window_.isHeld(GLFW_KEY_C) && !panel_.entry().isOpen());
    if (std::exchange(comparison_->is_whole, is_whole) == is_whole) { return; }
    is_shown_ = false;
    log_.say(is_whole ? "shows " + scenes_.other()->name : "the curtain is back");
}

bool DesktopShell::moveCurtain(const DesktopEvent& event) {
    using Kind = DesktopEvent::Kind;
    if (scenes_.other() == nullptr) {
        window_.pointSideways(false);
        return false;
    }
    Curtain& curtain = comparison_->curtain;
    const bool is_at = !comparison_->is_whole && curtain.isAt(parts(), event.place_px);
    const bool is_left = event.code == GLFW_MOUSE_BUTTON_LEFT;
    if (event.kind == Kind::kMove) {
        window_.pointSideways(!mover_.isDragging() && (is_at || curtain.isDragged()));
        if (!curtain.isDragged()) { return false; }
        pointer_.place_px.reset();
        curtain.dragTo(parts(), event.place_px);
        is_shown_ = false;
        return true;
    }
    if (event.kind == Kind::kPress && is_left && is_at) {
        curtain.beginDrag();
        return true;
    }
    if (event.kind != Kind::kRelease || !curtain.isDragged()) { return false; }
    curtain.endDrag();
    log_.say(fmt::format("the curtain hangs at {:.0f} %", 100.0 * curtain.share()));
    return true;
}

bool DesktopShell::isOtherAt(const glm::dvec2& place_px) const {
    return scenes_.other() != nullptr &&
           (comparison_->is_whole || comparison_->curtain.isLeftOf(parts(), place_px));
}

void DesktopShell::renderOther(const std::vector<Eye>& eyes, const FrameSettings& settings, bool at_rest) {
    if (scenes_.other() == nullptr) { return; }
    try {
        std::vector<Eye> there = eyes;
        for (Eye& eye : there) { eye.world_from_camera.position += scenes_.otherFromShown(); }
        comparison_->pictures.render(scenes_.otherFrame(), there, settings, look(), at_rest);
    } catch (const vk::DeviceLostError&) { throw; } catch (const Error& error) {
        say(scenes_.goOnAlone(error));
    }
}

void DesktopShell::composeScenes(Commands& commands, vk::Image window) {
    const bool compares = scenes_.other() != nullptr;
    if (!compares || !comparison_->is_whole) { pictures_.compose(commands, window, parts()); }
    if (!compares) { return; }
    changeLayout(commands, window, vk::ImageLayout::eTransferDstOptimal,
                 vk::ImageLayout::eTransferDstOptimal);
    comparison_->pictures.compose(commands, window, parts(),
                                  comparison_->is_whole ? 0.0 : comparison_->curtain.share());
    if (!comparison_->is_whole) { comparison_->curtain.compose(commands, window, parts()); }
}

}  // namespace binosplat
