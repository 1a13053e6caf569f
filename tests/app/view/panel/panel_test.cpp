// Facts about the panel's pages: what can be pointed at, whatever they show.
#include "app/options/option_table.h"
#include "app/view/panel/first_steps.h"
#include "app/view/panel/message_picture.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_clock.h"
#include "app/view/settings/view_settings_table.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/run_program.h"

#include <imgui_internal.h>

SUITE(panel) {

using Page = PanelPage;
constexpr std::array kPages{Page::kView, Page::kScenes, Page::kMethod, Page::kTime, Page::kHelp};

TEST_CASE(
    "on each page every widget lies on the panel, none on another, 1.5 degrees high at least, and what is "
    "used most twice that") {
    const double half_px = 0.5 * 1.5 * kPanelPx.x / 26.0;
    for (const bool all : {false, true}) {
        PanelSketch sketch;
        sketch.status.can_reload_shaders = sketch.status.can_pass_through = all;
        sketch.status.compares = true;
        if (all) { sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0, 144.0}; }
        if (all) { sketch.status.time = ShownTime{11, 60, 30.0, true, 3}; }
        const auto hoveredAt = [&](glm::dvec2 place, double down_px) {
            place.y += down_px;
            sketch.draw(&place);
            return ImGui::GetCurrentContext()->HoveredId;
        };
        for (const Page page : kPages) {
            sketch.settings.page = page;
            sketch.chooser.showFolder(kBuiltinFolder);
            const WidgetPlaces places = sketch.draw().places;
            CHECK(places.size() >= 4);
            for (const auto& [name, place] : places) {
                CAPTURE(name);
                CHECK(glm::all(glm::greaterThan(place, glm::dvec2(0.0))));
                CHECK(glm::all(glm::lessThan(place, glm::dvec2(kPanelPx))));
                for (const auto& [other, there] : places) {
                    if (name < other) { CHECK_MESSAGE(glm::length(place - there) > 20.0, other); }
                }
                const ImGuiID id = hoveredAt(place, 0.0);
                CHECK((id != 0 || name == "Up"));  // the top has nothing above it
                const std::array large{"Sharp", "Balanced",  "Fast",  "Recentre", "Level",
                                       "Reset", "Step back", "Pause", "Step on"};
                const double reach_px = 0.97 * half_px * (std::ranges::count(large, name) != 0 ? 2.0 : 1.0);
                for (const double down_px : {-reach_px, reach_px}) { CHECK(hoveredAt(place, down_px) == id); }
            }
        }
    }
}

TEST_CASE_FIXTURE(PanelSketch, "a click reaches what it points at: boxes, buttons, sliders and pages") {
    const auto asks = [&](const char* name, auto request) { return click(name).*request; };
    using Asked = PanelRequests;
    const std::vector<std::pair<const char*, bool Asked::*>> common{
        {"Save", &Asked::save}, {"Load", &Asked::load}, {"Quit", &Asked::quit}};
    click("Method");
    CHECK(settings.page == Page::kMethod);
    CHECK(click("paper").places.contains("Centre ROI (paper)"));
    CHECK(settings.stereo.mode == Mode::kPaper);
    click("Centre ROI (paper)");
    CHECK(settings.stereo.warp.center_rois);
    CHECK(settings.stereo.foveation_deg == 0.0);
    click("Foveation");
    CHECK(settings.stereo.foveation_deg > 0.0);
    click("Foveation");
    CHECK(settings.stereo.foveation_deg == 0.0);
    click("Axes stay");
    CHECK(settings.stereo.axes == Axes::kStay);
    click("budget");
    CHECK(settings.stereo.warp.budget == doctest::Approx(0.5).epsilon(0.02));
    for (const auto& [name, request] : common) { CHECK_MESSAGE(asks(name, request), name); }
    click("View");
    CHECK(settings.page == Page::kView);
    for (const auto& [name, request] : common) { CHECK_MESSAGE(asks(name, request), name); }
    for (const auto& [name, request] :
         std::vector<std::pair<const char*, bool Asked::*>>{{"Level", &Asked::level_scene},
                                                            {"Recentre", &Asked::recentre},
                                                            {"Reset", &Asked::reset_scene},
                                                            {"1:1", &Asked::natural_size},
                                                            {"True size", &Asked::measure},
                                                            {"Picture", &Asked::take_picture}}) {
        CHECK_MESSAGE(asks(name, request), name);
    }
    click("Scenes");
    CHECK(settings.page == Page::kScenes);
    CHECK(asks("Quit", &Asked::quit));
    CHECK(asks("Next scene", &Asked::scene_step) == 1);
    CHECK(asks("Previous scene", &Asked::scene_step) == -1);
    CHECK(asks("Last shown", &Asked::last_scene));
    CHECK(asks("Next viewpoint", &Asked::viewpoint_step) == 1);
    CHECK(asks("Previous viewpoint", &Asked::viewpoint_step) == -1);
    for (const auto& [name, request] :
         std::vector<std::pair<const char*, bool Asked::*>>{{"Keep this one", &Asked::keep_viewpoint},
                                                            {"Tour", &Asked::tour},
                                                            {"Name", &Asked::rename_viewpoint},
                                                            {"Forget", &Asked::forget_viewpoint},
                                                            {"Export", &Asked::share_viewpoints},
                                                            {"Import", &Asked::read_viewpoints}}) {
        CHECK_MESSAGE(asks(name, request), name);
    }
    CHECK(these(asks("Earlier", &Asked::viewpoint_move), asks("Later", &Asked::viewpoint_move)) ==
          these(-1, 1));
    click("Help");
    CHECK(settings.page == Page::kHelp);
    CHECK(asks("Leave", &Asked::quit));
    status.window.emplace();  // in the window, H lists the keys
    draw();
    CHECK(settings.page == Page::kView);
}

