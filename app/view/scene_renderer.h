// From the scene to the headset's images: resolution, method, both eyes' pictures.
#pragma once

#include "app/terminal/frame_log.h"
#include "app/view/governor/met_displays.h"
#include "app/view/governor/splat_budget.h"
#include "app/view/headset/connected_headset.h"
#include "app/view/panel/panel_content.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/settings/view_settings.h"
#include "app/view/window/mirror_window.h"

#include <array>
#include <functional>
#include <optional>

namespace binosplat {

// What a headset's frame looks from.
struct FrameViews {
    std::array<xr::EyeView, 2> eyes;
    std::array<Pose, 2> room_from_eyes;
    Pose room_from_head;
    std::optional<std::array<xr::EyeView, 2>> insets;  // from the same places, where the headset takes them
    std::array<std::optional<Gaze>, 2> gazes;          // by Side: where the eyes look, where it matters
};

class SceneRenderer {
public:
    // `format` is that of every session's images; the rest outlives this.
    SceneRenderer(const xr::Instance& instance, const Context& context, const RunOptions& options, const FrameLog& log, vk::Format format);

    // Of an eye's images, as large as the wearer wants them; beside insets those of the picture about them.
    [[nodiscard]] glm::uvec2 sizePx(const ViewSettings& settings) const { return sizePx(settings.resolution_scale); }
    // Images of the headset as large as the wearer wants them. Throws Error where there cannot be any; they are as large as before then.
    void fitImages(ConnectedHeadset& headset, const ViewSettings& settings);
    // What the governor makes of the wearer's settings, in images as large as that.
    void govern(ConnectedHeadset& headset, const ViewSettings& settings);
    // The runtime refuses depth after all; false: there was none.
    bool dropDepth(ConnectedHeadset& headset);

    // What render() will show. Throws Error where there is no memory for it; nothing is shown then, until this succeeds with less.
    void prepare(ConnectedHeadset& headset, ShownScene& shown, const Similarity& scene_from_room, const ViewSettings& settings,
                 const FrameViews& views);
    // Renders and presents that, in one submission with what `record_panel` records, and does not wait for it. With a `window` it keeps
    // an eye for that.
    void render(ConnectedHeadset& headset, ShownScene& shown, const ViewSettings& settings, MirrorWindow* window,
                const std::function<void(Commands&)>& record_panel);

    // The wearer wants the room behind the scene, and the headset can show it.
    [[nodiscard]] bool seesThrough(const ViewSettings& settings) const { return settings.passthrough && instance_.canSeeThrough(); }
    // Of those that the device is done with. No counters before the first frame of a scene.
    [[nodiscard]] const FrameResult& lastFrame() const { return last_; }
    // Another scene is shown: neither its counters nor what it takes are those of the one before.
    void forgetScene() {
        last_ = {};
        governor_.forget();
        splat_budget_.reset();
    }
    [[nodiscard]] const std::string& governorSentence() const { return governor_.sentence(); }
    // How many displays have a new picture, and how large that is.
    [[nodiscard]] ShownRate rate() const;
    [[nodiscard]] Presenter& presenter() { return presenter_; }

private:
    void makeImages(ConnectedHeadset& headset, glm::uvec2 size_px, glm::uvec2 inset_px);
    [[nodiscard]] glm::uvec2 sizePx(double scale) const;
    [[nodiscard]] glm::uvec2 insetPx(const ConnectedHeadset& headset, double scale) const;
    // Where they look, after the eyes that they are part of.
    void aimInsets(const ConnectedHeadset& headset, const Similarity& scene_from_room, const FrameViews& views);
    [[nodiscard]] std::vector<int> drawnEyes() const {
        return frame_.mode == Mode::kMono ? std::vector<int>{frame_.dominant} : std::vector<int>{kLeft, kRight};
    }
    [[nodiscard]] FrameSettings settingsOfFrame(ConnectedHeadset& headset, const ViewSettings& settings, double scale,
                                                const FrameViews& views, Order usual_order);
    // Those of `frame` into `images`.
    void recordEyes(Commands& commands, EyeImages& images, const StereoFrame& frame, bool tint, MirrorWindow* window);
    // As many splats of a streamed scene as a frame has time for, where nobody says a number.
    void fitSplats(SceneStream& stream, double period_ms);
    void sayHidden(bool one_eye);
    void sayCutShort();
    void sayGoverned();

    const xr::Instance& instance_;
    const RunOptions& options_;
    const FrameLog& log_;
    vk::Format format_;
    Presenter presenter_;
    bool has_gpu_;
    Governor governor_;
    std::optional<SplatBudget> splat_budget_;  // of the streamed scene that is shown
    MetDisplays met_;
    FrameSettings frame_;        // prepared
    std::vector<Eye> eyes_;      // prepared
    FrameSettings inset_frame_;  // likewise, of insets
    std::vector<Eye> inset_eyes_;
    std::optional<glm::uvec2> context_px_;  // recommended for what lies about insets, where there are any
    double insets_ms_ = 0.0;                // of the last ones known
    GovernedSettings governed_;             // as of the frame drawn last
    std::uint64_t governed_count_ = 0;
    bool said_beaten_ = false;
    std::uint64_t cut_short_ = 0;  // frames, as last said
    FrameResult last_;
    std::array<std::uint64_t, 2> hidden_tiles_{};  // as last said
    bool takes_depth_ = true;
};

}  // namespace binosplat
