// Facts about a touchpad, which X.Org's driver for tests stands for: Xvfb has no gestures.
#include "tests/app/view/view_desk.h"

#include <sys/socket.h>
#include <sys/un.h>

SUITE(view_pinch) {

constexpr const char* kConfig = R"(
Section "ServerFlags"
    Option "AutoAddDevices" "false"
EndSection
Section "Device"
    Identifier "card"
    Driver "dummy"
EndSection
Section "InputDevice"
    Identifier "touchpad"
    Driver "inputtest"
    Option "SocketPath" "{}"
    Option "DeviceType" "PointerGesture"
EndSection
Section "InputDevice"
    Identifier "keys"
    Driver "inputtest"
    Option "SocketPath" "keys"
    Option "DeviceType" "Keyboard"
EndSection
Section "ServerLayout"
    Identifier "desk"
    InputDevice "touchpad" "CorePointer"
    InputDevice "keys" "CoreKeyboard"
EndSection
)";

// X.Org's server for a screen without a monitor; it prints the display's number, or "none". Its touchpad
// takes what is written to the socket "touchpad".
std::string startXorg(const Workplace& work) {
    work.write("xorg.conf", fmt::format(kConfig, (work.path / "touchpad").string()));
    return "sh -c 'Xorg -displayfd 1 -terminate -novtswitch -sharevts -config xorg.conf -logfile xorg.log "
           "2> /dev/null || echo none'";
}

// A program at the other end of that socket.
class Touchpad {
public:
    explicit Touchpad(const std::string& socket_file) {
        sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
        socket_file.copy(address.sun_path, sizeof address.sun_path - 1);
        REQUIRE(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
        struct {
            std::uint32_t bytes = sizeof *this, kind = 0;
            std::uint16_t major = 1, minor = 1;
        } version;
        say(version);
        std::array<char, 12> answer{};
        REQUIRE(read(socket_, answer.data(), answer.size()) == 12);
    }
    Touchpad(const Touchpad&) = delete;
    Touchpad& operator=(const Touchpad&) = delete;
    ~Touchpad() { close(socket_); }

    // Two fingers move until they are `apart` times as far apart as at first.
    void pinch(double apart) const {
        gesture(kBegin, 1.0);
        for (const double share : {0.25, 0.5, 0.75, 1.0}) { gesture(kUpdate, std::pow(apart, share)); }
        gesture(kEnd, apart);
    }

private:
    static constexpr int kBegin = 27, kUpdate = 28, kEnd = 29;  // of XInput 2.4
    template <typename Message>
    void say(const Message& message) const {
        REQUIRE(write(socket_, &message, sizeof message) == static_cast<ssize_t>(sizeof message));
    }
    // The driver's message for a pinch by two fingers.
    void gesture(int kind, double scale) const {
        struct {
            std::uint32_t bytes = sizeof *this, message = 7;
            std::uint16_t kind, fingers = 2;
            std::uint32_t flags = 0;
            std::array<double, 4> moved{};
            double scale, turned = 0.0;
        } pinch{.kind = static_cast<std::uint16_t>(kind), .scale = scale};
        say(pinch);
    }

    int socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
};

TEST_CASE_FIXTURE(AtWork, "a pinch zooms towards the pointer, as the wheel does") {
    if (!isInstalled("Xorg", "xserver-xorg-core, xserver-xorg-video-dummy") || !haveScreen()) { return; }
    Program server(work.path, startXorg(work));
    const std::string number = server.await("\n");
    if (number == "none\n") {
        MESSAGE("skipped: Xorg does not start here");
        return;
    }
    const std::string name = ":" + std::to_string(std::stoi(number)), display = "DISPLAY=" + name + " ";
    const XConnection connection(name);  // without clients, the server ends
    const Touchpad touchpad((work.path / "touchpad").string());
    const auto does = [&](const std::string& what) {
        REQUIRE(std::system((display + "timeout 60 xdotool " + what + " >/dev/null").c_str()) == 0);
    };
    picturesInto(work);
    drawOnce(work);
    Program viewer(work.path, viewOnDesk("builtin:slanted-wall --desktop --hide-panel", 96, name));
    viewer.await("shows ");
    does("search --sync --onlyvisible --name ' - binosplat$' mousemove --window %1 500 300");
    const auto picture = [&] {
        does("key p");
        const std::string lines = viewer.await("/pictures/");
        const std::size_t file = lines.rfind(": picture ") + 10;
        return readPicture(lines.substr(file, lines.size() - 1 - file));
    };
    const auto psnrDb = [&](const Image& a, const Image& b) { return compare(a, b).psnrDb(); };
    const Image start = picture();
    does("click --repeat 3 4");
    const Image near = picture();
    CHECK(psnrDb(start, near) < 30.0);
    does("click --repeat 3 5");
    CHECK(psnrDb(start, picture()) > 50.0);
    // Each step of the wheel leaves 0.85 of the way.
    touchpad.pinch(std::pow(0.85, -3));
    // It reaches the viewer by a connection of its own, maybe after the key that asks for a picture.
    Image pinched = picture();
    for (int more = 0; more < 20 && psnrDb(start, pinched) > 50.0; ++more) { pinched = picture(); }
    CHECK(psnrDb(near, pinched) > 50.0);
    does("key Escape");
    viewer.checkEnd(" pictures in the window, ");
}

}  // SUITE(view_pinch)
