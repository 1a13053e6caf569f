// Facts about the window alongside the headset: what mouse, keys and files do, and how it ends.
#include "tests/app/view/view_window.h"
#include "app/view/window/mirror_window.h"
#include "tests/app/view/view_quiet.h"

#include <chrono>

SUITE(view_window) {

const std::string kScene = "builtin:slanted-wall --load-first --mode mono";
const std::string kSmall = "rate 60\nsize 96 96\nframes none\n";

std::string onDesk() {
    return "XDG_CONFIG_HOME=\"$PWD/../config\" WAYLAND_DISPLAY= DISPLAY=" + desk().screen.name;
}

// In the fork that is the viewer, the window's events once hold it up for some frames of this log.
constexpr const char* kHeldUntil = "BINOSPLAT_TEST_HELD_UNTIL";
constexpr std::ptrdiff_t kFramesHeld = 60;

std::ptrdiff_t countFrames(const std::string& log) { return std::ranges::count(textIn(log), '\n'); }

// It gives up eventually if the program does not show a frame meanwhile.
void holdUp() {
    static bool is_over = false;
    const char* const log = std::getenv(kHeldUntil);
    if (log == nullptr || std::exchange(is_over, true)) { return; }
    const auto latest = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatienceMs);
    const std::ptrdiff_t enough = countFrames(log) + kFramesHeld;
    while (countFrames(log) < enough) {
        if (std::chrono::steady_clock::now() > latest) { return; }
        std::this_thread::yield();
    }
    std::ofstream(std::string(log) + ".went-on");
}

// The eye's picture from the magnified one: the window's pixels nearest to the middles of the eye's.
Image eyeInWindow(const Image& screen, glm::uvec2 eye_px) {
    const glm::dvec2 scale = glm::dvec2(kEyePx) / glm::dvec2(eye_px);
    return makePicture(eye_px, [&](std::uint32_t x, std::uint32_t y) {
        const glm::uvec2 at(scale * (glm::dvec2(x, y) + 0.5));
        return colourOf(screen, at.x, at.y);
    });
}

// From the last composed picture.
Image lastLeftEye(const fs::path& folder) {
    ViewRun run;
    run.out = folder;
    fs::path last;
    for (const auto& file : fs::directory_iterator(folder)) {
        if (file.path().extension() == ".png") { last = std::max(last, file.path()); }
    }
    return run.eye(std::stoul(last.stem().string().substr(6)), kLeft);
}

double turnBetween(const Similarity& a, const Similarity& b) {
    const glm::dquat turn = glm::conjugate(a.orientation) * b.orientation;
    return 2.0 * std::atan2(turn.y, turn.w);
}
glm::dvec3 stepBetween(const Similarity& a, const Similarity& b) {
    return glm::conjugate(a.orientation) * (b.position - a.position);
}

// Escape, or the window's close button, ends the program in a headset with these script lines.
void checkEnds(const std::string& lines, bool by_cross, int dpi = 96) {
    CAPTURE(lines);
    const Workplace work;
    Viewer viewer(work, kSmall + lines, "", dpi);
    // Keys work, and the panel follows them.
    viewer.tab();
    viewer.tab();
    if (dpi != 96) {
        // The window follows the desktop's scale as far as it fits, and may be resized in its shape.
        const glm::dvec2 whole(kEyePx + kPanelInWindowPx.x, kEyePx), most = glm::dvec2(kScreenPx) / whole;
        const double scale = std::min({dpi / 96.0, most.x, most.y});
        const glm::dvec2 size(numberOfWindow("^binosplat$", "WIDTH"),
                              numberOfWindow("^binosplat$", "HEIGHT"));
        CHECK(glm::all(glm::lessThan(glm::abs(size - scale * whole), glm::dvec2(2.0))));
        CHECK(glm::all(glm::lessThanEqual(size, glm::dvec2(kScreenPx))));
        CHECK(desk(dpi).connection.resizesInShape(numberOfWindow("^binosplat$", "WINDOW")) ==
              std::pair(true, true));
        // The widgets are where they are drawn.
        viewer.handsInTurn(
            {moveTo(scale * (glm::dvec2(kEyePx, 0.0) + placeOf("Vignette", true) * kPanelInWindowPx)),
             "mousedown 1", "mouseup 1"});
        viewer.await("vignette = false");
    }
    if (by_cross) {
        clickCross("^binosplat$");
    } else {
        hands("key Escape");
    }
    viewer.checkEnd();
}

