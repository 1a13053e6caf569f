// One call over D-Bus, and the signal that answers it: both on one connection, with which the dialog closes.
#include "app/desktop/file_portal.h"

#include "engine/error.h"
#include "engine/platform.h"

#include <charconv>
#include <cstdint>
#include <memory>
#include <string_view>

namespace binosplat {

namespace {

// libsystemd's sd-bus, where it is installed, so that the program needs no library for this alone.
constexpr const char* kLibrary = "libsystemd.so.0";
// How long a portal may take to begin: who closes the window waits for that.
constexpr std::uint64_t kBeginMicroseconds = 5'000'000;
constexpr std::uint64_t kWaitMicroseconds = 200'000;

template <typename Function>
Function* call(const char* name) {
    void* const function = functionOf(kLibrary, name);
    check(function != nullptr, "{} has no {}", kLibrary, name);
    return reinterpret_cast<Function*>(function);
}

void require(int result, const char* what) { check(result >= 0, "the portal: {} fails", what); }

struct Answer {
    bool is_there = false;
    ChosenFile chosen;
};

// What a response lists, by name: of "uris", the first one.
std::string uriIn(void* message) {
    const auto enter = call<int(void*, char, const char*)>("sd_bus_message_enter_container");
    const auto read = call<int(void*, const char*, ...)>("sd_bus_message_read");
    const auto leave = call<int(void*)>("sd_bus_message_exit_container");
    const auto skip = call<int(void*, const char*)>("sd_bus_message_skip");
    const char *name = nullptr, *uri = nullptr;
    require(enter(message, 'a', "{sv}"), "reading its answer");
    while (enter(message, 'e', "sv") > 0) {
        require(read(message, "s", &name), "reading its answer");
        if (std::string_view(name) == "uris" && enter(message, 'v', "as") > 0 &&
            enter(message, 'a', "s") > 0 && read(message, "s", &uri) > 0) {
            return uri;
        }
        require(skip(message, "v"), "reading its answer");
        require(leave(message), "reading its answer");
    }
    return {};
}

// A response: 0 if a file was chosen.
int takeResponse(void* message, void* data, void* /*error*/) {
    auto& answer = *static_cast<Answer*>(data);
    answer.is_there = true;
    try {
        unsigned code = 0;
        require(call<int(void*, const char*, ...)>("sd_bus_message_read")(message, "u", &code),
                "reading its answer");
        const std::string uri = code == 0 ? uriIn(message) : "";
        answer.chosen.file = pathOfUri(uri);
        if (!uri.empty() && answer.chosen.file.empty()) {
            answer.chosen.trouble = uri + " cannot be opened, must be a file on this machine";
        }
    } catch (const Error& error) { answer.chosen.trouble = error.what(); }
    return 0;
}

}  // namespace

std::string pathOfUri(const std::string& uri) {
    constexpr std::string_view kBegin = "file:///";
    if (!uri.starts_with(kBegin)) { return {}; }
    std::string path;
    for (std::size_t i = kBegin.size() - 1; i < uri.size(); ++i) {
        unsigned char byte = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            path += static_cast<char>(byte);
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

std::optional<ChosenFile> askPortalForFile(const std::function<bool()>& ends) {
    if (functionOf(kLibrary, "sd_bus_match_signal") == nullptr) { return std::nullopt; }
    try {
        void* opened = nullptr;
        require(call<int(void**)>("sd_bus_open_user")(&opened), "reaching D-Bus");
        const std::unique_ptr<void, void* (*)(void*)> bus(opened,
                                                          call<void*(void*)>("sd_bus_flush_close_unref"));
        require(
            call<int(void*, std::uint64_t)>("sd_bus_set_method_call_timeout")(bus.get(), kBeginMicroseconds),
            "setting a time limit");
        Answer answer;
        using Handler = int (*)(void*, void*, void*);
        require(
            call<int(void*, void**, const char*, const char*, const char*, const char*, Handler, void*)>(
                "sd_bus_match_signal")(bus.get(), nullptr, nullptr, nullptr, "org.freedesktop.portal.Request",
                                       "Response", takeResponse, &answer),
            "listening");
        require(call<int(void*, const char*, const char*, const char*, const char*, void*, void**,
                         const char*, ...)>("sd_bus_call_method")(
                    bus.get(), "org.freedesktop.portal.Desktop", "/org/freedesktop/portal/desktop",
                    "org.freedesktop.portal.FileChooser", "OpenFile", nullptr, nullptr, "ssa{sv}", "",
                    "Open a scene", 0u),
                "opening its dialog");
        while (!answer.is_there && !ends()) {
            const int done = call<int(void*, void**)>("sd_bus_process")(bus.get(), nullptr);
            require(done, "waiting");
            if (done == 0) {
                require(call<int(void*, std::uint64_t)>("sd_bus_wait")(bus.get(), kWaitMicroseconds),
                        "waiting");
            }
        }
        return answer.chosen;
    } catch (const Error&) { return std::nullopt; }
}

}  // namespace binosplat
