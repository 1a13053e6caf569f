// Runs the window: from the user's input to what it shows.
#include "app/desktop/desktop.h"

#include "app/desktop/camera_place.h"
#include "app/desktop/desktop_panel.h"
#include "app/desktop/open_dialog.h"
#include "app/options/device_options.h"
#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/panel/scene_requests.h"
#include "app/view/window/mirror_window.h"
#include "engine/error.h"
#include "engine/ready.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace binosplat {

namespace {

constexpr double kIdleSeconds = 0.25;     // how often to check for Ctrl-C
constexpr double kLoadingSeconds = 0.05;  // how often to check for results of threads
constexpr double kBusySeconds = 0.002;

class DesktopShell {
public:
    // Begins to load the scene. `context` must outlive the shell.
    DesktopShell(const ViewOptions& options, const ViewSettings& settings, const Context& context)
        : options_(options),
          state_(settings),
          window_(context),
          curtain_(context, log_),
          panel_(context, log_),
          pictures_(context, options_.run.camera, state_, scenes_, curtain_, writer_, say_),
          commands_{Commands(context), Commands(context)},
          notes_(files_, say_),
          place_(options_.run, pictures_, state_, notes_, files_, log_, say_),
          scenes_(context, options_, log_, framesInMotion(settings, window_.sizePx())),
          requests_(state_, scenes_, notes_, files_, panel_.picture(), say_) {}
    DesktopShell(const DesktopShell&) = delete;
    DesktopShell& operator=(const DesktopShell&) = delete;
    ~DesktopShell() { leaving_ = true; }  // an open dialog ends

    void run() {
        while (!leaving_) { step(); }
        while (const std::optional<std::string> outcome = writer_.finish()) { say_(*outcome); }
        pictures_.keep(notes_);
        notes_.keepPreferences(state_.settings(), 0.0, true);
        files_.finish();
        log_.print(fmt::format("{} pictures in the window, {} of the scene", log_.frame, scene_frames_));
    }

private:
    using Clock = std::chrono::steady_clock;

    void step() {
        window_.wait(secondsToWait());
        const Clock::time_point now = Clock::now();
        const double seconds =
            std::min(std::chrono::duration<double>(now - std::exchange(last_step_, now)).count(), 0.1);
        const bool is_enough =
            options_.frames != 0 && log_.frame - pictures_without_scene_ >= options_.frames;
        if (isInterrupted() || window_.isClosed() || is_enough) { leaving_ = true; }
        takeResults();
        for (const DesktopEvent& event : window_.takeEvents()) { handle(event); }
        place_.pass(heldMotion(), seconds);
        followCurtain();
        layOutPanel(seconds);
        draw(seconds);
        notes_.keepPreferences(state_.settings(), seconds);
        if (const std::string change = state_.takeChange(); !change.empty()) { log_.say(change); }
    }

    [[nodiscard]] double secondsToWait() const {
        if (window_.isMinimized()) { return kIdleSeconds; }
        if (!is_shown_) { return kBusySeconds; }
        if (panel_.isDue() || place_.isOnWay() || heldMotion().isAny()) { return 0.0; }
        double most = std::min(kIdleSeconds, pictures_.secondsToNext());
        if (place_.viewpoints().isTouring() || scenes_.isLoading() || !files_.now().empty() ||
            chosen_.valid()) {
            most = std::min(most, kLoadingSeconds);
        }
        return most;
    }

    // What threads have done since the last turn.
    void takeResults() {
        scenes_.freeGone();
        files_.deliver();
        if (isReady(chosen_)) {
            const ChosenFile chosen = chosen_.get();
            if (!chosen.trouble.empty()) { say_(chosen.trouble); }
            if (!chosen.file.empty()) { scenes_.begin(chosen.file); }
        }
        if (const std::optional<std::string> outcome = writer_.takeOutcome()) { say_(*outcome); }
        if (scenes_.isNextReady() && !writer_.isTaking()) { takeScene(); }
        if (scenes_.isOtherReady() && !writer_.isTaking()) { takeOther(); }
        if (scenes_.get() != nullptr) { window_.setTitle(scenes_.names() + " - binosplat"); }
    }

