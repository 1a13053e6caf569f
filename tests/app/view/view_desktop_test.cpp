// Facts about the window without a headset: what mouse and keys do in it, what it shows, and that it idles
// when nothing changes.
#include "tests/app/view/view_window.h"

SUITE(view_desktop) {

// The number in a line "frame 12: help".
std::uint64_t pictureOf(const std::string& line) {
    return std::stoull(line.substr(line.rfind("frame ") + 6));
}

class Window {
public:
    Window(const Workplace& work, const std::string& options, const std::string& environment = "")
        : program_((picturesInto(work), work.path),
                   "env " + environment + viewOnDesk("builtin:slanted-wall " + options).substr(3)) {
        REQUIRE(program_.waitFor("shows builtin:slanted-wall") != "");
        hands(
            "search --sync --onlyvisible --name '^builtin:slanted-wall - binosplat$' mousemove --window %1 "
            "20 20");
    }
    // Shows or hides the help: once it has changed, everything before has reached the window. Returns the
    // number of its latest picture.
    std::uint64_t help() {
        hands("key h");
        const std::string lines = program_.waitFor("help");
        REQUIRE(lines != "");
        return pictureOf(lines);
    }
    // Waits until the window shows all pixels: only then does it write a picture that was requested.
    void rest() {
        hands("key p");
        picture_ = program_.waitFor("/pictures/");
        REQUIRE(picture_ != "");
        picture_ = picture_.substr(picture_.rfind(": picture ") + 10);
        picture_.pop_back();
    }
    [[nodiscard]] const std::string& picture() const { return picture_; }  // file of the latest picture
    // The colour at a place, after the keys and clicks that came before; then returns to the start view.
    glm::dvec3 seenAt(const glm::dvec2& place) {
        help();
        rest();
        hands(moveTo(place) + "click --repeat 2 --delay 20 1");
        const std::string line = program_.waitFor("the centre is ");
        REQUIRE(line != "");
        glm::dvec3 point(0.0);
        REQUIRE(std::sscanf(line.substr(line.find("centre is")).c_str(), "centre is %lf, %lf, %lf", &point.x,
                            &point.y, &point.z) == 3);
        REQUIRE(program_.waitFor("arrived") != "");
        hands("key r");
        REQUIRE(program_.waitFor("arrived") != "");
        rest();
        return point;
    }
    void drag(int button, const glm::dvec2& from, const glm::dvec2& to) {
        for (const std::string& does : {moveTo(from), fmt::format("mousedown {}", button), moveTo(to),
                                        fmt::format("mouseup {}", button)}) {
            hands(does);
        }
    }
    // Clicks on the panel, which has a scale of 0.7 and is in the upper right corner.
    void click(const std::string& widget, PanelPage page) {
        PanelSketch sketch;
        sketch.status.window.emplace();
        sketch.settings.page = page;
        const glm::dvec2 size(glm::ivec2(0.7 * glm::dvec2(kPanelPx)));
        hands(moveTo(glm::dvec2(1280.0 - size.x, 0.0) + shareOf(sketch.draw().places, widget) * size) +
              "click 1");
    }
    std::string waitFor(const std::string& words) {
        const std::string lines = program_.waitFor(words);
        INFO(words << ": " << program_.said());
        REQUIRE(lines != "");
        return lines;
    }
    // It ends without an error.
    void checkEnd() {
        hands("key Escape");
        CHECK(program_.exitCode() == 0);
        INFO(program_.said());
        CHECK(program_.said().find(" pictures in the window, ") != std::string::npos);
        CHECK(these(program_.said().find("VUID"), program_.said().find("SYNC")) ==
              these(std::string::npos, std::string::npos));
    }
    [[nodiscard]] Program& program() { return program_; }

private:
    Program program_;
    std::string picture_;
};

TEST_CASE(
    "without a runtime the scene is in a window, as render draws it; mouse and wheel keep hold of what is "
    "seen; it rests") {
    if (!haveScreen()) { return; }
    const Workplace work;
    Window window(work, "--hide-panel", "XR_RUNTIME_JSON=/nonexistent/runtime.json ");
    CHECK(window.program().said().find(
              "\nthe scene is shown in a window; no headset: no OpenXR runtime found") != std::string::npos);

    const glm::dvec2 place(500.0, 300.0), beside(620.0, 340.0);
    const glm::dvec3 start = window.seenAt(place);
    const auto fromStart = [&](const glm::dvec2& at) { return glm::distance(window.seenAt(at), start); };
    constexpr double kSomePixels = 0.06;
    window.drag(1, place, beside);
    CHECK(fromStart(place) < kSomePixels);  // orbits around it
    window.drag(3, place, beside);
    CHECK(fromStart(beside) < kSomePixels);  // moves with it
    hands(moveTo(place) + "click 4");
    CHECK(fromStart(place) < kSomePixels);  // zooms towards it
    CHECK(fromStart({400.0, 300.0}) > 0.5);

    // Other input causes no drawing.
    window.help();
    const std::uint64_t before = window.help();
    hands("key --repeat 20 --delay 30 F12");
    CHECK(window.help() <= before + 2);
    window.help();

    // Hides the panel, which the help had brought up.
    hands("key Tab");
    REQUIRE(window.program().waitFor("panel = false") != "");
    REQUIRE(work.run("render builtin:slanted-wall --mode mono --order distance --size 1280x720 --fov-x 60 "
                     "--out drawn")
                .exit_code == 0);
    Image screen = desk().screen.picture();
    const Image drawn = readPicture(work.path / "drawn" / "mono.png");
    CHECK(compare(partOf(screen, {0, 0}, {1280, 720}), drawn).psnrDb() > 40.0);
    window.rest();
    CHECK(compare(readPicture(window.picture()), drawn).psnrDb() > 45.0);
    window.checkEnd();
}

TEST_CASE(
    "in the window a picture is taken beside its frames: they wait for the one that shows all pixels, and "
    "make nothing, nor do those in motion, which are coarse where the device is slow") {
    if (!haveScreen()) { return; }
    const Workplace work;
    Window window(work, "--desktop --hide-panel",
                  withFaults("BINOSPLAT_FAULT_WAITS=waits.txt BINOSPLAT_FAULT_LOAD=0:100 ", ""));
    const auto linesOf = [&] {
        std::vector<std::string> lines;
        std::ifstream file(work.path / "waits.txt");
        for (std::string line; std::getline(file, line);) { lines.push_back(line); }
        return lines;
    };
    window.help();
    window.help();
    window.rest();  // at its full size
    const std::size_t before = linesOf().size();
    window.rest();
    hands("keydown w sleep 0.3 keyup w");
    window.rest();
    window.help();
    const std::vector<std::string> lines = linesOf();
    REQUIRE(lines.size() > before);
    for (std::size_t i = before; i < lines.size(); ++i) {
        std::istringstream words(lines[i].substr(lines[i].find(' ') + 1));
        for (std::string kind, count; words >> kind >> count;) {
            CHECK_MESSAGE(kind.starts_with("fence-of-"), lines[i]);
        }
    }
    window.checkEnd();
}

TEST_CASE(
    "a window whose surface is lost goes on, and in another size, too; for crossed eyes both pictures change "
    "places") {
    if (!haveScreen()) { return; }
    std::vector<Image> left, right;
    for (const char* stereo : {"side-by-side", "cross-eyed"}) {
        const Workplace work;
        std::ofstream(work.path / "stereo.toml")
            << fmt::format("[view]\npanel = false\nwindow-stereo = \"{}\"\n", stereo);
        Window window(work, "--desktop --config stereo.toml",
                      withFaults("BINOSPLAT_FAULT=present:2:surface-lost-once", "") + " ");
        window.help();
        hands(
            "search --onlyvisible --name '^builtin:slanted-wall - binosplat$' windowsize --sync %1 900 600");
        window.help();
        hands("key Tab");
        REQUIRE(window.program().waitFor("panel = false") != "");
        window.rest();
        Image screen = desk().screen.picture();
        left.push_back(partOf(screen, {0, 0}, {450, 600}));
        right.push_back(partOf(screen, {450, 0}, {900, 600}));
        window.checkEnd();
    }
    CHECK(compare(left[0], right[1]).psnrDb() > 35.0);
    CHECK(compare(right[0], left[1]).psnrDb() > 35.0);
    CHECK(compare(left[0], right[0]).psnrDb() < 30.0);
}

TEST_CASE(
    "a runtime that hangs keeps no window from opening; what is dropped on one that nobody sees is drawn "
    "once somebody does") {
    if (!haveScreen()) { return; }
    const Workplace work;
    work.go("scene one-splat --out one.ply");
    Window window(
        work, "--hide-panel",
        "XR_ENABLE_API_LAYERS=XR_APILAYER_BINOSPLAT_faults XR_API_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
        "/openxr' BINOSPLAT_XR_FAULT=xrCreateInstance:hang XR_RUNTIME_JSON='" BINOSPLAT_BUILD
        "/bin/simulated_runtime.json' ");
    CHECK(window.program().said().find(
              "the scene is shown in a window; no headset: the OpenXR runtime does not answer\n") !=
          std::string::npos);
    window.rest();
    const unsigned long number = numberOfWindow("^builtin:slanted-wall - binosplat$", "WINDOW");
    desk().connection.minimize(number, true);
    const std::uint64_t before = window.help();
    desk().connection.drop(number, {work.path / "one.ply"});
    REQUIRE(window.program().waitFor("one.ply") != "");
    CHECK(window.help() == before);
    desk().connection.minimize(number, false);
    window.rest();
    CHECK(window.help() > before);
    window.checkEnd();
}

TEST_CASE(
    "two ends and a number give the scene its true size; a viewpoint gets a name and a tour; what is set on "
    "the panel is so the next "
    "time") {
    if (!haveScreen()) { return; }
    const Workplace work;
    const fs::path kept = work.base / "config" / "binosplat";
    const glm::dvec2 one(200.0, 300.0), other(500.0, 360.0);
    {
        Window window(work, "--desktop");
        const glm::dvec3 from = window.seenAt(one), to = window.seenAt(other);
        window.click("True size", PanelPage::kView);
        window.waitFor("click on one end");
        hands(moveTo(one) + "click 1");
        window.waitFor("and now on its other end");
        hands(moveTo(other) + "click 1");
        window.waitFor("as shown, it is ");
        hands("key 2 period 5 9 BackSpace Return");
        window.waitFor("saved as ");
        const std::string text = textIn(kept / "scenes" / "slanted-wall.view.toml"),
                          key = "metres-per-unit = ";
        REQUIRE(text.find(key) != std::string::npos);
        CHECK(std::stod(text.substr(text.find(key) + key.size())) ==
              doctest::Approx(2.5 / glm::distance(from, to)).epsilon(0.01));

        window.click("Both eyes", PanelPage::kView);
        window.waitFor("picture-both-eyes = true");
        window.rest();
        CHECK(readPicture(window.picture()).size_px == glm::uvec2(2 * 743, 720));

        window.click("Scenes", PanelPage::kView);
        window.waitFor("panel-page");
        for (const char* number : {"1", "2"}) {
            window.click("Keep this one", PanelPage::kScenes);
            window.waitFor("this viewpoint is kept");
            CHECK(textIn(kept / "scenes" / "slanted-wall.viewpoints.json")
                      .find("your own " + std::string(number)) != std::string::npos);
        }
        window.click("Name", PanelPage::kScenes);
        hands("key --repeat 12 BackSpace");
        hands("type door");
        hands("key Return");
        window.waitFor("this viewpoint is called door");
        window.click("Tour", PanelPage::kScenes);
        window.waitFor("viewpoint 1 of 2: your own 1");
        window.waitFor("viewpoint 2 of 2: door");
        window.waitFor("the tour is over");
        window.checkEnd();
    }
    CHECK(textIn(kept / "preferences.toml").find("\n[view]\npicture-both-eyes = true\n") !=
          std::string::npos);
    Window window(work, "--desktop --hide-panel");
    window.rest();
    CHECK(readPicture(window.picture()).size_px == glm::uvec2(2560, 720));
    hands("key 2");
    window.waitFor("viewpoint 2 of 2: door");
    window.checkEnd();
}

TEST_CASE(
    "two scenes are left and right of a curtain that can be dragged; a held key shows the other one whole, "
    "and in pictures; two that are "
    "dropped are compared") {
    if (!haveScreen()) { return; }
    const Workplace work;
    work.go("scene one-splat --out one.ply");
    work.go("scene fence --out fence.ply");
    const std::string view = " --eye 0,0,-1 --look 0,0,3 --up 0,-1,0";
    const std::string drawing = view + " --mode mono --order distance --size 1280x720 --fov-x 60 --out ";
    const auto draw = [&](const std::string& scene, const std::string& name) {
        work.go("render " + scene + drawing + name);
        return readPicture(work.path / name / "mono.png");
    };
    const Image wall = draw("builtin:slanted-wall", "wall"), fence = draw("fence.ply", "fence");
    REQUIRE(compare(wall, fence).psnrDb() < 25.0);
    Window window(work, "--desktop --hide-panel --compare fence.ply" + view);
    window.waitFor("compares builtin:slanted-wall with fence.ply");
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
    window.waitFor("the curtain hangs at 25 %");
    window.rest();
    check(wall, 0, 314);
    check(fence, 326, 1280);
    hands("keydown c");
    window.waitFor("shows fence.ply");
    window.rest();
    check(fence, 0, 1280);
    CHECK(compare(readPicture(window.picture()), fence).psnrDb() > 45.0);
    hands("keyup c");
    window.waitFor("the curtain is back");
    window.rest();
    check(wall, 0, 314);

    const unsigned long number = numberOfWindow("^builtin:slanted-wall . fence.ply - binosplat$", "WINDOW");
    desk().connection.drop(number, {work.path / "one.ply", work.path / "fence.ply"});
    window.waitFor("compares " + (work.path / "one.ply").string() + " with " +
                   (work.path / "fence.ply").string());
    // A comparison ends when another scene replaces the first.
    desk().connection.drop(number, {work.path / "one.ply"});
    window.waitFor("shows " + (work.path / "one.ply").string());
    CHECK(numberOfWindow("one.ply - binosplat$", "WINDOW") == number);
    window.checkEnd();
}

}  // SUITE(view_desktop)
