// The viewer beside its window, on a display without a screen (Xvfb), with a mouse and keys (xdotool).
#pragma once

#include "tests/app/view/view_acts.h"
#include "tests/xr/simulated/installed.h"

#include <dlfcn.h>
#include <poll.h>
#include <signal.h>

namespace binosplat::test {

inline constexpr int kPatienceMs = 60'000;  // a program that is silent for longer counts as hung
inline constexpr glm::ivec2 kScreenPx(1400, 800);
// The dominant eye is shown on the left, and the panel beside it.
inline constexpr int kEyePx = 720;
inline const glm::dvec2 kPanelInWindowPx(kEyePx* static_cast<double>(kPanelPx.x) / kPanelPx.y, kEyePx);

inline bool haveScreen() { return isInstalled("Xvfb", "xvfb") && isInstalled("xdotool", "xdotool"); }

// The simulated headset without --simulate, for a script's name to follow.
inline const std::string kRuntime = "XR_RUNTIME_JSON='" BINOSPLAT_BUILD "/bin/simulated_runtime.json' ",
                         kScripted = kRuntime + "SIMULATED_OPENXR_SCRIPT=";

// A shell command, run in a folder.
class Program {
public:
    Program(const fs::path& folder, const std::string& command)
        : pipe_(popen(fmt::format("cd '{}' && echo $$ && exec {} 2>&1", folder.string(), command).c_str(),
                      "re")) {
        process_ = std::stoi(await("\n"));
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        if (ended_) { return; }
        kill(process_, SIGKILL);
        pclose(pipe_);
    }

    // What it printed since the last awaited line, to the end of the next one with `words`, which must come.
    std::string await(const std::string& words) {
        std::size_t found = said_.find(words, read_), end = std::string::npos;
        while (found == std::string::npos || (end = said_.find('\n', found)) == std::string::npos) {
            INFO(words << ": " << said_);
            REQUIRE(readMore());
            found = said_.find(words, read_);
        }
        const std::string lines = said_.substr(read_, end + 1 - read_);
        read_ = end + 1;
        return lines;
    }
    [[nodiscard]] int exitCode() {
        while (readMore()) {}
        kill(process_, SIGKILL);  // in case it hangs
        ended_ = true;
        const int status = pclose(pipe_);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    [[nodiscard]] const std::string& said() const { return said_; }
    // The processor's time that it took, without that of programs that it ran.
    [[nodiscard]] double processorSeconds() const {
        const std::string line = textIn(fmt::format("/proc/{}/stat", process_));
        std::istringstream words(line.substr(line.rfind(')') + 2));
        std::string other;
        for (int i = 0; i < 11; ++i) { words >> other; }
        double user = 0.0, system = 0.0;
        words >> user >> system;
        return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
    }
    // It ends without an error, and says `last`.
    void checkEnd(const std::string& last = "frames; ") {
        CHECK(exitCode() == 0);
        INFO(said_);
        CHECK(contains(said_, last));
        for (const char* bad : {"VUID", "SYNC-HAZARD", "no window"}) { CHECK_FALSE(contains(said_, bad)); }
    }

private:
    bool readMore() {
        pollfd waits{fileno(pipe_), POLLIN, 0};
        std::array<char, 4096> part{};
        const ssize_t bytes =
            poll(&waits, 1, kPatienceMs) == 1 ? read(fileno(pipe_), part.data(), part.size()) : -1;
        if (bytes > 0) { said_.append(part.data(), static_cast<std::size_t>(bytes)); }
        return bytes > 0;
    }

    std::FILE* pipe_;
    pid_t process_ = -1;
    std::string said_;
    std::size_t read_ = 0;
    bool ended_ = false;
};

// Xvfb keeps its picture in a file. It ends when all clients have gone, even if the test crashed.
class Screen {
public:
    // Before that it complains about display numbers that are taken.
    explicit Screen(const fs::path& folder)
        : folder_(folder),
          server_(folder,
                  fmt::format(
                      "sh -c 'exec Xvfb -terminate -displayfd 1 -screen 0 {}x{}x24 -fbdir . 2> /dev/null'",
                      kScreenPx.x, kScreenPx.y)),
          name(":" + std::to_string(std::stoi(server_.await("\n")))) {}