TEST_CASE_FIXTURE(PanelSketch,
                  "what the panel asks for is written with its keys or a keyboard, in place of its page") {
    using What = TextEntry::What;
    TextEntry entry;
    status.entry = &entry;
    CHECK(draw().places.contains("Recentre"));
    entry.open(What::kViewpointName, "The viewpoint's name", "my");
    CHECK_FALSE(draw().places.contains("Recentre"));
    for (const char* key : {"Space", "d", "Capitals", "O", "Capitals", "o", "x", "Erase"}) { click(key); }
    CHECK(entry.text() == "my dOo");
    entry.type("\u00e4");
    CHECK(entry.text() == "my dOo\u00e4");
    entry.eraseLast();
    CHECK(entry.text() == "my dOo");
    entry.type("r");
    CHECK(click("Done").entered == std::pair(What::kViewpointName, std::string("my dOor")));
    CHECK_FALSE(entry.isOpen());
    CHECK(draw().places.contains("Recentre"));
    entry.open(What::kMetres, "How long?", "");
    for (const char* key : {"2", ".", "5"}) { click(key); }
    CHECK_FALSE(draw().places.contains("q"));
    entry.confirm();
    CHECK(draw().entered == std::pair(What::kMetres, std::string("2.5")));
    entry.open(What::kMetres, "How long?", "3");
    CHECK_FALSE(click("Cancel").entered.has_value());
    CHECK_FALSE(entry.isOpen());
    // The text has a maximum length.
    entry.open(What::kViewpointName, "", "");
    for (int i = 0; i < 100; ++i) { entry.type("ab"); }
    CHECK(entry.text().size() == 60);
}

TEST_CASE_FIXTURE(
    PanelSketch,
    "a message is white letters on a dark plate, in two lines if it is long; beside it nothing is seen") {
    draw();
    const auto rowsWith = [](const TexelPicture& picture) {
        std::set<std::size_t> rows;
        for (std::size_t i = 0; i < picture.texels.size(); ++i) {
            if ((picture.texels[i] & 0xff) > 200) { rows.insert(i / kMessagePx.x); }
        }
        return rows;
    };
    const TexelPicture line = drawMessage("one line", {false, false}),
                       two = drawMessage(std::string(200, 'w') + " and more", {false, false});
    REQUIRE(line.texels.size() == std::size_t{kMessagePx.x} * kMessagePx.y);
    CHECK(line.texels[0] == 0);
    CHECK((line.texels[line.texels.size() / 2 + 10] >> 24) == 0);  // at the left, in the middle
    CHECK(rowsWith(line).size() > 12);
    CHECK(rowsWith(line).size() < 30);
    CHECK(rowsWith(two).size() > rowsWith(line).size());
}

