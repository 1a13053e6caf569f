// Facts about the window's end: by its cross or by Escape, with the device, with the display, and before there is a headset.
#include "app/view/panel/panel_font.h"
#include "app/view/window/mirror_window.h"
#include "engine/error.h"
#include "tests/app/view/view_window.h"

TEST_SUITE_BEGIN("view_window_end");

namespace view_window_end_test {

using namespace binosplat;
using namespace binosplat::test;

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
        REQUIRE(canvas.font().want("\xd7\x90"));
        canvas.font().build();
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

}  // namespace view_window_end_test
