// The frame's layers, and which of them a runtime takes.
#include "app/view/frame_submission.h"

#include "engine/error.h"

#include <fmt/format.h>

namespace binosplat {

void FrameSubmission::end(ConnectedHeadset& headset, const FrameViews& views, const PanelInRoom* panel,
                          std::optional<int> only_eye) {
    std::vector<const char*> things;
    std::string refusal;
    const bool has_panel = panel != nullptr, has_room = renderer_.seesThrough(state_.settings());
    const auto isTaken = [&](const LayersWanted& wanted) {
        headset.session.seeThrough(has_room && wanted.room);
        xr::Layers layers(headset.session, wanted.most_things);
        addEyes(layers, headset, views, only_eye, has_room && wanted.room);
        headset.things.addBehindPanel(layers);
        if (has_panel && wanted.panel) {
            layers.addPanel(panel->roomFromPanel(), panel->sizeMetres(), headset.panel_images);
        }
        headset.things.addBeforePanel(layers);
        things = layers.quadNames();
        try {
            headset.session.endFrame(layers.list());
        } catch (const Error& error) {
            refusal = error.what();
            return false;
        }
        return true;
    };
    if (isTaken({})) { return; }
    std::optional<LayersWanted> taken = findTaken(things.size(), has_panel, has_room, isTaken);
    if (!taken && renderer_.dropDepth(headset)) {
        log_("the runtime refuses depth; going on without depth");
        if (isTaken({})) { return; }
        taken = findTaken(things.size(), has_panel, has_room, isTaken);
    }
    if (!taken) {
        throw Error(ExitCode::kNoDevice, fmt::format("{}: it refuses the eyes' pictures", refusal));
    }
    goOnWith(headset, *taken, has_panel, has_room, things, refusal);
}

void FrameSubmission::goOnWith(ConnectedHeadset& headset, const LayersWanted& taken, bool has_panel,
                               bool has_room, const std::vector<const char*>& things,
                               const std::string& refusal) {
    const auto say = [&](const std::string& lacks, const std::string& what) {
        troubles_.add(fmt::format("{}; going on without {}: it refuses {}", refusal, lacks, what));
    };
    if (taken.most_things < things.size()) {
        say("hands, rays and the vignette", things[taken.most_things]);
        headset.things.giveUp();
    }
    ViewSettings less = state_.settings();
    if (has_panel && !taken.panel) {
        say("the panel", "it");
        less.panel = false;
    }
    if (has_room && !taken.room) {
        say("the room behind the scene", "it");
        less.passthrough = false;
    }
    state_.set(less);
}

void FrameSubmission::addEyes(xr::Layers& layers, const ConnectedHeadset& headset, const FrameViews& views,
                              std::optional<int> only_eye, bool see_through) const {
    const auto layerEye = [&](const EyeImages& images, const std::array<xr::EyeView, 2>& eyes, int shown_to) {
        const int e = only_eye.value_or(shown_to);
        return images.layerEye(e, eyes[static_cast<std::size_t>(e)], near_m_);
    };
    const EyeImages& images = *headset.images;
    const xr::LayerEye left = layerEye(images, views.pictures, kLeft),
                       right = layerEye(images, views.pictures, kRight);
    if (!headset.inset) { return layers.addEyes({left, right}, see_through); }
    const EyeImages& insets = *headset.inset_images;
    layers.addEyesAndInsets(
        {left, right, layerEye(insets, *views.insets, kLeft), layerEye(insets, *views.insets, kRight)},
        see_through);
}

}  // namespace binosplat
