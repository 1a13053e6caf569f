// Facts about the window beside the headset, on a display without a screen (Xvfb) and with a mouse and keys without hands (xdotool).
#include "app/view/window/mirror_window.h"
#include "engine/error.h"
#include "engine/geometry.h"
#include "engine/picture/metrics.h"
#include "tests/installed.h"
#include "tests/panel_sketch.h"
#include "tests/unchanged_shaders.h"
#include "tests/view_panel.h"
#include "tests/view_runs.h"

#include <dlfcn.h>
#include <doctest/doctest.h>
#include <imgui.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>

TEST_SUITE_BEGIN("view_window");

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr int kPatienceMs = 60'000;  // until a program that is silent counts as hung
constexpr glm::ivec2 kScreenPx(1400, 800);
// The dominant eye is shown on the left, the panel beside it.
constexpr int kEyePx = 720;
const glm::dvec2 kPanelInWindowPx(kEyePx* static_cast<double>(kPanelPx.x) / kPanelPx.y, kEyePx);

bool haveScreen() { return isInstalled("Xvfb", "xvfb") && isInstalled("xdotool", "xdotool"); }

// A program on a terminal of its own, since there it does not keep what it prints.
class Program {
public:
    Program(const std::filesystem::path& folder, const std::vector<std::string>& command, const std::string& display) {
        process_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
        if (process_ == 0) {
            std::vector<char*> arguments;
            for (const std::string& word : command) { arguments.push_back(const_cast<char*>(word.c_str())); }
            arguments.push_back(nullptr);
            const bool placed = chdir(folder.c_str()) == 0 && setenv("DISPLAY", display.c_str(), 1) == 0;
            setenv("BINOSPLAT_VALIDATION", "1", 1);
            setenv("SIMULATED_OPENXR_CLOCK", "real", 1);  // in lock-step it would draw as much as it can while hands are on their way
            setenv("XDG_CONFIG_HOME", (folder.parent_path() / "config").c_str(), 1);
            unsetenv("WAYLAND_DISPLAY");
            if (placed) { execvp(arguments[0], arguments.data()); }
            _exit(127);
        }
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        kill(process_, SIGKILL);
        if (!ended_) { static_cast<void>(exitCode()); }
        close(terminal_);
    }

    // What it printed from the last line waited for to the end of the next that has `words` in it; empty if none comes.
    std::string waitFor(const std::string& words) {
        std::size_t found = said_.find(words, read_), end = std::string::npos;
        while (found == std::string::npos || (end = said_.find('\n', found)) == std::string::npos) {
            if (!readMore()) { return {}; }
            found = said_.find(words, read_);
        }
        const std::string lines = said_.substr(read_, end - read_);
        read_ = end;
        return lines;
    }
    [[nodiscard]] int exitCode() {
        while (readMore()) {}
        int status = 0;
        waitpid(process_, &status, 0);
        ended_ = true;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    [[nodiscard]] const std::string& said() const { return said_; }

private:
    bool readMore() {
        pollfd waits{terminal_, POLLIN, 0};
        std::array<char, 4096> part{};
        const ssize_t bytes = poll(&waits, 1, kPatienceMs) == 1 ? read(terminal_, part.data(), part.size()) : -1;
        if (bytes > 0) { said_.append(part.data(), static_cast<std::size_t>(bytes)); }
        return bytes > 0;
    }

    int terminal_ = -1;
    pid_t process_ = -1;
    std::string said_;
    std::size_t read_ = 0;
    bool ended_ = false;
};

// Xvfb keeps its picture in a file.
class Screen {
public:
    explicit Screen(const std::filesystem::path& folder)
        : folder_(folder),
          server_(folder,
                  // Of numbers that are taken it complains first.
                  {"/bin/sh", "-c",
                   fmt::format("exec Xvfb -displayfd 1 -screen 0 {}x{}x24 -fbdir '{}' 2> /dev/null", kScreenPx.x, kScreenPx.y,
                               folder.string())},
                  "") {
        std::string line = server_.waitFor("\n");
        line.erase(std::remove_if(line.begin(), line.end(), [](char c) { return c < '0' || c > '9'; }), line.end());
        name = ":" + line;
    }

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    // An X window dump of 32 bits a pixel: header, colour table, rows; the header's numbers have their highest byte first.
    [[nodiscard]] Image picture() const {
        std::ifstream file(folder_ / "Xvfb_screen0", std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(bytes.at(at)); };
        const auto number = [&](std::size_t index) {
            std::size_t value = 0;
            for (std::size_t i = 0; i < 4; ++i) { value = value * 256 + byte(4 * index + i); }
            return value;
        };
        constexpr std::size_t kBytesPerColour = 12;
        const std::size_t start = number(0) + kBytesPerColour * number(19), row_bytes = number(12);
        Image image{{number(4), number(5)}, 3, {}};
        image.values.resize(3 * image.pixelCount());
        REQUIRE(bytes.size() >= start + row_bytes * image.size_px.y);
        float* value = image.values.data();
        for (std::size_t y = 0; y < image.size_px.y; ++y) {
            const char* pixel = bytes.data() + start + y * row_bytes;
            for (std::size_t x = 0; x < image.size_px.x; ++x, pixel += 4, value += 3) {
                for (int i = 0; i < 3; ++i) { value[i] = static_cast<float>(static_cast<std::uint8_t>(pixel[2 - i])) / 255.0f; }
            }
        }
        return image;
    }