    [[nodiscard]] const fs::path& folder() const { return folder_; }
    // An X window dump of 32 bits a pixel: header, colours, rows. Its numbers have their highest byte first.
    [[nodiscard]] Image picture() const {
        const std::string bytes = textIn(folder_ / "Xvfb_screen0");
        const auto number = [&](std::size_t index) { return bigWordAt(bytes, 4 * index); };
        constexpr std::size_t kBytesPerColour = 12;
        const std::size_t start = number(0) + kBytesPerColour * number(19), row_bytes = number(12);
        return makePicture({number(4), number(5)}, [&](std::uint32_t x, std::uint32_t y) {
            const std::uint32_t colour = bigWordAt(bytes, start + row_bytes * y + 4 * std::size_t{x});
            return glm::vec3(colour >> 8 & 255, colour >> 16 & 255, colour >> 24) / 255.0f;
        });
    }

private:
    fs::path folder_;
    Program server_;

public:
    const std::string name;
};

// What Debian 12's xdotool cannot do, done with Xlib, which GLFW loads anyway.
class XConnection {
public:
    explicit XConnection(const std::string& name) {
        display_ = find<void*(const char*)>("XOpenDisplay")(name.c_str());
        REQUIRE(display_ != nullptr);
    }
    // The scale that desktops tell programs; it holds as long as a client is connected.
    void setDpi(int dpi) const {
        const std::string resources = fmt::format("Xft.dpi:\t{}\n", dpi);
        const unsigned long root = find<unsigned long(void*)>("XDefaultRootWindow")(display_);
        constexpr unsigned long kResourceManager = 23, kString = 31;
        change(root, kResourceManager, kString, 8, resources.data(), resources.size());
    }
    // What a window manager does when the user clicks the cross: it sends a message that the window may obey.
    void clickCross(unsigned long window) const {
        // XClientMessageEvent: its kind (33), sent, to which window, a message, bits of a number, a number.
        send(window, {33, 0, 1, reinterpret_cast<unsigned long>(display_), window, atomOf("WM_PROTOCOLS"), 32,
                      atomOf("WM_DELETE_WINDOW")});
    }
    // What a window manager records on a window that it takes off the screen (3), or brings back (1).
    void minimize(unsigned long window, bool is_gone) const {
        const std::array<unsigned long, 2> state{is_gone ? 3ul : 1ul, 0};
        change(window, atomOf("WM_STATE"), atomOf("WM_STATE"), 32, state.data(), 2);
    }
    // The end of dragging files to a window: their names are at the window, which is told about them.
    void drop(unsigned long window, const std::vector<fs::path>& files) const {
        std::string uri;
        for (const fs::path& file : files) { uri += "file://" + file.string() + "\r\n"; }
        const unsigned long place = atomOf("XdndSelection"), kind = atomOf("text/uri-list");
        change(window, place, kind, 8, uri.data(), uri.size());
        // Xlib's XSelectionEvent: its kind (31), sent, to which window, what, as what, where it lies, when.
        send(window, {31, 0, 1, reinterpret_cast<unsigned long>(display_), window, place, kind, place, 0});
    }
    // What the window tells a window manager: whether its size may change, and whether it keeps its shape.
    [[nodiscard]] std::pair<bool, bool> resizesInShape(unsigned long window) const {
        // Xlib's XSizeHints.
        struct {
            long flags = 0;
            std::array<int, 17> rest{};
        } hints;
        long supplied = 0;
        REQUIRE(find<int(void*, unsigned long, void*, long*)>("XGetWMNormalHints")(display_, window, &hints,
                                                                                   &supplied) != 0);
        constexpr long kMostSize = 1 << 5, kShape = 1 << 7;
        return {(hints.flags & kMostSize) == 0, (hints.flags & kShape) != 0};
    }

private:
    [[nodiscard]] unsigned long atomOf(const char* name) const {
        return find<unsigned long(void*, const char*, int)>("XInternAtom")(display_, name, 0);
    }
    // A property of a window: `count` numbers of this many bits.
    void change(unsigned long window, unsigned long property, unsigned long kind, int bits,
                const void* numbers, std::size_t count) const {
        find<int(void*, unsigned long, unsigned long, unsigned long, int, int, const void*, int)>(
            "XChangeProperty")(display_, window, property, kind, bits, 0, numbers, static_cast<int>(count));
        find<int(void*, int)>("XSync")(display_, 0);
    }
    // An XEvent is 24 longs.
    void send(unsigned long window, std::array<unsigned long, 24> event) const {
        CHECK(find<int(void*, unsigned long, int, long, void*)>("XSendEvent")(display_, window, 0, 0,
                                                                              event.data()) != 0);
        find<int(void*, int)>("XSync")(display_, 0);
    }
    template <typename Function>
    static Function* find(const char* name) {
        return functionIn<Function>("libX11.so.6", name);
    }