const std::string kOff = "at -1 worn off\n", kElsewhere = "at -1 visible off\n",
                  kGone = "no-headset-for 1000000 after-loss\nat 0.1 lose-session\n";

// The linker prefers this one to GLFW's own.
extern "C" void glfwWaitEventsTimeout(double seconds) {
    reinterpret_cast<decltype(&glfwWaitEventsTimeout)>(dlsym(RTLD_NEXT, "glfwWaitEventsTimeout"))(seconds);
    holdUp();
}

TEST_CASE_FIXTURE(AtWork, "frames go on while the window's events hold its thread up") {
    if (!haveScreen() || run_in_fork == nullptr) { return; }
    const ViewRun run = runView(work, "dragged", kSmall + "at 3 exit\n", kScene,
                                onDesk() + " " + kHeldUntil + "=dragged/frames.jsonl");
    checkEnded(run);
    CHECK(std::ssize(run.frames) > kFramesHeld);
    CHECK_FALSE(run.says("no window"));
    CHECK(fs::exists(work.path / "dragged" / "frames.jsonl.went-on"));
}

TEST_CASE_FIXTURE(AtWork, "of files dropped on the window the last scene is shown, viewpoints are taken") {
    if (!haveScreen()) { return; }
    for (const char* name : {"a", "b"}) { work.go(fmt::format("scene one-splat --out {}.ply", name)); }
    work.write("broken.ply", "ply\nnonsense\n");
    Viewer viewer(work, kSmall);
    const unsigned long window = numberOfWindow("^binosplat$", "WINDOW");
    desk().connection.drop(window, {work.path / "a.ply", work.path / "b.ply"});
    viewer.await("shows " + (work.path / "b.ply").string());
    desk().connection.drop(window, {work.path / "broken.ply"});
    viewer.await("broken.ply:");
    writeViewpoint(work, "theirs.viewpoints.json");
    desk().connection.drop(window, {work.path / "theirs.viewpoints.json"});
    viewer.await("theirs.viewpoints.json, 1 of them new");
    hands("key Escape");
    viewer.checkEnd();
    for (const std::string& bad : {std::string("/a.ply"), "shows " + (work.path / "broken.ply").string()}) {
        CHECK_FALSE(contains(viewer.said(), bad));
    }
}

TEST_CASE_FIXTURE(AtWork, "a mouse that lies on the panel leaves it to the hands") {
    if (!haveScreen()) { return; }
    hands(moveTo({900.0, 650.0}));
    Acts acts("rate 90\nsize 64 64\nframes none\n");
    acts.click(placeOf("Quit")).wait(1.0);
    const ViewRun run = runView(work, "hand", acts.script(), kScene, onDesk() + " BINOSPLAT_VALIDATION=1");
    checkEnded(run);
    CHECK_FALSE(run.says("no window"));
    CHECK(run.endSeconds() < acts.now_s - 0.5);
}

TEST_CASE_FIXTURE(AtWork, "a lost device ends the viewer, of a lost display only the window is gone") {
    if (!haveScreen()) { return; }
    const std::string script = "rate 90\nsize 64 64\nframes none\nat 1 exit\n";
    const ViewRun device =
        runView(work, "device", script, kScene, withFaults("BINOSPLAT_FAULT=submit:30:lost", onDesk()));
    INFO(device.outcome.output);
    CHECK(device.outcome.exit_code == 3);
    CHECK_FALSE(device.says("no window"));
    CHECK(contains(device.outcome.errors, "DeviceLost"));
    const ViewRun display = runView(work, "display", script, kScene,
                                    withFaults("BINOSPLAT_FAULT=present:5:surface-lost", onDesk()));
    checkEnded(display);
    CHECK(display.says("the window is gone: "));
    CHECK(display.frames.size() > 80);
}