    std::string name;

private:
    std::filesystem::path folder_;
    Program server_;
};

// On a screen, with a mouse and keys.
void handsOn(const Screen& screen, const std::string& does) {
    const std::string command = "DISPLAY=" + screen.name + " timeout 60 xdotool " + does + " >/dev/null";
    INFO(command);
    REQUIRE(std::system(command.c_str()) == 0);
}

// Of a window by its name, as xdotool says it: "WINDOW=2097154", "WIDTH=648" and so on, one of them.
unsigned long numberOfWindow(const Screen& screen, const std::string& name, const std::string& what) {
    const std::string file = (screen.folder() / "number").string();
    handsOn(screen, fmt::format("search --sync --onlyvisible --name '{}' getwindowgeometry --shell %1 | sed -n 's/^{}=//p' | tee '{}'",
                                name, what, file));
    unsigned long number = 0;
    std::ifstream(file) >> number;
    REQUIRE(number != 0);
    return number;
}

// What xdotool of Debian 12 cannot do, by Xlib, which GLFW takes along itself.
class XConnection {
public:
    explicit XConnection(const Screen& screen) {
        REQUIRE(library_ != nullptr);
        display_ = find<void* (*)(const char*)>("XOpenDisplay")(screen.name.c_str());
        REQUIRE(display_ != nullptr);
    }
    XConnection(const XConnection&) = delete;
    XConnection& operator=(const XConnection&) = delete;
    ~XConnection() {
        find<int (*)(void*)>("XCloseDisplay")(display_);
        dlclose(library_);
    }

    // As desktops tell programs how large people want things; for as long as somebody is connected.
    void setDpi(int dpi) const {
        const std::string resources = fmt::format("Xft.dpi:\t{}\n", dpi);
        const unsigned long root = find<unsigned long (*)(void*)>("XDefaultRootWindow")(display_);
        constexpr unsigned long kResourceManager = 23, kString = 31;
        find<int (*)(void*, unsigned long, unsigned long, unsigned long, int, int, const char*, int)>("XChangeProperty")(
            display_, root, kResourceManager, kString, 8, 0, resources.c_str(), static_cast<int>(resources.size()));
        find<int (*)(void*, int)>("XSync")(display_, 0);
    }
    // What a window manager does when somebody clicks on the cross: a message that the window may obey.
    void clickCross(unsigned long window) const {
        const auto atomOf = [&](const char* name) {
            return find<unsigned long (*)(void*, const char*, int)>("XInternAtom")(display_, name, 0);
        };
        // Xlib's XClientMessageEvent in an XEvent of 24 longs: a message that is sent, to which window, its kind, bits of a number, a
        // number.
        constexpr unsigned long kClientMessage = 33;
        std::array<unsigned long, 24> event{kClientMessage,
                                            0,
                                            1,
                                            reinterpret_cast<unsigned long>(display_),
                                            window,
                                            atomOf("WM_PROTOCOLS"),
                                            32,
                                            atomOf("WM_DELETE_WINDOW")};
        CHECK(find<int (*)(void*, unsigned long, int, long, void*)>("XSendEvent")(display_, window, 0, 0, event.data()) != 0);
        find<int (*)(void*, int)>("XSync")(display_, 0);
    }
    // What the window tells a window manager: whether its size may change, and whether its shape stays.
    [[nodiscard]] std::pair<bool, bool> resizesInShape(unsigned long window) const {
        // Xlib's XSizeHints.
        struct {
            long flags = 0;
            std::array<int, 17> rest{};
        } hints;
        long supplied = 0;
        REQUIRE(find<int (*)(void*, unsigned long, void*, long*)>("XGetWMNormalHints")(display_, window, &hints, &supplied) != 0);
        constexpr long kMostSize = 1 << 5, kShape = 1 << 7;
        return {(hints.flags & kMostSize) == 0, (hints.flags & kShape) != 0};
    }

private:
    template <typename Function>
    Function find(const char* name) const {
        const auto function = reinterpret_cast<Function>(dlsym(library_, name));
        const bool is_there = function != nullptr;
        REQUIRE(is_there);
        return function;
    }