TEST_CASE_FIXTURE(PanelSketch, "each first gesture is a drawing of its own, at the left of white words") {
    draw();
    std::set<std::vector<std::uint32_t>> drawings;
    for (std::size_t gesture = 0; gesture < kGestures; ++gesture) {
        CAPTURE(gesture);
        const TexelPicture picture = drawGesture(gesture, {false, true});
        std::size_t first_yellow = kMessagePx.x, first_white = kMessagePx.x;
        std::vector<std::uint32_t> yellow;
        for (std::size_t i = 0; i < picture.texels.size(); ++i) {
            const std::uint32_t red = picture.texels[i] & 0xff, blue = picture.texels[i] >> 16 & 0xff;
            if (red > 240 && blue < 60) {
                first_yellow = std::min(first_yellow, i % kMessagePx.x);
                yellow.push_back(static_cast<std::uint32_t>(i));
            }
            if (red > 240 && blue > 240) { first_white = std::min(first_white, i % kMessagePx.x); }
        }
        CHECK(first_yellow + 20 < first_white);
        CHECK(first_white < kMessagePx.x / 2);
        CHECK(yellow.size() > 20);
        drawings.insert(yellow);
    }
    CHECK(drawings.size() == kGestures);
}

TEST_CASE("inputs have the names that people call them") {
    CHECK(xr::inputName("input/thumbstick") == "stick");
    CHECK(xr::inputName("input/y/click") == "Y");
    CHECK(xr::inputName("input/squeeze/force") == "squeeze");
    CHECK(xr::inputName("input/select/click") == "select");
    CHECK(xr::inputName("input/select/value") == "pinch");
    CHECK(xr::inputName("input/cluster_back_logitech/click") == "back button");
}

TEST_CASE_FIXTURE(PanelSketch, "the help page draws what the hands hold: no stick for what has none") {
    click("Help");
    const auto verticesWith = [&](const char* path) {
        for (const xr::ProfileBindings& profile : xr::allProfileBindings()) {
            if (std::string_view(profile.path) == path) { status.held = {&profile, &profile}; }
        }
        draw();
        return ImGui::GetDrawData()->TotalVtxCount;
    };
    const int simple = verticesWith("khr/simple_controller"), touch = verticesWith("oculus/touch_controller");
    CHECK(simple < touch);
    status.held = {};  // the default: what most people have
    draw();
    CHECK(ImGui::GetDrawData()->TotalVtxCount == touch);
}

TEST_CASE_FIXTURE(PanelSketch,
                  "a comparison is asked for and ended on the pages Scenes and View; only during it is there "
                  "another scene to keep in sight") {
    settings.page = PanelPage::kScenes;
    CHECK(click("Compare").compare);
    CHECK_FALSE(click("Other").show_other);
    status.compares = true;
    CHECK(click("Other").show_other);
    CHECK(click("Compare").compare);
    settings.page = PanelPage::kView;
    status.window.emplace();
    CHECK(click("Compare").compare);
}

TEST_CASE_FIXTURE(
    PanelSketch,
    "a scene that moves has a page of its own, with what lets it rest, step, and go to a frame") {
    CHECK_FALSE(draw().places.contains("Time"));
    status.time = ShownTime{11, 60, 30.0, true, 0};
    click("Time");
    CHECK(settings.page == Page::kTime);
    CHECK(click("Pause").play);
    status.time->plays = false;
    CHECK(click("Play").play);
    CHECK(click("Step on").frame_step == 1);
    CHECK(click("Step back").frame_step == -1);
    // The handle moves from one end of the line to the other.
    glm::dvec2 place = draw().places.at("frame");
    place.x = 0.5 * kPanelPx.x;
    draw(&place);
    const std::optional<std::size_t> middle = draw(&place, true).frame;
    REQUIRE(middle.has_value());
    CHECK(std::abs(static_cast<int>(*middle) - 29) <= 1);
    place.x = kPanelPx.x - 1.0;
    CHECK(draw(&place, true).frame == 59);
    draw(&place);
    // The next scene does not move.
    status.time.reset();
    draw();
    CHECK(settings.page == Page::kView);
}

