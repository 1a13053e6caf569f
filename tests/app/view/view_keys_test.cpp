// Facts about the window without a headset: what its keys do, which scenes it opens, and when it opens.
#include "tests/app/view/view_desk.h"
#include "tests/engine/stream/moving_frames.h"

SUITE(view_keys) {

TEST_CASE_FIXTURE(AtWork, "keys fly along the camera's axes, F shows the whole scene, F11 fills the screen") {
    if (!haveScreen()) { return; }
    Window window(work, "--desktop --eye 0,0,-1 --look 0,0,3 --up 0,-1,0");
    const glm::dvec2 from(500.0, 300.0), to(620.0, 340.0);
    const glm::dvec3 seen = window.seenAt(from);
    window.drag(2, from, to);
    CHECK(glm::distance(window.seenAt(to), seen) < 0.06);
    glm::dvec3 at = window.eye(work);
    const auto stepOf = [&](const std::string& key) {
        hands("keydown " + key);
        for (int i = 0; i < 2; ++i) { window.help(); }
        hands("keyup " + key);
        const glm::dvec3 before = std::exchange(at, window.eye(work));
        return at - before;
    };
    hands("keydown Shift_L");
    CHECK(stepOf("w").z > 0.0);
    hands("keyup Shift_L");
    CHECK(glm::distance(glm::normalize(stepOf("a")), {-1.0, 0.0, 0.0}) < 1e-6);
    // Wherever it was, in this direction the whole scene is seen from one place.
    const auto wholeFrom = [&] {
        hands("key f");
        window.await("arrived");
        return window.eye(work);
    };
    const glm::dvec3 whole = wholeFrom();
    CHECK(glm::distance(whole, at) > 0.01);
    CHECK(glm::length(stepOf("d")) > 0.0);
    CHECK(glm::distance(wholeFrom(), whole) < 1e-6);
    const auto widthAfter = [&](const std::string& key) {
        hands("key " + key);
        window.help();
        return static_cast<int>(numberOfWindow(" - binosplat$", "WIDTH"));
    };
    CHECK(widthAfter("F11") == kScreenPx.x);
    CHECK(widthAfter("Escape") == 1280);
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "in the window a moving scene rests, steps to and fro, and plays") {
    if (!haveScreen()) { return; }
    writeSliding((work.path / "slide").string(), 12, 2000);
    Window window(work, "--desktop --hide-panel --scene-rate 15", "", "slide");
    const auto seenAfter = [&](const std::string& key) {
        hands("key " + key);
        window.await("paused at frame ");
        window.rest();
        return Window::shown();
    };
    const Image paused = seenAfter("space");
    window.rest();
    CHECK(Window::shown().values == paused.values);
    CHECK(seenAfter("period").values != paused.values);
    CHECK(seenAfter("comma").values == paused.values);
    hands("key space");
    window.await("plays from frame ");
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "of a folder the first scene is shown, or the one clicked; O asks for a file") {
    if (!haveScreen()) { return; }
    fs::create_directory(work.path / "two");
    for (const char* name : {"two/a", "two/b", "c"}) {
        work.go(fmt::format("scene one-splat --out {}.ply", name));
    }
    dialogDoes(work, "echo c.ply");
    Window window(work, "--desktop", "", "two");
    CHECK(contains(window.said(), "two/a.ply"));
    CHECK_FALSE(contains(window.said(), "two/b.ply"));
    window.rest();
    window.click("b.ply", PanelPage::kScenes, (work.path / "two").string());
    window.await("two/b.ply");
    window.click("favourite b.ply", PanelPage::kScenes, (work.path / "two").string());
    hands("key o");
    window.await("shows c.ply");
    // Its end closes the dialog.
    dialogDoes(work, "exec sleep 600");
    hands("key o");
    window.end();
    CHECK(textIn(work.base / "config/binosplat/favourite-scenes.txt") ==
          (work.path / "two/b.ply").string() + "\n");
    // Without a scene, it shows a room and the list of scenes.
    std::string alone = viewOnDesk("");
    alone.resize(alone.rfind(" view "));
    Program program(work.path, "env XR_RUNTIME_JSON=/nonexistent/runtime.json" + alone.substr(3));
    program.await("shows builtin:atelier");
    Window::point();
    hands("key p");
    program.await("/pictures/");
    Window::click("step-edge", PanelPage::kScenes, kBuiltinFolder);
    program.await("shows builtin:step-edge");
    hands("key Escape");
    program.checkEnd(" pictures in the window, ");
}

TEST_CASE_FIXTURE(AtWork, "a headset that comes within two seconds is chosen; without one, a window opens") {
    if (!haveScreen()) { return; }
    const auto viewWith = [](const std::string& script, const std::string& options) {
        return "env " + kScripted + script + " " +
               viewOnDesk("builtin:slanted-wall --load-first --hide-panel " + options).substr(3);
    };
    work.write("worn.script", "rate 90\nsize 64 64\nframes none\nno-headset-for 3\nat 0.5 exit\n");
    Program worn(work.path, viewWith("worn.script", "--mode mono"));
    worn.checkEnd();
    CHECK(contains(worn.said(), "64x64 per eye"));
    CHECK_FALSE(contains(worn.said(), "in a window"));
    // With --desktop even one that answers at once is not.
    work.write("there.script", "rate 90\nsize 64 64\nframes none\nat 0.5 exit\n");
    Program unused(work.path, viewWith("there.script", "--desktop --frames 1"));
    unused.checkEnd(" pictures in the window, ");
    CHECK_FALSE(contains(unused.said(), "per eye"));
    work.write("unplugged.script", "plugged off\n");
    const auto begin = std::chrono::steady_clock::now();
    Program unplugged(work.path, viewWith("unplugged.script", ""));
    const std::string decided = unplugged.await("the scene is shown in a window; no headset: ");
    CHECK(std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(1900));
    CHECK(decided.ends_with(" has no headset\n"));
    unplugged.await("a window, on ");
    unplugged.await("shows ");
    Window::point();
    hands("key Escape");
    unplugged.checkEnd(" pictures in the window, ");
}

}  // SUITE(view_keys)