    void* library_ = dlopen("libX11.so.6", RTLD_NOW);
    void* display_ = nullptr;
};

void clickCross(const Screen& screen, const std::string& window_name) {
    XConnection(screen).clickCross(numberOfWindow(screen, window_name, "WINDOW"));
}

// Where the panel's line about the last button begins where all widgets are there, in shares of its width and height: there two panels
// differ that differ in it.
glm::dvec2 placeOfMessage() {
    PanelSketch sketch;
    sketch.status.can_reload_shaders = sketch.status.can_pass_through = true;
    sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0};
    const auto draw = [&](const char* message) {
        sketch.status.message = message;
        sketch.draw();
        std::vector<ImVec2> places;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int list = 0; list < data.CmdListsCount; ++list) {
            for (const ImDrawVert& vertex : data.CmdLists[list]->VtxBuffer) { places.push_back(vertex.pos); }
        }
        return places;
    };
    const std::vector<ImVec2> one = draw("MMMMMMMM"), other = draw("IIIIIIII");
    const auto differs = [](const ImVec2& a, const ImVec2& b) { return a.x != b.x || a.y != b.y; };
    const auto [first, its] = std::ranges::mismatch(one, other, std::not_fn(differs));
    REQUIRE(first != one.end());
    return glm::dvec2(first->x, first->y) / glm::dvec2(kPanelPx);
}

// The viewer beside its window, with a mouse and keys.
class Viewer {
public:
    Viewer(const Workplace& work, const std::string& options, int dpi = 96)
        : screen_((std::filesystem::create_directory(work.base / "screen"), work.base / "screen")),
          connection_(screen_),
          program_((connection_.setDpi(dpi), work.path),
                   {"/bin/sh", "-c",
                    "export PATH=\"$PWD/tools:$PATH\"; exec '" BINOSPLAT_PROGRAM "' view builtin:slanted-wall --load-first --mode mono " +
                        options},
                   screen_.name) {
        // While it loads, the panel has another layout.
        REQUIRE(program_.waitFor("shows builtin:slanted-wall") != "");
        // The keys go to the window that the mouse is in.
        hands("search --sync --onlyvisible --name '^binosplat$' mousemove --window %1 20 20");
    }

    void hands(const std::string& does) const { handsOn(screen_, does); }
    static std::string moveTo(const glm::dvec2& place) { return fmt::format("mousemove {:.0f} {:.0f} ", place.x, place.y); }
    static std::string panel(const glm::dvec2& share) { return moveTo(glm::dvec2(kEyePx, 0.0) + share * kPanelInWindowPx); }