TEST_CASE("the time of a scene that moves goes on while it plays, rests, steps around, and goes to a frame") {
    SceneClock clock(10.0, 5);
    CHECK(clock.frame() == 0);
    for (int i = 0; i < 7; ++i) { clock.pass(0.1); }
    CHECK(these(clock.time_s(), clock.frame()) == these(doctest::Approx(0.7), 2));
    clock.togglePlaying();
    clock.pass(10.0);
    CHECK(clock.frame() == 2);
    for (const auto& [step, frame] : {std::pair(1, 3u), std::pair(2, 0u), std::pair(-1, 4u)}) {
        clock.step(step);
        CHECK(clock.frame() == frame);
    }
    CHECK_FALSE(clock.plays());
    clock.togglePlaying();
    clock.goTo(1);
    clock.pass(0.1);
    CHECK(clock.frame() == 2);
    clock.goTo(99);
    CHECK(clock.frame() == 4);
    clock.step(1);
    CHECK_FALSE(clock.plays());
}

TEST_CASE_FIXTURE(PanelSketch,
                  "a picture of a scene lies in the font's texture as it is, and letters stay there") {
    ScenePicture picture{"red", "a.png", {}};
    for (std::size_t i = 0; i < std::size_t{kScenePicturePx.x} * kScenePicturePx.y; ++i) {
        picture.rgba.insert(picture.rgba.end(), {200, 10, 20, 255});
    }
    CHECK(bringLetters("", {picture}));
    CHECK_FALSE(bringLetters("", {picture}));
    REQUIRE(font->pictures().contains("red"));
    const PictureCorners& corners = font->pictures().at("red");
    const FontTexture texture = fontTexture();
    const auto inTexels = [&](const auto& at) {
        return glm::dvec2(at.x, at.y) * glm::dvec2(texture.size_px);
    };
    const glm::dvec2 low = inTexels(corners.low), high = inTexels(corners.high);
    CHECK(glm::uvec2(glm::round(high - low)) == kScenePicturePx);
    CHECK(texture.at(glm::uvec2(0.5 * (low + high))) == std::array<unsigned char, 4>{200, 10, 20, 255});
    CHECK(isThere('A'));
    draw();
    // A later picture of the same scene replaces it; pictures of other scenes stay.
    ScenePicture other = picture, later = picture;
    other.key = "other";
    other.file = "b.png";
    later.key = "later";
    CHECK(bringLetters("", {other}));
    CHECK(bringLetters("", {later}));
    CHECK(these(font->pictures().size(), font->pictures().contains("later"),
                font->pictures().contains("other")) == these(2, true, true));
}

TEST_CASE(
    "size and height are changed while their buttons are held, and what moves and what is behind is chosen "
    "by name") {
    PanelSketch sketch;
    const auto held = [&](const char* name) {
        const glm::dvec2 place = sketch.draw().places.at(name);
        int times = 0;
        double growth = 1.0, rise_m = 0.0;
        sketch.draw(&place);
        for (int frame = 0; frame < 100; ++frame) {
            const PanelRequests requests = sketch.draw(&place, true);
            times += requests.growth != 1.0 || requests.rise_m != 0.0;
            growth *= requests.growth;
            rise_m += requests.rise_m;
        }
        sketch.draw(&place);
        sketch.draw();
        CHECK(times > 5);  // times a second
        return std::pair(growth, rise_m);
    };
    CHECK(held("Smaller").first < 0.4);
    CHECK(held("Larger").first > 2.5);
    CHECK(held("Higher").second > 0.4);
    CHECK(held("Lower").second < -0.4);
    sketch.click("Teleport");
    CHECK(sketch.settings.teleport);
    sketch.click("Walk");
    CHECK_FALSE(sketch.settings.teleport);
    sketch.click("Turn smoothly");
    CHECK(sketch.settings.smooth_turn);
    sketch.click("Grey");
    CHECK(sketch.settings.backdrop == Backdrop::kGrey);
    // A second click on the chosen quality leaves the settings as the page of methods has them.
    for (const auto& [name, quality] :
         {std::pair("Sharp", Quality::kSharp), std::pair("Fast", Quality::kFast),
          std::pair("Fast", Quality::kOff)}) {
        sketch.click(name);
        CHECK(sketch.settings.quality == quality);
    }
}

