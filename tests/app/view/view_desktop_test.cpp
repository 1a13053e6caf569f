// Facts about the window without a headset: what mouse and keys do, what it shows, that it rests.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "tests/app/view/view_desk.h"

SUITE(view_desktop) {

// The fence, whose colours depend on the direction from which they are seen.
void writeGlossyFence(const fs::path& file) {
    constexpr std::size_t kValues = 48;  // of three bands
    Scene fence = makeBuiltin("builtin:fence");
    std::vector<float> sh(kValues * fence.size(), 0.1f);
    for (std::size_t i = 0; i < fence.size(); ++i) {
        std::copy_n(fence.sh.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                    sh.begin() + static_cast<std::ptrdiff_t>(kValues * i));
    }
    fence.sh = std::move(sh);
    fence.sh_degree = 3;
    writePly(fence, file.string());
}

TEST_CASE_FIXTURE(AtWork, "without a runtime the scene is in a window, as render draws it, and rests") {
    if (!haveScreen()) { return; }
    Window window(
        work, "--hide-panel",
        withFaults("BINOSPLAT_FAULT_TRACE=trace.txt XR_RUNTIME_JSON=/nonexistent/runtime.json ", ""));
    CHECK(contains(window.said(), "\nthe scene is shown in a window; no headset: no OpenXR runtime found"));
    // At first it is coarse.
    const std::string first = window.await("its first picture has ");
    glm::uvec2 first_px(0);
    CHECK(std::sscanf(first.substr(first.find("has ")).c_str(), "has %ux%u", &first_px.x, &first_px.y) == 2);
    CHECK(these(first_px.x == within(320, 640), first_px.y == within(180, 360)) == these(true, true));
    const glm::dvec2 place(500.0, 300.0), beside(620.0, 340.0);
    const glm::dvec3 start = window.seenAt(place);
    const auto fromStart = [&](const glm::dvec2& at) { return glm::distance(window.seenAt(at), start); };
    constexpr double kSomePixels = 0.06;
    CHECK(std::abs(start.z - (4.0 + start.x)) < kSomePixels);  // on the wall
    const glm::dvec3 eye = window.eye(work);
    const auto hasMoved = [&] { return glm::distance(window.eye(work), eye) > 0.1; };
    window.drag(1, place, beside);
    CHECK(hasMoved());
    CHECK(fromStart(place) < kSomePixels);  // orbits around it
    window.drag(3, place, beside);
    CHECK(fromStart(beside) < kSomePixels);  // moves with it
    hands(moveTo(place) + "click 4");
    CHECK(hasMoved());
    CHECK(fromStart(place) < kSomePixels);  // zooms towards it
    CHECK(fromStart({400.0, 300.0}) > 0.5);
    // The help is a list of keys on the panel.
    const auto panelAfterHelp = [&] {
        window.help();
        window.rest();
        return partOf(Window::shown(), {743, 0}, {1280, 672});
    };
    const Image with = panelAfterHelp(), without = panelAfterHelp();
    const auto differ = [](const glm::vec3& a, const glm::vec3& b) { return std::abs(a.r - b.r) > 0.2f; };
    CHECK(countPixels(with, without, differ) > 3000);
    // Hides the panel, which the help had brought up.
    hands("key Tab");
    window.await("panel = false");
    work.go("render builtin:slanted-wall --mode mono --order distance --size 1280x720 --fov-x 60 --out wall");
    const Image screen = Window::shown(), drawn = readPicture(work.path / "wall" / "mono.png");
    CHECK(compare(screen, drawn).psnrDb() > 40.0);
    window.rest();
    CHECK(compare(readPicture(window.picture()), drawn).psnrDb() > 45.0);
    // Other input gives the device nothing to do, and the processor little. The answer to O is a sign that
    // all before it has been handled; for it, the device copies a picture of the scene that might be left.
    dialogDoes(work, "echo missing.ply");
    const auto submitted = [&] { return std::ranges::count(work.bytesOf("trace.txt"), 's'); };
    const auto submissions = [&] {
        hands("key o");
        window.await("missing.ply");
        return submitted();
    };
    const auto before = submissions();
    const double begin_s = window.processorSeconds();
    const auto begin = std::chrono::steady_clock::now();
    hands("key --repeat 20 --delay 30 F12");
    CHECK(submissions() == before + 1);
    CHECK(before > 0);
    CHECK(window.processorSeconds() - begin_s <
          0.5 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    // Without input there is less to do still.
    const auto at_rest = submitted();
    const double rest_s = window.processorSeconds();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    CHECK(submitted() == at_rest);
    CHECK(window.processorSeconds() - rest_s < 0.1);
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "pictures are taken beside the frames, also in motion, which make nothing for it") {
    if (!haveScreen()) { return; }
    // Frames in motion are coarse where the device is slow.
    Window window(work, "--desktop --hide-panel",
                  withFaults("BINOSPLAT_FAULT_WAITS=waits.txt BINOSPLAT_FAULT_LOAD=0:100 ", ""));
    window.help();
    window.help();
    window.rest();  // at its full size
    const std::size_t before = linesIn(work.bytesOf("waits.txt")).size();
    window.rest();
    hands("keydown w sleep 0.3 keyup w");
    window.rest();
    window.help();
    const std::vector<std::string> lines = linesIn(work.bytesOf("waits.txt"));
    REQUIRE(lines.size() > before);
    for (std::size_t i = before; i < lines.size(); ++i) {
        std::istringstream words(lines[i].substr(lines[i].find(' ') + 1));
        for (std::string kind, count; words >> kind >> count;) {
            CHECK_MESSAGE(kind.starts_with("fence-of-"), lines[i]);
        }
    }
    window.end();
}

TEST_CASE("a window whose surface is lost goes on; each kind of stereo shows each eye its own picture") {
    if (!haveScreen()) { return; }
    // In a square window, half of its width or height shows the middle half of the whole picture.
    constexpr std::uint32_t kSide = 600, kHalf = 300;
    for (const std::string stereo : {"side-by-side", "cross-eyed", "top-bottom", "anaglyph"}) {
        CAPTURE(stereo);
        const Workplace work;
        work.write(
            "stereo.toml",
            fmt::format("[view]\npanel = false\nwindow-stereo = \"{}\"\npicture-both-eyes = true\n", stereo));
        Window window(work, "--desktop --config stereo.toml",
                      withFaults("BINOSPLAT_FAULT=present:2:surface-lost-once", "") + " ");
        window.help();
        hands(
            "search --onlyvisible --name '^builtin:slanted-wall - binosplat$' windowsize --sync %1 600 600");
        window.help();
        hands("key Tab");
        window.await("panel = false");
        window.rest();
        const Image screen = partOf(desk().screen.picture(), {0, 0}, {kSide, kSide}),
                    both = readPicture(window.picture());
        REQUIRE(both.size_px == glm::uvec2(2 * kSide, kSide));
        window.end();
        const std::array<Image, 2> eyes{sideOf(both, kLeft), sideOf(both, kRight)};
        CHECK(compare(eyes[kLeft], eyes[kRight]).psnrDb() < 30.0);
        if (stereo == "anaglyph") {
            Image expected = eyes[kRight];
            for (std::size_t i = 0; i < expected.values.size(); i += 3) {
                expected.values[i] = eyes[kLeft].values[i];
            }
            CHECK(compare(screen, expected).psnrDb() > 35.0);
            continue;
        }
        const bool is_above = stereo == "top-bottom";
        const glm::uvec2 part(is_above ? kSide : kHalf, is_above ? kHalf : kSide),
            second = glm::uvec2(kSide) - part, middle = second / 2u;
        for (const int place : {0, 1}) {
            const glm::uvec2 from = place == 0 ? glm::uvec2(0) : second;
            const int e = stereo == "cross-eyed" ? 1 - place : place;
            CHECK(compare(partOf(screen, from, from + part),
                          partOf(eyes[static_cast<std::size_t>(e)], middle, middle + part))
                      .psnrDb() > 35.0);
        }
    }
}

TEST_CASE_FIXTURE(AtWork, "at rest each pixel of the window becomes the mean of four, if that is wanted") {
    if (!haveScreen()) { return; }
    work.write("smooth.toml", "[view]\nwindow-smooth = \"on\"\n");
    Window window(work, "--desktop --config smooth.toml --hide-panel", "", "builtin:atelier");
    const auto drawn = [&](const std::string& size, const std::string& out) {
        work.go("render builtin:atelier --mode mono --order distance --fov-x 60 --size " + size + " --out " +
                out);
        return readPicture(work.path / out / "mono.png");
    };
    const Image once = drawn("1280x720", "once"), fine = drawn("2560x1440", "fine");
    Image mean = once;
    const std::size_t row = std::size_t{3} * fine.size_px.x;
    for (std::size_t i = 0; i < mean.values.size(); ++i) {
        const std::size_t y = i / (row / 2), x = i % (row / 2);
        const float* const first = &fine.values[2 * y * row + 2 * (x - x % 3) + x % 3];
        mean.values[i] = 0.25f * (first[0] + first[3] + first[row] + first[row + 3]);
    }
    // With bytes rounded twice, two pictures that are alike agree to 56 dB.
    const double smooth_db = compare(once, mean).psnrDb() + 4.0;
    double psnr_db = 0.0;
    for (int look = 0; look < 200 && psnr_db < smooth_db; ++look) {
        psnr_db = compare(Window::shown(), mean).psnrDb();
    }
    CHECK(psnr_db >= smooth_db);
    // So does each of a file's.
    window.rest();
    CHECK(compare(readPicture(window.picture()), mean).psnrDb() >= smooth_db);
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "a runtime that hangs keeps no window from opening; a hidden one draws later") {
    if (!haveScreen()) { return; }
    work.go("scene one-splat --out one.ply");
    Window window(work, "--hide-panel",
                  withXrFaults("BINOSPLAT_XR_FAULT=xrCreateInstance:hang", "") + " " + kRuntime);
    CHECK(contains(window.said(),
                   "the scene is shown in a window; no headset: the OpenXR runtime does not answer\n"));
    window.rest();
    const unsigned long number = numberOfWindow("^builtin:slanted-wall - binosplat$", "WINDOW");
    desk().connection.minimize(number, true);
    const std::uint64_t before = window.help();
    desk().connection.drop(number, {work.path / "one.ply"});
    window.await("one.ply");
    CHECK(window.help() == before);
    desk().connection.minimize(number, false);
    window.rest();
    CHECK(window.help() > before);
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "the true size, a viewpoint's name and the panel's settings are kept") {
    if (!haveScreen()) { return; }
    const fs::path kept = work.base / "config" / "binosplat";
    const glm::dvec2 one(200.0, 300.0), other(500.0, 360.0);
    {
        Window window(work, "--desktop");
        const glm::dvec3 from = window.seenAt(one), to = window.seenAt(other);
        window.click("True size", PanelPage::kView);
        window.await("click on one end");
        hands(moveTo(one) + "click 1");
        window.await("and now on its other end");
        hands(moveTo(other) + "click 1");
        window.await("as shown, it is ");
        hands("key 2 period 5 9 BackSpace Return");
        window.await("saved as ");
        CHECK(savedOfWall(work, "metres-per-unit") ==
              doctest::Approx(2.5 / glm::distance(from, to)).epsilon(0.01));
        window.click("Both eyes", PanelPage::kView);
        window.await("picture-both-eyes = true");
        window.rest();
        CHECK(readPicture(window.picture()).size_px == glm::uvec2(2 * 743, 720));
        window.click("Scenes", PanelPage::kView);
        window.await("panel-page");
        for (const char* number : {"1", "2"}) {
            window.drag(3, one, other);
            window.click("Keep this one", PanelPage::kScenes);
            window.await("this viewpoint is kept");
            CHECK(contains(textIn(kept / "scenes/slanted-wall.viewpoints.json"),
                           "your own " + std::string(number)));
        }
        window.click("Name", PanelPage::kScenes);
        for (const char* does : {"key --repeat 12 BackSpace", "type door", "key Return"}) { hands(does); }
        window.await("this viewpoint is called door");
        window.click("Tour", PanelPage::kScenes);
        std::vector<std::size_t> frames;
        for (const char* said :
             {"viewpoint 1 of 2: your own 1", "viewpoint 2 of 2: door", "the tour is over"}) {
            const std::string lines = window.await(said);
            frames.push_back(frameOf(lines.substr(lines.rfind("frame "))));
        }
        // The ways take four seconds each, in steps of at most a tenth, and each step is shown.
        CHECK(std::min(frames[1] - frames[0], frames[2] - frames[1]) > 30);
        window.end();
    }
    CHECK(contains(textIn(kept / "preferences.toml"), "\n[view]\npicture-both-eyes = true\n"));
    Window window(work, "--desktop --hide-panel");
    window.rest();
    CHECK(readPicture(window.picture()).size_px == glm::uvec2(2560, 720));
    hands("key 2");
    window.await("viewpoint 2 of 2: door");
    window.await("arrived");
    const std::vector<View> places = keptPlaces(work);
    REQUIRE(places.size() == 2);
    CHECK(glm::distance(places[0].eye, places[1].eye) > 0.1);
    window.help();  // with the panel
    CHECK(glm::distance(window.eye(work), places[1].eye) < 1e-4);
    // Other people's are dropped on the window.
    writeViewpoint(work, "theirs.viewpoints.json");
    desk().connection.drop(numberOfWindow(" - binosplat$", "WINDOW"), {work.path / "theirs.viewpoints.json"});
    window.await("theirs.viewpoints.json, 1 of them new");
    window.end();
}

TEST_CASE_FIXTURE(AtWork, "two scenes are beside a curtain, and a held key shows the other one whole") {
    if (!haveScreen()) { return; }
    work.go("scene one-splat --out one.ply");
    writeGlossyFence(work.path / "fence.ply");
    const std::string view = " --eye 0,0,-1 --look 0,0,3 --up 0,-1,0";
    const std::string drawing = view + " --mode mono --order distance --size 1280x720 --fov-x 60 --out ";
    const auto draw = [&](const std::string& scene, const std::string& name) {
        work.go("render " + scene + drawing + name);
        return readPicture(work.path / name / "mono.png");
    };
    const Image wall = draw("builtin:slanted-wall", "wall"), fence = draw("fence.ply", "fence");
    REQUIRE(compare(wall, fence).psnrDb() < 25.0);
    REQUIRE(compare(draw("fence.ply --sh-degree 2", "dull"), fence).psnrDb() < 35.0);
    Window window(work, "--desktop --hide-panel --compare fence.ply" + view);
    window.await("compares builtin:slanted-wall with fence.ply");
    // Which part of the window is the one scene, and which is the other.
    const auto check = [&](const Image& image, std::uint32_t from, std::uint32_t to) {
        CAPTURE(from);
        const auto part = [&](const Image& picture) { return partOf(picture, {from, 0}, {to, 720}); };
        CHECK(compare(part(desk().screen.picture()), part(image)).psnrDb() > 40.0);
    };
    window.rest();
    check(wall, 0, 636);
    check(fence, 644, 1280);
    CHECK(compare(readPicture(window.picture()), wall).psnrDb() > 45.0);
    const Image screen = desk().screen.picture();
    const auto [low, high] = std::ranges::minmax(partOf(screen, {637, 0}, {643, 720}).values);
    CHECK(low < 0.2f);
    CHECK(high > 0.9f);
    // Dragging moves the line alone.
    hands(moveTo({641.0, 200.0}));
    window.drag(1, {641.0, 200.0}, {320.0, 250.0});
    window.await("the curtain hangs at 25 %");
    window.rest();
    check(wall, 0, 314);
    check(fence, 326, 1280);
    hands("keydown c");
    window.await("shows fence.ply");
    window.rest();
    check(fence, 0, 1280);
    CHECK(compare(readPicture(window.picture()), fence).psnrDb() > 45.0);
    hands("keyup c");
    window.await("the curtain is back");
    window.rest();
    check(wall, 0, 314);
    // The line may also be let go on the panel.
    window.drag(1, {320.0, 250.0}, {1.0, 250.0});
    window.await("the curtain hangs at 0 %");
    hands("key Tab");
    window.rest();
    window.drag(1, {1.0, 250.0}, {1200.0, 300.0});
    window.await("the curtain hangs at 100 %");
    const unsigned long number = numberOfWindow("^builtin:slanted-wall . fence.ply - binosplat$", "WINDOW");
    desk().connection.drop(number, {work.path / "one.ply", work.path / "fence.ply"});
    window.await("compares " + (work.path / "one.ply").string() + " with " +
                 (work.path / "fence.ply").string());
    // A comparison ends when another scene replaces the first.
    desk().connection.drop(number, {work.path / "one.ply"});
    window.await("shows " + (work.path / "one.ply").string());
    CHECK(numberOfWindow("one.ply - binosplat$", "WINDOW") == number);
    window.end();
}

}  // SUITE(view_desktop)