    // The panel goes or comes: by then everything before has reached the viewer.
    std::string tab() {
        hands("key Tab");
        const std::string lines = program_.waitFor("panel = ");
        CHECK(lines != "");
        return lines;
    }
    void click(const glm::dvec2& share) {
        hands(panel(share));
        tab();
        hands("mousedown 1");
        tab();
        hands("mouseup 1");
    }
    // Where the wearer's room lies now, as the viewer saves it.
    Pose placement(const Workplace& work, double* units_per_metre = nullptr) {
        click(placeOf("Save", true));
        REQUIRE(program_.waitFor("slanted-wall.view.toml") != "");
        std::ifstream file(work.base / "config" / "binosplat" / "scenes" / "slanted-wall.view.toml");
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const auto numbers = [&](const std::string& key) {
            const std::size_t at = text.find(key + " = [");
            REQUIRE(at != std::string::npos);
            std::string list = text.substr(at + key.size() + 4);
            list = list.substr(0, list.find(']'));
            std::ranges::replace(list, ',', ' ');
            std::istringstream words(list);
            return std::vector<double>(std::istream_iterator<double>(words), {});
        };
        if (units_per_metre != nullptr) {
            const std::string key = "units-per-metre = ";
            const std::size_t at = text.find(key);
            REQUIRE(at != std::string::npos);
            *units_per_metre = std::stod(text.substr(at + key.size()));
        }
        const std::vector<double> p = numbers("scene-position"), q = numbers("scene-orientation");
        return {{q.at(0), q.at(1), q.at(2), q.at(3)}, {p.at(0), p.at(1), p.at(2)}};
    }

    [[nodiscard]] Program& program() { return program_; }
    [[nodiscard]] const Screen& screen() const { return screen_; }
    [[nodiscard]] const XConnection& connection() const { return connection_; }

private:
    Screen screen_;
    XConnection connection_;
    Program program_;
};

std::array<float, 3> colourAt(const Image& image, glm::uvec2 at) {
    const float* value = &image.values.at((std::size_t{at.y} * image.size_px.x + at.x) * static_cast<std::size_t>(image.channels));
    return {value[0], value[1], value[2]};
}

// The pixels of the window next to the middles of the eye's, which it shows magnified.
Image eyeInWindow(const Image& screen, glm::uvec2 eye_px) {
    Image eye{eye_px, 3, {}};
    const glm::dvec2 scale = glm::dvec2(kEyePx) / glm::dvec2(eye_px);
    for (std::uint32_t y = 0; y < eye_px.y; ++y) {
        for (std::uint32_t x = 0; x < eye_px.x; ++x) {
            const auto colour = colourAt(screen, glm::uvec2(scale * (glm::dvec2(x, y) + 0.5)));
            eye.values.insert(eye.values.end(), colour.begin(), colour.end());
        }
    }
    return eye;
}

// Of the last composed picture.
Image lastLeftEye(const std::filesystem::path& folder) {
    std::size_t last = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        unsigned long frame = 0;
        if (std::sscanf(file.path().filename().c_str(), "frame_%lu.png", &frame) == 1) { last = std::max<std::size_t>(last, frame); }
    }
    ViewRun run;
    run.out = folder;
    return run.eye(last, kLeft);
}

std::size_t coloursOfPanel(const Image& screen) {
    std::set<std::array<float, 3>> colours;
    for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(kPanelInWindowPx.y); y += 3) {
        for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(kPanelInWindowPx.x); x += 3) {
            colours.insert(colourAt(screen, {kEyePx + x, y}));
        }
    }
    return colours.size();
}

}  // namespace

