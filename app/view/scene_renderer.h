// From the scene to the headset's images: resolution, method, both eyes' pictures.
#pragma once

#include "app/axes/staying_axes.h"
#include "app/terminal/frame_log.h"
#include "app/view/frame_views.h"
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
#include <span>

namespace binosplat {

// A picture of the frame: its eye, and that of what is seen of it.
struct SeenPicture {
    int eye_of_frame;
    Eye picture, view;
};

class SceneRenderer {
public:
    // `format` is the format of every session's images; the rest must outlive this.
    SceneRenderer(const xr::Instance& instance, const Context& context, const RunOptions& options,
                  const FrameLog& log, vk::Format format);

    // The size of what an eye sees, as the wearer wants it; with insets, of the context.
    [[nodiscard]] glm::uvec2 sizePx(const ViewSettings& settings) const {
        return sizePx(settings.resolution_scale);
    }
    // In each frame: begins to make images for these settings beside it, if those that are there do not suit
    // them, and frees those that no frame uses any more.
    ImagesFor imagesFor(ConnectedHeadset& headset, const ViewSettings& settings, const FrameViews& views,
                        bool has_window);
    // Makes the headset's images as large as the wearer wants, or larger if axes stay, unless they have been
    // made beside the frames, and lets the governor adjust the wearer's settings, never above them. What it
    // chooses is drawn once lists of the shown scene have capacity for that. Throws Error if images of
    // another size cannot be made; then they keep their size.
    void govern(ConnectedHeadset& headset, const ViewSettings& settings, const FrameViews& views,
                ShownScene& shown, MirrorWindow* window);
    // For a runtime that turned out to refuse depth; returns false if depth was already off.
    bool dropDepth(ConnectedHeadset& headset);

    // Chooses the eyes and the settings of a frame of a scene, and sets the pictures of `views`.
    void aim(ConnectedHeadset& headset, const Similarity& scene_from_room, const ViewSettings& settings,
             FrameViews& views);
    // Frames like that one, of another scene.
    [[nodiscard]] FramesWanted framesWanted(const ConnectedHeadset& headset,
                                            const Similarity& there_from_here) const;
    // The same for frames with other settings, in the images for these, before prepare().
    [[nodiscard]] FramesWanted framesWanted(ConnectedHeadset& headset, const Similarity& scene_from_room,
                                            const ViewSettings& settings, FrameViews views,
                                            const Similarity& there_from_here);
    // True once it is known what the lenses hide of pictures for these settings, which it finds out.
    [[nodiscard]] bool knowsLens(ConnectedHeadset& headset, const ViewSettings& settings,
                                 const FrameViews& views) const;
    // Aims, and prepares what render() will show of the scene that is drawn. Throws Error if memory is short;
    // then nothing is shown until this succeeds with less.
    void prepare(ConnectedHeadset& headset, ShownScene& shown, const Similarity& scene_from_room,
                 const ViewSettings& settings, FrameViews& views);
    // See ShownScene; call this once that is prepared.
    void meetOther(const ConnectedHeadset& headset, ShownScene& shown) const;
    // Renders and presents what was prepared, in one submission with what `record_panel` records, without
    // waiting for it. With a `window`, one eye's picture is kept for it.
    void render(ConnectedHeadset& headset, ShownScene& shown, const ViewSettings& settings,
                MirrorWindow* window, const std::function<void(Commands&)>& record_panel);

    // What the eyes see, or the dominant one, in full at the headset's size, without a mask, whatever the
    // frames are.
    [[nodiscard]] PictureShot shotOf(const ShownScene& shown, const Similarity& scene_from_room,
                                     const ViewSettings& settings, const FrameViews& views) const;

