// The scene's pictures in a window: rendered, kept, and composed with the panel's.
#pragma once

#include "app/desktop/eye_parts.h"
#include "app/view/window/window_drawing.h"
#include "engine/frame/stereo_frame.h"
#include "engine/gpu/own_image.h"
#include "engine/passes/present.h"

#include <array>
#include <optional>
#include <vector>

namespace binosplat {

// The resolution, each way, of pictures in motion: chosen by the cost of a full one, so that they come about
// as often as the display is refreshed. It begins low, since a first picture at once is worth more than a
// sharp one later.
class MotionScale {
public:
    explicit MotionScale(bool is_software = false);

    // A picture at this share of the resolution took this long on the device; the display is refreshed this
    // often.
    void measure(double scale, double gpu_ms, double refresh_hz);
    [[nodiscard]] double scale() const { return scale_; }

private:
    double full_ms_ = 0.0;  // smoothed; 0: not known yet
    double scale_;
};

class DesktopPictures {
public:
    explicit DesktopPictures(const Context& context);

    // Renders these eyes, all of the same size; tinted if the settings keep classes. With `waits` the picture
    // is complete when this returns; otherwise it does not wait, and the picture may lack splats. Throws
    // Error if memory is short.
    void render(StereoFrame& frame, const std::vector<Eye>& eyes, const FrameSettings& settings,
                WindowStereo stereo, bool waits);
    // The same for a quarter of each eye's picture, with more samples; waits. The frame then has this
    // quarter.
    void renderQuarter(int quarter, StereoFrame& frame, const std::vector<Eye>& eyes,
                       const FrameSettings& settings, WindowStereo stereo);
    // From now on the four quarters are shown, until the next picture.
    void showQuarters() { shows_quarters_ = true; }
    // Records the parts' pictures, scaled, into a window that has been cleared; of each only what lies to the
    // right of this share of its width.
    void compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts,
                 double from_share = 0.0);

    // The last frame that the device has finished.
    [[nodiscard]] const FrameResult& lastFrame() const { return last_; }
    // The eyes that were rendered last; none before the first.
    [[nodiscard]] const std::vector<Eye>& eyes() const { return eyes_; }
    void forget() { eyes_.clear(), last_ = {}; }

private:
    // A picture of each eye.
    struct Pictures {
        std::array<std::optional<OwnImage>, 2> images;
        glm::uvec2 memory_px{0, 0}, size_px{0, 0};  // of each image, and of the picture in it
    };
    void reserve(Pictures& pictures, glm::uvec2 size_px, std::size_t eyes);
    std::optional<FrameResult> render(Pictures& into, StereoFrame& frame, const std::vector<Eye>& eyes,
                                      const FrameSettings& settings, WindowStereo stereo, bool waits);

    const Context& context_;
    Presenter presenter_;
    Pictures whole_;
    std::array<Pictures, 4> quarters_;
    bool shows_quarters_ = false;
    std::vector<Eye> eyes_;
    FrameResult last_;
};

}  // namespace binosplat