TEST_CASE("mouse and keys do in the window what hands do in the headset") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::ofstream(work.path / "rest.script") << "rate 30\nsize 192 192\nframes all\n";
    writeCompilerOfChangedShaders(work.path / "tools");
    Viewer viewer(work, "--simulate rest.script --out seen --shaders '" BINOSPLAT_SOURCE_DIR "/shaders'");
    Program& program = viewer.program();

    // The panel by mouse: a click on a switch, and the same again.
    viewer.click(placeOf("Vignette", true));
    CHECK(program.waitFor("vignette = false") != "");
    viewer.click(placeOf("Vignette", true));
    CHECK(program.waitFor("vignette = true") != "");

    // A drag of 100 pixels to the left turns by 0.4 radians, however many frames it takes; the scene follows the mouse, to the left.
    const Pose start = viewer.placement(work);
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 1");
    viewer.tab();
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 1");
    const Pose turned = viewer.placement(work);
    const auto turnBetween = [](const Pose& a, const Pose& b) {
        const glm::dquat turn = glm::conjugate(a.orientation) * b.orientation;
        return 2.0 * std::atan2(turn.y, turn.w);
    };
    CHECK(turnBetween(start, turned) == doctest::Approx(0.4).epsilon(1e-6));

    // Keys: forward is where the wearer now looks, arrows turn.
    const auto hold = [&](const std::string& key) {
        viewer.hands(Viewer::moveTo({300.0, 300.0}) + "keydown " + key);
        viewer.tab();
        viewer.tab();
        viewer.hands("keyup " + key);
        return viewer.placement(work);
    };
    const auto stepBetween = [](const Pose& a, const Pose& b) { return glm::conjugate(a.orientation) * (b.position - a.position); };
    const Pose forward = hold("w"), sideways = hold("d"), sunk = hold("q");
    CHECK(stepBetween(turned, forward).z > 0.01);
    CHECK(std::abs(stepBetween(turned, forward).x) < 1e-6);
    CHECK(stepBetween(forward, sideways).x > 0.01);
    CHECK(std::abs(stepBetween(forward, sideways).z) < 1e-6);
    CHECK(stepBetween(sideways, sunk).y > 0.01);
    const Pose right = hold("Right");
    CHECK(turnBetween(sunk, right) > 0.01);
    const Pose back = hold("s"), left = hold("Left");
    CHECK(stepBetween(right, back).z < -0.01);
    CHECK(turnBetween(back, left) < -0.01);

    // The wheel makes the scene grow about the wearer, the right button tilts it about the line of sight.
    double before = 0.0, grown = 0.0;
    const Pose wheel_from = viewer.placement(work, &before);
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("click 4 click 4");
    viewer.tab();
    const Pose wheel_to = viewer.placement(work, &grown);
    CHECK(grown == doctest::Approx(before / (1.1 * 1.1)).epsilon(1e-4));
    CHECK(turnBetween(wheel_from, wheel_to) == doctest::Approx(0.0));
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 3");
    viewer.tab();
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 3");
    const Pose tilted = viewer.placement(work);
    CHECK(glm::angle(glm::conjugate(wheel_to.orientation) * tilted.orientation) == doctest::Approx(0.4).epsilon(1e-4));
    viewer.hands(Viewer::moveTo({400.0, 300.0}));
    viewer.tab();
    viewer.hands("mousedown 3");
    viewer.tab();
    viewer.hands(Viewer::moveTo({300.0, 300.0}));
    viewer.tab();
    viewer.hands("mouseup 3");

    // R: the room begins where the head is.
    viewer.hands("key r");
    CHECK(program.waitFor("the room now begins where the wearer stands") != "");

    // What stands in the window is what the dominant eye sees, also by new shaders. It is there some frames later.
    if (viewer.tab().find("panel = true") != std::string::npos) { viewer.tab(); }
    viewer.hands("key F5");
    CHECK(program.waitFor(" shaders reloaded in ") != "");
    for (int i = 0; i < 6; ++i) { viewer.tab(); }
    const Image screen = viewer.screen().picture();

    // Escape ends the session as the wearer would.
    viewer.hands("key Escape");
    CHECK(program.exitCode() == 0);
    INFO(program.said());
    CHECK(program.said().find("frames; ") != std::string::npos);
    CHECK(program.said().find("VUID") == std::string::npos);
    CHECK(program.said().find("no window") == std::string::npos);
    const Image seen = lastLeftEye(work.path / "seen");
    REQUIRE(seen.channels == 3);
    CHECK(compare(eyeInWindow(screen, seen.size_px), seen).psnrDb() > 35.0);
    // Beside it, the panel.
    CHECK(coloursOfPanel(screen) > 10);
}

