// The window's loop: the user's input, and what the window shows.
#pragma once

#include "app/desktop/camera_mover.h"
#include "app/desktop/curtain.h"
#include "app/desktop/desktop_pictures.h"
#include "app/desktop/desktop_window.h"
#include "app/terminal/frame_log.h"
#include "app/view/files/picture_writer.h"
#include "app/view/panel/panel_picture.h"
#include "app/view/panel/scene_requests.h"
#include "app/view/placement/ruler.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/scenes/shown_scene.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_state.h"

#include <array>
#include <atomic>
#include <chrono>
#include <map>

namespace binosplat {

class DesktopShell {
public:
    // Begins to load the scene. `context` must outlive the shell.
    DesktopShell(const ViewOptions& options, const ViewSettings& settings, const Context& context);

    ~DesktopShell() { leaving_ = true; }  // an open dialog ends

    void run();

private:
    using Clock = std::chrono::steady_clock;
    // Everything on which the scene's picture depends.
    struct Sight {
        const LoadedScene* scene = nullptr;
        const LoadedScene* other = nullptr;
        OrbitCamera camera;
        glm::uvec2 part_px{0, 0};
        ViewSettings settings;
        std::uint64_t moment = 0;  // counts the changes of a scene that moves or loads
        bool operator==(const Sight&) const = default;
    };

    // One turn of the loop.
    void step();
    [[nodiscard]] double secondsToWait() const;
    void takeScene();
    // Another scene to compare with: beside a curtain, or in the whole window while a key is held.
    struct Comparison {
        explicit Comparison(const Context& context) : pictures(context), curtain(context) {}
        DesktopPictures pictures;  // of the other scene
        Curtain curtain;
        bool is_whole = false;        // the other scene fills the window
        bool is_whole_asked = false;  // even if no key is held
    };
    void takeOther();
    void followComparison();
    // True if the pointer's event was the curtain's.
    bool moveCurtain(const DesktopEvent& event);
    [[nodiscard]] bool isOtherAt(const glm::dvec2& place_px) const;
    // Does nothing if there is no other scene.
    void renderOther(const std::vector<Eye>& eyes, const FrameSettings& settings, bool at_rest);
    void composeScenes(Commands& commands, vk::Image window);
    void keepPictureOfScene();

    // Pictures.
    [[nodiscard]] WindowPart panelPart() const;
    [[nodiscard]] glm::uvec2 areaPx() const;  // beside the panel
    [[nodiscard]] std::vector<EyePart> parts() const {
        return partsOf(state_.settings().window_stereo, areaPx());
    }
    [[nodiscard]] DesktopPictures::Look look() const {
        return {state_.settings().tint, state_.settings().window_stereo == WindowStereo::kAnaglyph};
    }
    [[nodiscard]] WindowSight windowSight() const;
    [[nodiscard]] Sight sightNow() const;
    [[nodiscard]] FrameSettings frameSettingsNow(bool at_rest) const;
    void draw(double seconds);
    void drawScene(double seconds);
    void render(double scale, bool at_rest);
    void show();

    // Input.
    void handle(const DesktopEvent& event);
    void press(const DesktopEvent& event);
    void pressKey(int key);
    // The point of the scene that the picture shows at a place of the window or, if it shows nothing there, a
    // point as far away as the centre.
    [[nodiscard]] std::optional<glm::dvec3> seenAt(const glm::dvec2& place_px);
    [[nodiscard]] glm::dvec3 under(const glm::dvec2& place_px);
    void goTo(const Viewpoint* viewpoint, double within_seconds = 0.35);  // null: stays
    // Typed text goes to the panel while it asks for something.
    bool takesText(const DesktopEvent& event);
    [[nodiscard]] HeldMotion heldMotion() const {
        return panel_.entry().isOpen() ? HeldMotion() : window_.heldMotion();
    }
    void showWhole();
    void showStart();

    // The panel.
    void layOutPanel(const PanelPointer& pointer, double seconds);
    void follow(const PanelRequests& requests);
    void openAndSave(const PanelRequests& requests);
    void measure(const PanelRequests& requests);
    void changeViewpoints(const PanelRequests& requests);
    void openFile();
    void openDropped(const DesktopEvent& event);
    void takePicture();
    void showPanel();
    void say(const std::string& message);

    ViewOptions options_;
    const Context& context_;
    FrameLog log_;
    ViewState state_;
    DesktopWindow window_;
    DesktopPictures pictures_;
    std::string title_;
    std::optional<Comparison> comparison_;  // from the first one on
    PanelPicture panel_;
    MotionScale motion_;
    CameraMover mover_;
    std::map<std::string, OrbitCamera> left_;  // by place: where another scene replaced this one
    std::array<Commands, 2> commands_;         // that compose the window, taking turns

    PanelPointer pointer_;  // on the panel
    double angle_rad_;      // of view
    Sight drawn_;
    bool is_refined_ = true, is_shown_ = true, writes_picture_ = false;
    std::atomic<bool> leaving_ = false;  // dialogs ask, too
    int layouts_due_ = 2;                // widgets settle one layout after input
    std::uint64_t shown_panel_ = 0, scene_frames_ = 0, pictures_without_scene_ = 0, moment_ = 0;
    Ruler ruler_;
    glm::dvec2 pressed_px_{0.0};  // the last press of the left button
    Clock::time_point pressed_at_{}, changed_at_{}, last_step_ = Clock::now();
    SceneNotes notes_;
    ViewpointList viewpoints_;
    FileWorker dialogs_, files_;  // their threads end before the objects that use their results
    ShownScene scenes_;           // its loading thread ends before them
    SceneRequests requests_;
    PictureWriter writer_;  // last: it shows scenes
};

}  // namespace binosplat