TEST_CASE_FIXTURE(PanelSketch, "the panel has the names and ranges of the table of options") {
    settings.page = Page::kMethod;
    const auto isChosen = [&](const auto& row, const auto& owner, std::string_view name) {
        return textOf(row.field.value(owner)) == name;
    };
    for (const char* key : {"mode", "dominant", "depth"}) {
        const OptionRow<RunOptions>& row = *findRunRow(key);
        CHECK(row.field.choices.size() >= 2);
        for (const std::string_view name : row.field.choices) {
            click(std::string(name));
            RunOptions options;
            options.stereo = settings.stereo;
            CHECK_MESSAGE(isChosen(row, options, name), name);
        }
    }
    const OptionRow<ViewSettings>& quality = *findViewRow("quality");
    for (const std::string_view name : quality.field.choices) {
        click(std::string(name));
        CHECK_MESSAGE(isChosen(quality, settings, name), name);
    }
    const auto slideAllTo = [&](double to_px) {
        for (const char* name : {"margin (paper)", "budget", "resolution"}) {
            glm::dvec2 place = draw().places.at(name);
            draw(&place);
            draw(&place, true);
            place.x = to_px;
            draw(&place, true);
            draw(&place);
        }
        return std::tuple(settings.stereo.warp.margin_px, settings.stereo.warp.budget,
                          settings.resolution_scale);
    };
    const OptionField<ViewSettings>& scale = findViewRow("resolution-scale")->field;
    CHECK(slideAllTo(0.0) == std::tuple(0u, 0.0, *scale.least));
    CHECK(slideAllTo(kPanelPx.x) == std::tuple(128u, 1.0, *scale.most));
}