TEST_CASE("a mouse that lies on the panel leaves it to the hands") {
    if (!haveScreen()) { return; }
    const Workplace work;
    const std::string small = "rate 90\nsize 96 96\nframes none\n", scene = "builtin:slanted-wall --load-first --mode mono";
    const Panel panel = panelOf(runView(work, "look", small + "at 0.1 exit\n", scene), 8);
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    const XConnection stays(screen);  // a server whom everybody left begins anew, with its mouse in the middle
    handsOn(screen, Viewer::moveTo({900.0, 650.0}));
    const ViewRun run = runView(work, "hand", small + clickOn(panel, {placeOf("Quit"), {0.9, 0.95}}), scene,
                                "XDG_CONFIG_HOME=\"$PWD/../config\" WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 DISPLAY=" + screen.name);
    INFO(run.outcome.output);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.output.find("VUID") == std::string::npos);
    CHECK(run.outcome.output.find("no window") == std::string::npos);
    CHECK(run.frames.size() < 50);  // the script's end comes later
}

TEST_CASE("Escape, and the window's cross, end it while the headset is off, not looked at or gone") {
    if (!haveScreen()) { return; }
    for (const char* lines : {"at -1 worn off\n", "at -1 visible off\n", "no-headset-for 1000000 after-loss\nat 0.1 lose-session\n"}) {
        for (const bool by_cross : {false, true}) {
            CAPTURE(lines);
            CAPTURE(by_cross);
            const Workplace work;
            std::ofstream(work.path / "off.script") << "rate 30\nsize 96 96\nframes none\n" << lines;
            Viewer viewer(work, "--simulate off.script --out seen");
            // Keys are obeyed, and the panel with them.
            viewer.tab();
            viewer.tab();
            if (by_cross) {
                clickCross(viewer.screen(), "^binosplat$");
            } else {
                viewer.hands("key Escape");
            }
            CHECK(viewer.program().exitCode() == 0);
            INFO(viewer.program().said());
            CHECK(viewer.program().said().find("frames; ") != std::string::npos);
            CHECK(viewer.program().said().find("VUID") == std::string::npos);
        }
    }
}

TEST_CASE("a lost device ends the viewer with three, also beside a window") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    const ViewRun run =
        runView(work, "lost", "rate 90\nsize 96 96\nframes none\nat 2 exit\n", "builtin:slanted-wall --load-first --mode mono",
                "WAYLAND_DISPLAY= VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT=submit:30:lost DISPLAY=" +
                    screen.name);
    INFO(run.outcome.output);
    INFO(run.outcome.errors);
    CHECK(run.outcome.exit_code == 3);
    CHECK(run.outcome.output.find("no window") == std::string::npos);
    CHECK(run.outcome.errors.find("DeviceLost") != std::string::npos);
}

TEST_CASE("a window whose display is lost is gone, and the headset goes on") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    const ViewRun run =
        runView(work, "lost", "rate 90\nsize 96 96\nframes none\nat 1 exit\n", "builtin:slanted-wall --load-first --mode mono",
                "WAYLAND_DISPLAY= VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT=present:5:surface-lost DISPLAY=" +
                    screen.name);
    INFO(run.outcome.output);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.errors == "");
    CHECK(run.outcome.output.find("the window is gone: ") != std::string::npos);
    CHECK(run.frames.size() > 80);
}

