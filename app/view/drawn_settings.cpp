// Waiting for kernels and images, and giving way where memory is short.
#include "app/view/drawn_settings.h"

#include "engine/error.h"

#include <fmt/format.h>

#include <utility>

namespace binosplat {

void DrawnSettings::choose(ConnectedHeadset& headset, const FrameViews& views, bool has_window) {
    ViewSettings asked = state_.settings();
    if (headset.inset) { asked.stereo.half_periphery = false; }  // as the renderer does
    const bool begins = scenes_.get() == nullptr || load_first_;
    const ImagesFor images = renderer_.imagesFor(headset, begins ? drawn_ : asked, views, has_window);
    scenes_.expect(asked, renderer_.sizePx(asked), images);
    const ViewSettings drawable = scenes_.drawable(asked);
    ViewSettings resized = drawable;
    resized.stereo.axes = asked.stereo.axes;
    resized.resolution_scale = asked.resolution_scale;
    const bool waits_for_method = resized != asked;
    if (std::exchange(waits_for_method_, waits_for_method) && !waits_for_method) {
        log_(fmt::format("{} is ready", nameOf(state_.settings().stereo.mode)));
    }
    drawn_ = drawable != asked ? drawable : state_.settings();
}

void DrawnSettings::prepareDrawn(ConnectedHeadset& headset, FrameViews& views, MirrorWindow* window) {
    renderer_.govern(headset, drawn_, views, scenes_, window);
    if (scenes_.get() != nullptr) {
        const Similarity drawn = scenes_.drawnFrom(state_.sceneFromRoom());
        const std::optional<Similarity> there = scenes_.toRemake();
        if (there && renderer_.knowsLens(headset, state_.settings(), views)) {
            scenes_.remakeFrames(renderer_.framesWanted(headset, drawn, state_.settings(), views, *there));
        }
        renderer_.prepare(headset, scenes_, drawn, drawn_, views);
        scenes_.keepDrawn(drawn_, headset.images->sizePx());
    }
    state_.keepFitting(drawn_);
}

bool DrawnSettings::prepare(ConnectedHeadset& headset, FrameViews& views, MirrorWindow* window) {
    choose(headset, views, window != nullptr);
    try {
        try {
            prepareDrawn(headset, views, window);
        } catch (const Error&) {
            // Images that have just made way may hold what it lacks.
            context_.waitForQueue();
            if (!headset.images_ahead.freeGone()) { throw; }
            prepareDrawn(headset, views, window);
        }
        return true;
    } catch (const Error& error) {
        if (scenes_.drawsOther()) {
            say_(scenes_.goOnAlone(error));
            return false;
        }
        const std::string change = state_.changeSinceFitting();
        if (change.empty()) { throw; }
        say_(fmt::format("{} does not fit: {}", change, error.what()));
    }
    scenes_.forgetDrawn();
    state_.goBack();
    drawn_ = state_.settings();
    renderer_.govern(headset, drawn_, views, scenes_, window);
    return false;
}

}  // namespace binosplat