    void takeScene() {
        const LoadedScene* const before = scenes_.get();
        pictures_.keep(notes_);
        const std::string complaint = scenes_.take(state_);
        if (!complaint.empty()) { say_(complaint); }
        LoadedScene* const scene = scenes_.get();
        if (scene == before) { return; }
        is_shown_ = false;
        is_new_ = true;
        pictures_.forget();
        place_.show(scene);  // none, if it has made way for the next one
        if (scene != nullptr) { notes_.remember(scene->name, complaint); }
    }

    void takeOther() {
        if (const std::string complaint = scenes_.takeOther(); !complaint.empty()) { return say_(complaint); }
        pictures_.beginComparison();
        curtain_.setStaysAway(false);
        notes_.remember(scenes_.other()->name, {});
        say_(fmt::format("left of the line {}, right of it {}: drag it, or hold C", scenes_.get()->name,
                         scenes_.other()->name));
    }

    void handle(const DesktopEvent& event) {
        using Kind = DesktopEvent::Kind;
        if (panel_.takesText(event)) { return; }
        const WindowLayout at = layout();
        const bool compares = scenes_.other() != nullptr;
        const bool is_free = !place_.isDragged() && !(compares && curtain_.isDragged());
        if (panel_.takesMouse(event, at.panel, is_free)) { return layOutPanel(0.0); }
        if (compares && curtain_.takes(event, at.parts)) { return; }
        place_.handle(event, at, panel_.picture().entry());
        if (event.kind == Kind::kDrop && !place_.takeViewpoints(event.path)) {
            scenes_.begin(event.path, event.second);
        }
        if (event.kind == Kind::kKey) {
            follow(requestsOf(event.code, state_.settings(), panel_.picture().status()));
        }
    }

    void followCurtain() {
        const bool compares = scenes_.other() != nullptr;
        window_.pointSideways(compares && curtain_.isPointedAt() && !place_.isDragged());
        if (compares && curtain_.hold(window_.isHeld(GLFW_KEY_C) && !panel_.isTyping())) {
            log_.say(curtain_.isAway() ? "shows " + scenes_.other()->name : "the curtain is back");
        }
        if (curtain_.takeMove()) { is_shown_ = false; }
    }

    void layOutPanel(double seconds) {
        PanelPicture& panel = panel_.picture();
        requests_.fillStatus(curtain_.staysAway(), place_.viewpoints());
        if (const LoadedScene* const scene = scenes_.get(); scene != nullptr) {
            panel.status().facts =
                describeFacts(scene->facts, scene->measured.value_or(options_.run.metres_per_unit));
        }
        panel.showTimes(pictures_.lastFrame(), "", seconds);
        panel.askFor(files_, state_.settings());
        follow(panel_.layOut(state_.settings(), seconds));
    }

    void follow(const PanelRequests& requests) {
        state_.set(requests.settings);
        if (requests.help) { panel_.toggleHelp(state_); }
        if (requests.fill_screen) { panel_.setFillsScreen(window_.toggleFullScreen()); }
        place_.follow(requests, panel_.picture().entry());
        requests_.follow(requests);
        // On the page with the list of scenes, the scene to compare with is chosen from that list.
        const bool chooses = requests.compare && scenes_.comparesNext();
        const bool opens = requests.open_file || (chooses && state_.settings().page != PanelPage::kScenes);
        if (opens && !chosen_.valid()) {
            chosen_ = std::async(std::launch::async, askForFile, [this] { return leaving_.load(); });
        }
        if (requests.show_other) { curtain_.setStaysAway(!curtain_.staysAway()); }
        if (requests.take_picture && scenes_.get() != nullptr) { pictures_.askForFile(); }
        if (requests.quit) { leaving_ = true; }
    }

