// The viewer's loop: what the wearer sees, frame by frame.
#pragma once

#include "app/view/frame_submission.h"
#include "app/view/headset/headset_connection.h"
#include "app/view/headset/waiting_frames.h"
#include "app/view/panel/scene_requests.h"
#include "app/view/viewer_window.h"
#include "app/view/wearer_actions.h"

#include <chrono>

namespace binosplat {

class Viewer {
public:
    // `instance` and `context` must outlive the viewer. Begins to load the scene. Frames are shown in
    // `window`, too, if it is given.
    Viewer(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance,
           const Context& context, EventWindow* window);

    // Runs until the runtime, the wearer, Ctrl-C or --frames ends it. Prints changes by frame, and why it
    // ended, to stdout. A lost session is followed by another one, with the scene as it is, once there is a
    // headset. Throws errors of the scene and the device, and Error (exit code 3) if the runtime is lost.
    void run();

private:
    // One turn of the loop; false at its end.
    bool step();
    [[nodiscard]] ConnectedHeadset& headset() const { return *connection_.headset(); }  // while there is one
    void loseHeadset(const std::string& why);
    // Replaces a lost session if there is a headset; false at the end.
    bool comeBack();
    void leave();

    void drawFrame();
    // Keeps the window alive while no frame is drawn for the headset.
    void drawWindowAlone(const std::string& why);
    void takeScenes(bool at_once);  // see SceneExchange
    // Moves the room's origin to the head, once its pose is known or on request.
    void settle();
    // Shows the scene; false: there is none, or no memory for its frames.
    bool renderScene(FrameViews& views);
    void renderWaiting();
    void recordPanel(Commands& commands);

    // Lays out the widgets; acquires an image for the panel if it is `hung` and has changed.
    void layOutPanel(bool hung, double step_seconds);
    void followPanel(const PanelRequests& requests);
    void takeWindowInput(double step_seconds);
    void reloadShaders();
    // In the log, on the panel and in front of the eyes.
    void say(const std::string& message);
    void sayChange();
    void keepPreferences(double step_seconds, bool at_once);

    ViewOptions options_;
    xr::Instance& instance_;
    const Context& context_;
    ViewState state_;
    FrameLog log_;
    // Says things in the log alone, or also on the panel and in front of the eyes.
    const Say log_line_ = [this](const std::string& line) { log_.say(line); };
    const Say say_ = [this](const std::string& message) { say(message); };
    HeadsetConnection connection_;
    SceneRenderer renderer_;
    FrameSubmission submission_;
    Panel panel_;
    ViewerWindow window_;
    WaitingFrames waiting_;
    ScenePointing pointing_;
    bool picture_asked_ = false;  // for the next frame
    std::string pictured_;        // the scene of the last picture
    std::uint64_t frames_without_scene_ = 0;
    bool recentre_asked_ = false, leaving_ = false;
    std::chrono::steady_clock::time_point last_alone_{};
    SceneNotes notes_;
    SeenInRoom seen_;
    WearerPlace place_;
    FileWorker files_;   // its thread ends before the users of its results
    ShownScene scenes_;  // its loading thread ends before them
    DrawnSettings drawn_;
    SceneRequests requests_;
    KeptPicture kept_picture_;
    SceneExchange exchange_;
    WearerActions actions_;
    PictureWriter pictures_;  // last: it shows scenes
};

}  // namespace binosplat