TEST_CASE_FIXTURE(AtWork, "mouse and keys do in the window what hands do, and it shows what the eye sees") {
    if (!haveScreen()) { return; }
    writeCompilerOfChangedShaders(work.path / "tools");
    Viewer viewer(work, "rate 30\nsize 192 192\nframes all\n",
                  "--shaders '" BINOSPLAT_SOURCE_DIR "/shaders'");
    // The panel by mouse: a click on a switch, and another on the same one.
    viewer.click(placeOf("Vignette", true));
    viewer.await("vignette = false");
    viewer.click(placeOf("Vignette", true));
    viewer.await("vignette = true");
    // Dragging by 100 pixels turns by 0.4 radians; the scene follows the mouse to the left.
    const glm::dvec2 place(300.0, 300.0), beside(400.0, 300.0);
    const Similarity start = viewer.placement(work);
    viewer.drag(1, beside, place);
    const Similarity turned = viewer.placement(work);
    CHECK(turnBetween(start, turned) == doctest::Approx(0.4).epsilon(1e-6));
    // Keys: forward is where the wearer now looks, and arrows turn.
    const auto hold = [&](const std::string& key) {
        hands(moveTo(place) + "keydown " + key);
        viewer.tab();
        viewer.tab();
        hands("keyup " + key);
        return viewer.placement(work);
    };
    const Similarity forward = hold("w"), sideways = hold("d"), sunk = hold("q");
    CHECK(stepBetween(turned, forward).z > 0.01);
    CHECK(std::abs(stepBetween(turned, forward).x) < 1e-6);
    CHECK(stepBetween(forward, sideways).x > 0.01);
    CHECK(std::abs(stepBetween(forward, sideways).z) < 1e-6);
    CHECK(stepBetween(sideways, sunk).y > 0.01);
    const Similarity right = hold("Right"), back = hold("s"), left = hold("Left");
    CHECK(turnBetween(sunk, right) > 0.01);
    CHECK(stepBetween(right, back).z < -0.01);
    CHECK(turnBetween(back, left) < -0.01);
    // The wheel enlarges the scene about the wearer, and the right button tilts it about the line of sight.
    viewer.handsInTurn({moveTo(place), "click 4 click 4"});
    viewer.tab();
    const Similarity grown = viewer.placement(work);
    CHECK(grown.scale == doctest::Approx(left.scale / (1.1 * 1.1)).epsilon(1e-4));
    CHECK(turnBetween(left, grown) == doctest::Approx(0.0));
    viewer.drag(3, place, beside);
    const Similarity tilted = viewer.placement(work);
    CHECK(glm::angle(glm::conjugate(grown.orientation) * tilted.orientation) ==
          doctest::Approx(0.4).epsilon(1e-4));
    viewer.drag(3, beside, place);
    // R recentres the room at the head.
    hands("key r");
    viewer.await("the room now begins where the wearer stands");
    // It shows what the dominant eye sees, also after a reload of shaders, some frames later.
    if (contains(viewer.tab(), "panel = true")) { viewer.tab(); }
    hands("key F5");
    viewer.await(" shaders reloaded in ");
    for (int i = 0; i < 6; ++i) { viewer.tab(); }
    const Image screen = desk().screen.picture();
    // Escape ends the session as the wearer would.
    hands("key Escape");
    viewer.checkEnd();
    const Image seen = lastLeftEye(work.path / "seen");
    REQUIRE(seen.channels == 3);
    CHECK(compare(eyeInWindow(screen, seen.size_px), seen).psnrDb() > 35.0);
    // Next to it is the panel, which has many colours.
    const Image panel = partOf(screen, {kEyePx, 0}, glm::uvec2(kEyePx + kPanelInWindowPx.x, kEyePx));
    CHECK(std::set<float>(panel.values.begin(), panel.values.end()).size() > 10);
}

TEST_CASE("Escape, and the window's cross, end it while the headset is off, not looked at or gone") {
    if (!haveScreen()) { return; }
    checkEnds(kOff, false, 120);
    checkEnds(kElsewhere, true, 48);
    checkEnds(kGone, false);
}

TEST_CASE("Escape, and the window's cross, end the wait for a headset, simulated or not") {
    if (!haveScreen()) { return; }
    for (const bool by_cross : {false, true}) {
        CAPTURE(by_cross);
        const Workplace work;
        work.write("never.script", "no-headset-for 1000000\n");
        const std::string simulated = viewOnDesk("builtin:slanted-wall --simulate never.script"),
                          other = viewOnDesk("builtin:slanted-wall --headset-only").substr(3);
        Program program(work.path, by_cross ? "env " + kScripted + "never.script " + other : simulated);
        program.await("has no headset yet");
        if (by_cross) {
            clickCross("^binosplat is waiting for a headset");
        } else {
            hands("search --sync --onlyvisible --name '^binosplat is waiting' mousemove --window %1 20 20");
            hands("key Escape");
        }
        program.checkEnd("stopped before there was a headset");
    }
}

