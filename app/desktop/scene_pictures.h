// When the scene is drawn for the window, and how: coarsely while something changes, in full once it rests,
// then with four samples per pixel, a quarter of the picture after the other, so that the window answers
// between them; and what is seen in its picture.
#pragma once

#include "app/desktop/curtain.h"
#include "app/desktop/desktop_pictures.h"
#include "app/view/files/picture_writer.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/settings/view_state.h"

#include <chrono>
#include <functional>
#include <optional>

namespace binosplat {

// Frames in motion with these settings.
FramesAhead framesInMotion(const ViewSettings& settings, glm::uvec2 size_px);

// Whether the picture of a part of the window, which takes this long with one sample per pixel, becomes one
// with `samples` each way once it rests.
bool becomesSmooth(SmoothAtRest wish, double samples, glm::uvec2 part_px, double picture_ms);

class ScenePictures {
public:
    // All must exist while it is used.
    ScenePictures(const Context& context, const CameraOptions& options, const ViewState& state,
                  ShownScene& scenes, const Curtain& curtain, PictureWriter& writer, Say say)
        : context_(context),
          options_(options),
          state_(state),
          scenes_(scenes),
          curtain_(curtain),
          writer_(writer),
          say_(std::move(say)),
          shown_(context) {}

    // Another scene is shown.
    void forget();
    // From now on another one is compared with it.
    void beginComparison();
    // Once per turn: draws the scene if its picture is to change; true if it did.
    bool draw(const OrbitCamera& camera, const WindowLayout& layout, double seconds, double refresh_hz);
    // The time until then, if nothing else changes.
    [[nodiscard]] double secondsToNext() const;
    // Also has one written to a file, once it is drawn in full.
    void askForFile() { is_file_asked_ = true, refinement_ = Refinement::kMoving; }
    // Of the last one, for the list of scenes.
    void keep(SceneNotes& notes);

    // Records both scenes and the curtain into a window that has been cleared.
    void compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts);
    // The point of the scene that is shown at a place of the window, if any is.
    [[nodiscard]] std::optional<glm::dvec3> seenAt(const std::vector<EyePart>& parts,
                                                   const glm::dvec2& place_px);
    [[nodiscard]] const FrameResult& lastFrame() const { return shown_.lastFrame(); }
    // What was rendered last for each eye; none before the scene's first picture.
    [[nodiscard]] std::optional<glm::uvec2> sizePx() const {
        return shown_.eyes().empty() ? std::nullopt : std::optional(shown_.eyes().front().size_px);
    }

private:
    using Clock = std::chrono::steady_clock;
    // Everything on which the picture depends.
    struct Sight {
        std::array<LoadedScene*, 2> scenes{};
        OrbitCamera camera;
        glm::uvec2 part_px{0, 0};
        ViewSettings settings;
        std::array<std::size_t, 2> frames{};  // of scenes that move
        std::uint64_t moment = 0;             // counts while one loads
        bool operator==(const Sight&) const = default;
    };

    enum class Refinement { kMoving, kFull, kSmooth };

    // Of the smooth picture, per pixel of the window each way.
    [[nodiscard]] double samples() const;
    // Whether it becomes smooth at rest.
    [[nodiscard]] bool smooths() const;
    // Until the next refinement, if nothing changes; empty: this is the last one.
    [[nodiscard]] std::optional<double> secondsToRefine() const;
    [[nodiscard]] std::array<LoadedScene*, 2> both() const { return {scenes_.get(), scenes_.other()}; }
    void render(const WindowLayout& layout, double scale, bool at_rest, double refresh_hz);
    // Into the frames, too; returns the time on the device.
    double renderWhole(double scale, bool at_rest);
    // The next quarter with four samples per pixel; true once all are shown.
    bool smoothOn();
    // The frames have the whole picture again.
    void takeBackQuarters();
    // Calls `draw` for the scene, then for the other one, whose eyes these become; that one may be lost.
    void renderBoth(std::vector<Eye> eyes,
                    const std::function<void(DesktopPictures& pictures, StereoFrame& frame,
                                             const std::vector<Eye>& eyes)>& draw);
    void writeFile(const WindowLayout& layout);
    [[nodiscard]] FrameSettings settingsFor(bool at_rest) const;

    const Context& context_;
    const CameraOptions& options_;
    const ViewState& state_;
    ShownScene& scenes_;
    const Curtain& curtain_;
    PictureWriter& writer_;
    Say say_;
    DesktopPictures shown_;
    std::optional<DesktopPictures> other_;  // from the first comparison on
    MotionScale motion_;
    Sight drawn_;
    WindowSight drawn_sight_;
    Refinement refinement_ = Refinement::kSmooth;
    int quarters_ = 0;  // drawn so far of the smooth picture, if it is not shown
    bool is_file_asked_ = false;
    std::uint64_t moment_ = 0;
    Clock::time_point changed_at_{};
};

}  // namespace binosplat
