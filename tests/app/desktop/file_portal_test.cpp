// Facts about the portal's dialog for files: what is chosen there is what is opened.
#include "app/desktop/file_portal.h"
#include "engine/platform.h"
#include "tests/run_program.h"
#include "tests/xr/simulated/installed.h"

#include <signal.h>

SUITE(file_portal) {

template <typename Function>
Function* call(const char* name) {
    return functionIn<Function>("libsystemd.so.0", name);
}

// Answers the call, and then says what was chosen; nothing if `uri` is null.
int answer(void* message, void* uri, void*) {
    CHECK(call<int(void*, const char*, const char*)>("sd_bus_message_is_method_call")(
              message, "org.freedesktop.portal.FileChooser", "OpenFile") > 0);
    call<int(void*, const char*, ...)>("sd_bus_reply_method_return")(message, "o", "/request");
    void* const bus = call<void*(void*)>("sd_bus_message_get_bus")(message);
    const auto say = [&](const char* types, auto... values) {
        call<int(void*, const char*, const char*, const char*, const char*, ...)>("sd_bus_emit_signal")(
            bus, "/request", "org.freedesktop.portal.Request", "Response", types, values...);
    };
    uri == nullptr
        ? say("ua{sv}", 1u, 0u)
        : say("ua{sv}", 0u, 2u, "choices", "a(ss)", 0u, "uris", "as", 1u, static_cast<const char*>(uri));
    return 1;
}

TEST_CASE_FIXTURE(AtWork, "a file is chosen by the portal, where there is one") {
    CHECK(these(pathOfUri("file:///a%20b%c3%a9.ply"), pathOfUri("file:///50%"),
                pathOfUri("https://a/b.ply")) == these("/a b\xc3\xa9.ply", "/50%", ""));
    const auto never = [] { return false; };
    setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent", 1);
    CHECK_FALSE(askPortalForFile(never).has_value());
    const bool has_library = functionOf("libsystemd.so.0", "sd_bus_open_user") != nullptr;
    if (!has_library || !isInstalled("dbus-daemon", "dbus")) { return; }
    // Without the services of this machine, which may have a portal.
    work.write("bus.conf",
               "<busconfig><type>session</type><listen>unix:tmpdir=/tmp</listen><policy context=\"default\">"
               "<allow send_destination=\"*\"/><allow eavesdrop=\"true\"/><allow own=\"*\"/></policy>"
               "</busconfig>");
    std::istringstream started(
        work.runCommand("dbus-daemon --config-file=bus.conf --fork --print-address=1 --print-pid=1").output);
    std::string address;
    pid_t daemon = 0;
    started >> address >> daemon;
    REQUIRE(daemon > 0);
    const std::unique_ptr<pid_t, void (*)(pid_t*)> ends_daemon(&daemon,
                                                               [](pid_t* pid) { kill(*pid, SIGTERM); });
    setenv("DBUS_SESSION_BUS_ADDRESS", address.c_str(), 1);
    CHECK_FALSE(askPortalForFile(never).has_value());  // a bus without a portal
    std::string uri = "file:///home/a%20scene.ply";
    for (void* const chosen : {static_cast<void*>(uri.data()), static_cast<void*>(nullptr)}) {
        void* bus = nullptr;
        REQUIRE(call<int(void**)>("sd_bus_open_user")(&bus) >= 0);
        using Handler = int (*)(void*, void*, void*);
        REQUIRE(call<int(void*, void**, const char*, Handler, void*)>("sd_bus_add_object")(
                    bus, nullptr, "/org/freedesktop/portal/desktop", answer, chosen) >= 0);
        REQUIRE(call<int(void*, const char*, std::uint64_t)>("sd_bus_request_name")(
                    bus, "org.freedesktop.portal.Desktop", 0) >= 0);
        std::atomic<bool> ends = false;
        std::thread portal([&] {
            while (!ends) {
                if (call<int(void*, void**)>("sd_bus_process")(bus, nullptr) == 0) {
                    call<int(void*, std::uint64_t)>("sd_bus_wait")(bus, 10'000);
                }
            }
        });
        const ChosenFile file = askForFile(never);
        ends = true;
        portal.join();
        call<void*(void*)>("sd_bus_flush_close_unref")(bus);
        CHECK(these(file.file, file.trouble) == these(chosen != nullptr ? "/home/a scene.ply" : "", ""));
    }
}

}  // SUITE(file_portal)