TEST_CASE("a picture of a frame that was given up is drawn in the next, and a window that cannot be drawn on is gone") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    setenv("DISPLAY", screen.name.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    REQUIRE(windows != nullptr);
    const std::vector<const char*> pictures{VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    const std::string see_window = "DISPLAY=" + screen.name + " xdotool search --name '^binosplat$' > /dev/null";
    {
        const Context context({.device = {}, .instance_extensions = WindowSystem::instanceExtensions(), .device_extensions = pictures});
        Canvas canvas(context, kPanelPx, vk::Format::eR8G8B8A8Unorm);
        // Of the panel, too: its letters may change before it is drawn again.
        canvas.begin({}, 0.01);
        canvas.giveUp();
        REQUIRE(canvas.wantsLetters("\xd7\x90"));
        canvas.buildLetters();
        canvas.takeLetters();
        canvas.begin({}, 0.01);
        canvas.giveUp();
        MirrorWindow window(context, canvas);
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
    CHECK_THROWS_AS(MirrorWindow(without_windows, canvas), Error);
    CHECK(std::system(see_window.c_str()) != 0);
}

TEST_CASE("Escape, and the window's cross, end the wait for a headset") {
    if (!haveScreen()) { return; }
    for (const bool by_cross : {false, true}) {
        CAPTURE(by_cross);
        const Workplace work;
        std::ofstream(work.path / "never.script") << "no-headset-for 1000000\n";
        std::filesystem::create_directory(work.base / "screen");
        const Screen screen(work.base / "screen");
        Program program(work.path, {BINOSPLAT_PROGRAM, "view", "builtin:slanted-wall", "--simulate", "never.script"}, screen.name);
        REQUIRE(program.waitFor("has no headset yet") != "");
        if (by_cross) {
            clickCross(screen, "^binosplat waits for a headset");
        } else {
            handsOn(screen, "search --sync --onlyvisible --name '^binosplat waits' mousemove --window %1 20 20");
            handsOn(screen, "key Escape");
        }
        CHECK(program.exitCode() == 0);
        INFO(program.said());
        CHECK(program.said().find("stopped before there was a headset") != std::string::npos);
    }
}

TEST_CASE("a session in place of a lost one is said on the panel") {
    if (!haveScreen()) { return; }
    const glm::uvec2 place(glm::dvec2(kEyePx, 0.0) + placeOfMessage() * kPanelInWindowPx);
    using Line = std::vector<std::array<float, 3>>;
    const auto lineIn = [&](const Image& screen) {
        Line line;
        for (unsigned y = 0; y < 14; ++y) {
            for (unsigned x = 0; x < 200; ++x) { line.push_back(colourAt(screen, place + glm::uvec2(x, y))); }
        }
        return line;
    };
    constexpr int kMostLooks = 20;
    // The letters there, once they are the same twice, the panel gone and back between: what was drawn while it came is seen by then.
    const auto read = [&](Viewer& viewer) {
        Line line, before;
        for (int i = 0; i < kMostLooks; ++i) {
            viewer.tab();
            viewer.tab();
            line = lineIn(viewer.screen().picture());
            if (line == before && std::set(line.begin(), line.end()).size() > 2) { break; }
            before = line;
        }
        return line;
    };
    std::array<Line, 2> lines;
    for (const bool is_lost : {false, true}) {
        const Workplace work;
        std::ofstream(work.path / "lost.script") << "rate 30\nsize 96 96\nframes none\n" << (is_lost ? "at 0.5 lose-session\n" : "");
        Viewer viewer(work, "--simulate lost.script --out seen --shaders '" BINOSPLAT_SOURCE_DIR "/shaders'");
        if (is_lost) { REQUIRE(viewer.program().waitFor("another one begins") != ""); }
        Line& line = lines[is_lost ? 1 : 0];
        line = read(viewer);
        CHECK(std::set(line.begin(), line.end()).size() > 2);
        for (int i = 0; is_lost && line == lines[0] && i < kMostLooks; ++i) { line = read(viewer); }
        viewer.hands("key Escape");
        CHECK(viewer.program().exitCode() == 0);
    }
    CHECK(lines[0] != lines[1]);
}

TEST_CASE("the window is as large as the desktop wants things to be, and may be made another size in its shape") {
    if (!haveScreen()) { return; }
    const Workplace work;
    std::ofstream(work.path / "rest.script") << "rate 30\nsize 96 96\nframes none\n";
    Viewer viewer(work, "--simulate rest.script --out seen", 48);
    const glm::dvec2 size(numberOfWindow(viewer.screen(), "^binosplat$", "WIDTH"),
                          numberOfWindow(viewer.screen(), "^binosplat$", "HEIGHT"));
    CHECK(size == 0.5 * glm::dvec2(kEyePx + kPanelInWindowPx.x, kEyePx));
    const auto [resizes, keeps_shape] = viewer.connection().resizesInShape(numberOfWindow(viewer.screen(), "^binosplat$", "WINDOW"));
    CHECK(resizes);
    CHECK(keeps_shape);
    // Its widgets are where they are shown.
    viewer.hands(Viewer::moveTo(0.5 * (glm::dvec2(kEyePx, 0.0) + placeOf("Vignette", true) * kPanelInWindowPx)));
    viewer.tab();
    viewer.hands("mousedown 1");
    viewer.tab();
    viewer.hands("mouseup 1");
    CHECK(viewer.program().waitFor("vignette = false") != "");
    viewer.hands("key Escape");
    CHECK(viewer.program().exitCode() == 0);
}