    void draw(double seconds) {
        if (window_.isMinimized()) { return; }
        if (window_.takeDamage()) { is_shown_ = false; }
        if (is_shown_ && scenes_.get() != nullptr &&
            pictures_.draw(place_.camera(), layout(), seconds, window_.refreshHz())) {
            ++scene_frames_;
            is_shown_ = false;
            panel_.keepFrameTime();
        }
        const std::uint64_t panel = state_.settings().panel ? panel_.picture().canvas().revision() : 0;
        if (std::exchange(shown_panel_, panel) != panel) { is_shown_ = false; }
        if (is_shown_) { return; }
        is_shown_ =
            window_.show([this](vk::Image target, vk::Semaphore drawn) { compose(target).submit(drawn); });
        log_.frame += is_shown_ ? 1 : 0;
        pictures_without_scene_ += is_shown_ && scenes_.get() == nullptr ? 1 : 0;
        const std::optional<glm::uvec2> size_px = pictures_.sizePx();
        if (is_shown_ && size_px && std::exchange(is_new_, false)) {
            log_.say(fmt::format("its first picture has {}x{} pixels", size_px->x, size_px->y));
        }
    }

    Commands& compose(vk::Image target) {
        Commands& commands = commands_[log_.frame % commands_.size()];
        commands.wait();
        commands.begin();
        const WindowLayout at = layout();
        PanelPicture& panel = panel_.picture();
        if (at.panel.size_px.x > 0) { panel.record(commands); }
        clearWindow(commands, target);
        pictures_.compose(commands, target, at.parts);
        if (at.panel.size_px.x > 0) {
            blitInto(commands, panel.canvas().image(), kPanelPx, target, at.panel);
        }
        changeLayout(commands, target, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::ePresentSrcKHR);
        return commands;
    }

    [[nodiscard]] WindowLayout layout() const {
        return layOutWindow(window_.sizePx(), window_.scale(), state_.settings(), place_.angleRad());
    }
    [[nodiscard]] HeldMotion heldMotion() const {
        return panel_.isTyping() ? HeldMotion() : window_.heldMotion();
    }

    ViewOptions options_;
    FrameLog log_;
    ViewState state_;
    DesktopWindow window_;
    Curtain curtain_;
    DesktopPanel panel_;
    const Say say_ = [this](const std::string& message) { panel_.say(message); };
    ScenePictures pictures_;
    std::array<Commands, 2> commands_;  // that compose the window, taking turns
    bool is_shown_ = true;
    bool is_new_ = false;  // no picture of the scene was shown yet
    std::uint64_t shown_panel_ = 0, scene_frames_ = 0, pictures_without_scene_ = 0;
    Clock::time_point last_step_ = Clock::now();
    SceneNotes notes_;
    CameraPlace place_;
    std::atomic<bool> leaving_ = false;  // the dialog asks, too
    std::future<ChosenFile> chosen_;     // in the dialog, while it is open
    FileWorker files_;                   // its thread ends before the users of its results
    ShownScene scenes_;                  // its loading thread ends before them
    SceneRequests requests_;
    PictureWriter writer_;  // last: it shows scenes
};

}  // namespace

void runDesktop(const ViewOptions& options, const ViewSettings& settings) {
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    if (windows == nullptr) {
        throw Error(ExitCode::kNoDevice, WindowSystem::whyNone() + "; use `binosplat render`");
    }
    ContextOptions context_options = contextOptions(options.run);
    context_options.instance_extensions = WindowSystem::instanceExtensions();
    context_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    const Context context(context_options);
    FrameLog::print(fmt::format("a window, on {}", context.deviceName()));
    DesktopShell(options, settings, context).run();
    context.requireNoValidationMessages();
}

}  // namespace binosplat