TEST_CASE_FIXTURE(AtWork, "no frame waits for the window, resized or not, nor where the headset shows none") {
    if (!haveScreen()) { return; }
    work.write("window.script",
               "rate 45\nsize 64 64\nframes none\nhead 0 position 0 1.6 0\nat 4 head off\nat 5 head on\n"
               "at 6 should-render off\nat 7 should-render on\nat 8 exit\n");
    std::string watched = kWatched;
    watched.replace(watched.find("DISPLAY="), 8, "DISPLAY=" + desk().screen.name);
    Program program(work.path, "env " + watched +
                                   " SIMULATED_OPENXR_CLOCK=real '" BINOSPLAT_PROGRAM
                                   "' view builtin:slanted-wall --load-first --hide-hands --simulate "
                                   "window.script --out seen");
    program.await("shows builtin:slanted-wall");
    hands("search --sync --onlyvisible --name '^binosplat$' windowsize --sync %1 500 400");
    program.checkEnd();
    // What was drawn in the window alone counts as done in the next frame, since the one before was over.
    std::size_t early = 0;
    const std::vector<std::set<std::string>> waits = waitsOf(work);
    for (std::size_t frame = 45; frame < waits.size(); ++frame) {
        const bool is_early = waits[frame] == std::set<std::string>{"fence-of-last-frame"};
        early += is_early ? 1 : 0;
        CHECK_MESSAGE((is_early || waits[frame].empty()), frame, ": ", listed(waits[frame]));
    }
    CHECK(early <= 4);  // two each time that the headset shows something again
    const std::vector<std::string> frames = linesIn(textIn(work.path / "seen" / "frames.jsonl"));
    const auto drawn =
        std::ranges::count_if(frames, [](const std::string& frame) { return contains(frame, "projection"); });
    CHECK(drawn > 100);
    CHECK(std::ssize(frames) - drawn > 60);
}

// The last test: once the test program has a device of its own, it is not forked any more.
TEST_CASE("a picture of a given-up frame is drawn in the next; a window that nobody can draw on is gone") {
    if (!haveScreen()) { return; }
    setenv("DISPLAY", desk().screen.name.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    REQUIRE(windows != nullptr);
    const std::vector<const char*> pictures{VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    const std::string see_window = "xdotool search --name '^binosplat$' > /dev/null";
    {
        const Context context({.device = {},
                               .instance_extensions = WindowSystem::instanceExtensions(),
                               .device_extensions = pictures});
        Canvas canvas(context, kPanelPx, vk::Format::eR8G8B8A8Unorm);
        // The panel, too: its letters may change before it is drawn again.
        canvas.begin({}, 0.01);
        canvas.giveUp();
        REQUIRE(canvas.font().want("\xd7\x90"));
        canvas.makeLetters();
        canvas.takeLetters();
        canvas.begin({}, 0.01);
        canvas.giveUp();
        EventWindow events(MirrorWindow::sizeFor(kPanelPx));
        MirrorWindow window(context, canvas, events);
        // The display may still be reading it.
        for (int asked = 0; !window.drawn() && asked < 100'000; ++asked) { window.acquire(); }
        const vk::Semaphore first = window.drawn();
        CHECK(first);
        for (int given_up = 0; given_up < 10; ++given_up) {
            window.acquire();
            CHECK(window.drawn() == first);
        }
        CHECK(std::system(see_window.c_str()) == 0);
    }
    const Context without_windows({.device = {}, .device_extensions = pictures});
    const Canvas canvas(without_windows, kPanelPx, vk::Format::eR8G8B8A8Unorm);
    EventWindow events(MirrorWindow::sizeFor(kPanelPx));
    CHECK_THROWS_AS(MirrorWindow(without_windows, canvas, events), Error);
    events.close();
    events.handle(0.0);
    CHECK(std::system(see_window.c_str()) != 0);
}

}  // SUITE(view_window)