TEST_CASE(
    "scenes are looked for by clicks: down, up, to other places, page by page, and what cannot be read does "
    "nothing") {
    const Workplace work;
    const std::string here = work.path.string(), inner = here + "/inner", scene = here + "/a##b.ply";
    fs::create_directories(inner);
    for (int i = 0; i < 12; ++i) { work.write(fmt::format("inner/room{}.ply", i), "x"); }
    work.write("a##b.ply", "x");
    fs::create_symlink("nowhere", work.path / "gone.ply");
    setenv("XDG_CONFIG_HOME", (work.base / "config").c_str(), 1);
    PanelSketch sketch;
    sketch.status.scene = scene;
    const auto chosen = [&](const char* name) { return sketch.click(name).chosen_scene; };
    const auto titleAfter = [&](const char* name) {
        CHECK(chosen(name).empty());
        return sketch.chooser.list().title;
    };
    CHECK(titleAfter("Scenes") == here);  // the folder of the scene that is shown
    CHECK(chosen("gone.ply").empty());
    CHECK(chosen("a##b.ply") == scene);
    CHECK(titleAfter("inner/") == inner);
    CHECK(sketch.chooser.pageCount() == 2);
    CHECK_FALSE(sketch.draw().places.contains("room11.ply"));
    sketch.click(">");
    sketch.click(">");
    CHECK(sketch.chooser.page() == 1);
    CHECK(chosen("room11.ply") == inner + "/room11.ply");
    sketch.click("<");
    CHECK(chosen("room0.ply") == inner + "/room0.ply");
    CHECK(titleAfter("Up") == here);
    sketch.click("Built-in");
    CHECK(chosen("step-edge") == "builtin:step-edge");
    CHECK(titleAfter("Up") == "Built-in scenes");  // the top has nothing above it
    sketch.click("Recent");
    CHECK(sketch.chooser.list().entries.empty());
    rememberScene(scene);
    sketch.click("Recent");
    CHECK(chosen("a##b.ply") == scene);
    const std::string home = environment("HOME");
    setenv("HOME", work.base.c_str(), 1);
    CHECK(titleAfter("Home") == work.base.string());
    setenv("HOME", home.c_str(), 1);
    // A file that was added in the meantime appears when the page is opened again.
    sketch.chooser.showFolder(here);
    work.write("new.ply", "x");
    sketch.click("Scenes");
    CHECK(sketch.draw().places.contains("new.ply"));
    unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE(
    "no folder is read while the panel is drawn: it says that it reads until a list is there, and an "
    "outdated one is not shown") {
    const Workplace work;
    fs::create_directory(work.path / "inner");
    work.write("inner/a.ply", "x");
    PanelSketch sketch;
    sketch.settings.page = Page::kScenes;
    SceneChooser& chooser = sketch.chooser;
    chooser.showFolder(work.path.string());
    const std::optional<SceneListWish> first = chooser.takeWish();
    REQUIRE(first.has_value());
    CHECK_FALSE(chooser.takeWish().has_value());
    CHECK(these(chooser.isReading(), chooser.list().title, chooser.list().entries.empty()) ==
          these(true, work.path.string(), true));
    const WidgetPlaces quiet = sketch.draw().places;
    const auto drawnVertices = [] { return ImGui::GetDrawData()->TotalVtxCount; };
    const int without = drawnVertices();
    sketch.status.files = std::string("reading ") + first->name();
    CHECK(sketch.draw().places == quiet);
    CHECK(drawnVertices() > without);
    // Someone who moves on before the first list arrives sees only the second.
    chooser.showFolder((work.path / "inner").string());
    const std::optional<SceneListWish> second = chooser.takeWish();
    REQUIRE(second.has_value());
    chooser.show(makeSceneList(*first), *first);
    CHECK(chooser.list().entries.empty());
    chooser.show(makeSceneList(*second), *second);
    CHECK_FALSE(chooser.isReading());
    CHECK(sketch.draw().places.contains("a.ply"));
    // When a folder is read again, its list stays until the new one arrives.
    chooser.refresh("");
    CHECK(chooser.isReading());
    CHECK(chooser.list().entries.size() == 1);
    // Letters are read and drawn elsewhere, too: a second request waits for the first.
    CHECK(sketch.font->want("\xd7\x90"));
    CHECK_FALSE(sketch.font->want("\xe1\x83\x90"));
    CHECK_FALSE(isThere(0x5d0));
    sketch.font->build();
    CHECK_FALSE(isThere(0x5d0));
    sketch.font->take();
    CHECK(isThere(0x5d0));
    CHECK(sketch.bringLetters("\xe1\x83\x90"));
    sketch.draw();
}

TEST_CASE_FIXTURE(
    AtWork,
    "names of any bytes and of any length are shown, and a long message is wrapped within the panel") {
    const std::string longest = std::string(240, 'w') + ".ply";
    for (const std::string& name :
         {std::string("\xce\xa9\xd0\x96\xc3\xa4.ply"), std::string("line\nbreak.ply"),
          std::string("%s%n.ply"), std::string("\xff\xfe.ply"), longest}) {
        work.write(name, "x");
    }
    PanelSketch sketch;
    sketch.settings.page = Page::kScenes;
    sketch.chooser.showFolder(work.path.string());
    CHECK(sketch.draw().places.size() == 26 + 2 * 5);
    CHECK(sketch.click(longest).chosen_scene == (work.path / longest).string());
    CHECK(asShown("a\nb\x1b[1m\x7f") ==
          "a\xef\xbf\xbd"
          "b\xef\xbf\xbd[1m\xef\xbf\xbd");
    // Messages move nothing that can be pointed at.
    for (const Page page : {Page::kView, Page::kScenes, Page::kMethod}) {
        sketch.settings.page = page;
        sketch.status.message.clear();
        const WidgetPlaces before = sketch.draw().places;
        for (int i = 0; i < 40; ++i) { sketch.status.message += "/a/long/way/to/a/file "; }
        sketch.status.message += longest;
        CHECK(sketch.draw().places == before);
    }
}

TEST_CASE_FIXTURE(
    PanelSketch,
    "the rates that the headset offers can be chosen, and left to it; where it offers none there is no row") {
    CHECK_FALSE(draw().places.contains("Automatic"));
    status.refresh_rates = {72.0, 89.9988, 144.0};
    settings.refresh_rate = 72.0;
    for (const auto& [name, rate] :
         {std::pair("90 Hz", 89.9988), std::pair("144 Hz", 144.0), std::pair("Automatic", 0.0)}) {
        click(name);
        CHECK(settings.refresh_rate == rate);
    }
    // Everything above stays in place.
    const WidgetPlaces with = draw().places;
    status.refresh_rates.clear();
    for (const auto& [name, place] : draw().places) { CHECK(with.at(name) == place); }
}

}  // SUITE(panel)