    void* display_ = nullptr;
};

// One screen for all tests. A client stays connected: without any, the server restarts, its mouse in the
// middle.
struct Desk {
    Workplace folder;
    Screen screen{folder.path};
    XConnection connection{screen.name};
};
inline const Desk& desk(int dpi = 96) {
    static const Desk desk;
    desk.connection.setDpi(dpi);
    return desk;
}
inline std::string moveTo(const glm::dvec2& place) {
    return fmt::format("mousemove {:.0f} {:.0f} ", place.x, place.y);
}
inline std::vector<std::string> dragOf(int button, const glm::dvec2& from, const glm::dvec2& to) {
    return {moveTo(from), fmt::format("mousedown {}", button), moveTo(to), fmt::format("mouseup {}", button)};
}
inline void hands(const std::string& does) {
    const std::string line = "DISPLAY=" + desk().screen.name + " timeout 60 xdotool " + does + " >/dev/null";
    INFO(line);
    REQUIRE(std::system(line.c_str()) == 0);
}

// A number of the window with this name, as xdotool prints it: "WINDOW=2097154", "WIDTH=648" and so on.
inline unsigned long numberOfWindow(const std::string& name, const std::string& what) {
    const std::string file = (desk().screen.folder() / "number").string();
    hands(
        fmt::format("search --sync --onlyvisible --name '{}' getwindowgeometry --shell %1 | sed -n "
                    "'s/^{}=//p' | tee '{}'",
                    name, what, file));
    unsigned long number = 0;
    std::ifstream(file) >> number;
    REQUIRE(number != 0);
    return number;
}
inline void clickCross(const std::string& window_name) {
    desk().connection.clickCross(numberOfWindow(window_name, "WINDOW"));
}

// With the real clock: in lock-step it would draw as fast as it can while the input is on its way.
inline std::string viewOnDesk(const std::string& arguments, int dpi = 96, const std::string& display = "") {
    return "env DISPLAY=" + (display.empty() ? desk(dpi).screen.name : display) +
           " WAYLAND_DISPLAY= DBUS_SESSION_BUS_ADDRESS=unix:path=/nonexistent BINOSPLAT_VALIDATION=1 "
           "SIMULATED_OPENXR_CLOCK=real XDG_CONFIG_HOME=\"$PWD/../config\" PATH=\"$PWD/tools:$PATH\" "
           "'" BINOSPLAT_PROGRAM "' view " +
           arguments;
}

// A file with a viewpoint of another person.
inline void writeViewpoint(const Workplace& work, const std::string& file) {
    work.write(file, R"({"viewpoints": [{"name": "beside", "eye": [0.6, 0, -0.4], "look": [0, 0, 3],
        "up": [0, -1, 0]}]})");
}

// The viewer beside its window.
class Viewer : public Program {
public:
    Viewer(const Workplace& work, const std::string& script, const std::string& options = "", int dpi = 96)
        : Program(
              (work.write("desk.script", script), work.path),
              viewOnDesk("builtin:slanted-wall --load-first --mode mono --simulate desk.script --out seen " +
                             options,
                         dpi)) {
        // While the scene loads, the panel has another layout.
        await("shows builtin:slanted-wall");
        // Keys go to the window that contains the mouse.
        hands("search --sync --onlyvisible --name '^binosplat$' mousemove --window %1 20 20");
    }

    // Hides or shows the panel: once that is done, everything before has reached the viewer.
    std::string tab() {
        hands("key Tab");
        return await("panel = ");
    }
    // One after another; each arrives before the next is sent.
    void handsInTurn(const std::vector<std::string>& all) {
        for (const std::string& does : all) {
            if (&does != &all.front()) { tab(); }
            hands(does);
        }
    }
    void click(const glm::dvec2& share) {
        handsInTurn({moveTo(glm::dvec2(kEyePx, 0.0) + share * kPanelInWindowPx), "mousedown 1", "mouseup 1"});
    }
    void drag(int button, const glm::dvec2& from, const glm::dvec2& to) {
        handsInTurn(dragOf(button, from, to));
    }
    // Where the wearer's room is now, according to the viewer's saved settings.
    Similarity placement(const Workplace& work) {
        click(placeOf("Save", true));
        await("slanted-wall.view.toml");
        return placementAtWall(work);
    }
};

}  // namespace binosplat::test