    // True if the wearer wants the room behind the scene, and the headset can show it.
    [[nodiscard]] bool seesThrough(const ViewSettings& settings) const {
        return settings.passthrough && instance_.canSeeThrough();
    }
    // The last frame that the device has finished. No counters before a scene's first frame.
    [[nodiscard]] const FrameResult& lastFrame() const { return last_; }
    // The dominant eye's prepared picture, or the only one; empty: none is prepared.
    [[nodiscard]] std::optional<SeenPicture> seenPicture() const {
        if (eyes_.empty()) { return {}; }
        const std::size_t at = frame_.mode == Mode::kMono ? 0 : static_cast<std::size_t>(frame_.dominant);
        return SeenPicture{static_cast<int>(at), eyes_[at], seen_[at]};
    }
    // True if the eyes saw background in the last two frames because a list was full.
    [[nodiscard]] bool wasCutShort() const { return was_cut_short_; }
    // Another scene is shown: counters and costs of the previous one do not apply.
    void forgetScene() {
        last_ = {};
        governor_.forget();
        splat_budget_.reset();
    }
    [[nodiscard]] const std::string& governorSentence() const { return governor_.sentence(); }
    // For each frame that will be shown, before the panel. If a frame was late, says why; only once, until
    // none has been late for a second.
    void meetDisplay(const xr::Session& session);
    // How many frames reach the wearer, and their resolution.
    [[nodiscard]] ShownRate rate() const;
    [[nodiscard]] Presenter& presenter() { return presenter_; }

private:
    // Images for the wearer's settings.
    struct ImagesWanted {
        ImagesAsked asked;
        glm::uvec2 least_px{0, 0}, size_px{0, 0};
        std::string why_not_stay;  // why axes do not, if the wearer wants that
    };
    // What a frame is drawn into.
    struct FrameSizes {
        glm::uvec2 view_px{0, 0};  // of what an eye sees
        glm::uvec2 images_px{0, 0}, inset_px{0, 0}, inset_images_px{0, 0};
        bool stay = false;
    };
    [[nodiscard]] ImagesWanted imagesWanted(const ConnectedHeadset& headset, const ViewSettings& settings,
                                            const FrameViews& views) const;
    [[nodiscard]] bool suit(const ConnectedHeadset& headset, const ImagesWanted& wanted) const;
    void fitImages(ConnectedHeadset& headset, const ViewSettings& settings, const FrameViews& views,
                   MirrorWindow* window);
    void makeImages(ConnectedHeadset& headset, glm::uvec2 size_px, glm::uvec2 inset_px);
    void exchangeImages(ConnectedHeadset& headset, ImageSet images, MirrorWindow* window);
    void takeGoverned(const ConnectedHeadset& headset, const FrameViews& views, ShownScene& shown);
    // Prepares pictures whose axes stay, of the eyes that were prepared.
    void keepAxes(const Similarity& scene_from_room, FrameViews& views);
    [[nodiscard]] glm::uvec2 sizePx(double scale) const;
    [[nodiscard]] glm::uvec2 insetPx(const ConnectedHeadset& headset, double scale) const;
    // Sets up the insets' eyes, after the eyes that they are part of.
    void aimInsets(const Similarity& scene_from_room, const FrameViews& views);
    [[nodiscard]] std::span<const int> drawnEyes() const {
        static constexpr std::array<int, 2> kEyes{kLeft, kRight};
        return frame_.mode == Mode::kMono
                   ? std::span(kEyes).subspan(static_cast<std::size_t>(frame_.dominant), 1)
                   : std::span(kEyes);
    }
    [[nodiscard]] glm::dvec3 backgroundOf(const ViewSettings& settings, const glm::dvec3& set) const;
    [[nodiscard]] std::array<std::span<const std::uint8_t>, 2> hiddenTiles(ConnectedHeadset& headset,
                                                                           const ViewSettings& settings,
                                                                           const FrameViews& views,
                                                                           glm::uvec2 size_px) const;
    // All that the governor may choose for what an eye sees.
    [[nodiscard]] std::vector<glm::uvec2> sizesToCome(const ViewSettings& settings) const;
    [[nodiscard]] FrameSettings settingsOfFrame(ConnectedHeadset& headset, const ViewSettings& settings,
                                                double scale, const FrameViews& views);
    // Presents the eyes of `frame` into `images`.
    void recordEyes(Commands& commands, EyeImages& images, const StereoFrame& frame, bool tint,
                    MirrorWindow* window);
    // Fits the splats of a streamed scene to the frame time, unless the user sets a number.
    void fitSplats(SceneStream& stream, double period_ms);
    void sayHidden(const std::array<std::span<const std::uint8_t>, 2>& hidden);
    void sayCutShort(bool of_other);
    void sayGoverned(bool is_other);  // than before

    const xr::Instance& instance_;
    const Context& context_;
    const RunOptions& options_;
    const FrameLog& log_;
    vk::Format format_;
    Presenter presenter_;
    bool has_gpu_;
    Governor governor_;
    std::optional<SplatBudget> splat_budget_;  // of the streamed scene that is shown
    MetDisplays met_;
    bool is_late_ = false;   // any frame of the last second
    FrameSettings frame_;    // prepared
    std::vector<Eye> eyes_;  // prepared
    std::vector<Eye> seen_;  // their views: the same unless axes stay
    FrameSizes sizes_;
    ImagesAsked images_asked_;
    std::string why_not_;  // why axes do not stay, as last reported
    StayingAxes axes_{glm::radians(kAxesMarginDegrees)};
    FrameSettings inset_frame_;  // prepared, for insets
    std::vector<Eye> inset_eyes_;
    std::optional<glm::uvec2> context_px_;  // recommended for the context, if there are insets
    double insets_ms_ = 0.0;                // GPU time of the last known insets
    GovernedSettings governed_;             // in the frame that is drawn
    std::uint64_t governed_count_ = 0;
    std::uint32_t measured_part_ = 0;
    bool said_beaten_ = false;
    // Frames that were cut short, as last reported: for the scene that is shown, and for the other one.
    std::array<std::uint64_t, 2> cut_short_{};
    bool was_cut_short_ = false;
    FrameResult last_;
    std::array<std::uint32_t, 2> hidden_tiles_{};  // as last reported
    bool takes_depth_ = true;
};

}  // namespace binosplat
