// A connection of its own to the X server, since GLFW drops these events from
// its own one.
#include "app/desktop/pinch.h"

#include "engine/platform.h"

#include <array>
#include <mutex>
#include <thread>
#include <utility>

namespace binosplat {

namespace {

// Of Xlib and libXi, which GLFW loads anyway; null without them.
template <typename Function>
Function* in(const char* library, const char* name) {
    return reinterpret_cast<Function*>(functionOf(library, name));
}
template <typename Function>
Function* x11(const char* name) {
    return in<Function>("libX11.so.6", name);
}

constexpr int kClientMessage = 33, kGenericEvent = 35, kMasterDevices = 1;
constexpr int kPinchBegin = 27, kPinchUpdate = 28, kPinchEnd = 29;

// Xlib's XEvent, in the shape of XGenericEventCookie and of
// XClientMessageEvent; XIEventMask and XIGesturePinchEvent.
struct Cookie {
    int type;
    unsigned long serial;
    int sent;
    void* display;
    int extension, kind;
    unsigned cookie;
    void* data;
    std::array<unsigned long, 17> rest;  // an event is 24 longs
};
using Message = std::array<unsigned long, 24>;
struct EventMask {
    int device, bytes;
    unsigned char* bits;
};
struct PinchEvent {
    int type;
    unsigned long serial;
    int sent;
    void* display;
    int extension, kind;
    unsigned long time;
    int device, source, fingers;
    unsigned long root, window, child;
    double root_x, root_y, x, y, delta_x, delta_y, raw_delta_x, raw_delta_y;
    double scale;  // since the begin
};

int ignoreError(void*, void*) { return 0; }

}  // namespace

class Pinch::Listener {
public:
    Listener(void* display, int extension, unsigned long window, std::function<void()> tell)
        : display_(display), extension_(extension), tell_(std::move(tell)) {
        std::array<unsigned char, 4> bits{};
        for (const int kind : {kPinchBegin, kPinchUpdate, kPinchEnd}) {
            bits[static_cast<std::size_t>(kind / 8)] |= static_cast<unsigned char>(1 << kind % 8);
        }
        EventMask mask{kMasterDevices, static_cast<int>(bits.size()), bits.data()};
        // An error would end the program.
        using Handler = int (*)(void*, void*);
        const auto setHandler = x11<Handler(Handler)>("XSetErrorHandler");
        const Handler before = setHandler(ignoreError);
        in<int(void*, unsigned long, EventMask*, int)>("libXi.so.6", "XISelectEvents")(display_, window,
                                                                                       &mask, 1);
        const unsigned long root = x11<unsigned long(void*)>("XDefaultRootWindow")(display_);
        alarm_ =
            x11<unsigned long(void*, unsigned long, int, int, unsigned, unsigned, unsigned, unsigned long,
                              unsigned long)>("XCreateSimpleWindow")(display_, root, 0, 0, 1, 1, 0, 0, 0);
        x11<int(void*, int)>("XSync")(display_, 0);
        setHandler(before);
        thread_ = std::thread([this] { listen(); });
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    // A message by GLFW's connection ends the wait for events.
    ~Listener() {
        void* const other = in<void*()>("libglfw.so.3", "glfwGetX11Display")();
        Message event{kClientMessage, 0, 0, 0, alarm_, 1, 32};
        x11<int(void*, unsigned long, int, long, Message*)>("XSendEvent")(other, alarm_, 0, 0, &event);
        x11<int(void*)>("XFlush")(other);
        thread_.join();
        x11<int(void*)>("XCloseDisplay")(display_);
    }

    double take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(ratio_, 1.0);
    }

private:
    void listen() {
        const auto next = x11<int(void*, Cookie*)>("XNextEvent");
        const auto getData = x11<int(void*, Cookie*)>("XGetEventData");
        const auto freeData = x11<void(void*, Cookie*)>("XFreeEventData");
        for (;;) {
            Cookie cookie{};
            next(display_, &cookie);
            if (cookie.type == kClientMessage) { return; }
            if (cookie.type != kGenericEvent || cookie.extension != extension_ ||
                getData(display_, &cookie) == 0) {
                continue;
            }
            const double scale = static_cast<const PinchEvent*>(cookie.data)->scale;
            follow(cookie.kind == kPinchUpdate ? scale : 1.0, cookie.kind == kPinchUpdate);
            freeData(display_, &cookie);
        }
    }
    void follow(double scale, bool goes_on) {
        if (!(scale > 0.0)) { return; }
        const double before = std::exchange(scale_, scale);
        if (!goes_on) { return; }
        {
            const std::lock_guard lock(mutex_);
            ratio_ *= scale / before;
        }
        tell_();
    }

    void* display_;
    int extension_;
    std::function<void()> tell_;
    unsigned long alarm_ = 0;  // a window, never shown
    double scale_ = 1.0;       // of the pinch so far
    std::mutex mutex_;
    double ratio_ = 1.0;
    std::thread thread_;
};

Pinch::Pinch(GLFWwindow* window, std::function<void()> tell) {
    const auto windowOf = in<unsigned long(GLFWwindow*)>("libglfw.so.3", "glfwGetX11Window");
    const auto open = x11<void*(const char*)>("XOpenDisplay");
    const auto ask = in<int(void*, int*, int*)>("libXi.so.6", "XIQueryVersion");
    if (windowOf == nullptr || open == nullptr || ask == nullptr) { return; }
    const unsigned long number = windowOf(window);
    void* const display = number != 0 ? open(nullptr) : nullptr;
    if (display == nullptr) { return; }
    int extension = 0, event = 0, error = 0, major = 2, minor = 4;
    const bool has_gestures = x11<int(void*, const char*, int*, int*, int*)>("XQueryExtension")(
                                  display, "XInputExtension", &extension, &event, &error) != 0 &&
                              ask(display, &major, &minor) == 0 && (major > 2 || (major == 2 && minor >= 4));
    if (has_gestures) {
        listener_ = std::make_unique<Listener>(display, extension, number, std::move(tell));
    } else {
        x11<int(void*)>("XCloseDisplay")(display);
    }
}

Pinch::~Pinch() = default;

double Pinch::take() { return listener_ ? listener_->take() : 1.0; }

}  // namespace binosplat
