// Facts about the panel's pages: what can be pointed at, whatever stands on them.
#include "app/options/option_table.h"
#include "app/view/panel/shown_text.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_clock.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

TEST_SUITE_BEGIN("panel");

namespace panel_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

using Page = PanelPage;

void write(const fs::path& path, const std::string& text = "x") { std::ofstream(path, std::ios::binary) << text; }

}  // namespace

TEST_CASE("every widget lies on the panel, none on another, on each page") {
    for (const bool shaders : {false, true}) {
        PanelSketch sketch;
        sketch.status.can_reload_shaders = sketch.status.can_pass_through = shaders;
        if (shaders) { sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0, 144.0}; }
        if (shaders) { sketch.status.time = ShownTime{11, 60, 30.0, true, 3}; }
        for (const Page page : {Page::kView, Page::kScenes, Page::kMethod, Page::kTime}) {
            sketch.settings.page = page;
            sketch.chooser.showFolder(kBuiltinFolder);
            const WidgetPlaces places = sketch.draw().places;
            CHECK(places.size() >= 4);
            for (const auto& [name, place] : places) {
                CAPTURE(name);
                CHECK(place.x > 0.0);
                CHECK(place.y > 0.0);
                CHECK(place.x < kPanelPx.x);
                CHECK(place.y < kPanelPx.y);
                for (const auto& [other, there] : places) {
                    if (name < other) { CHECK_MESSAGE(glm::length(place - there) > 20.0, other); }
                }
            }
        }
    }
}

TEST_CASE("what one points at is 1.5 degrees high at least, and what is used most twice that") {
    PanelSketch sketch;
    const double half_px = 0.5 * 1.5 * kPanelPx.x / 26.0;
    const auto hoveredAt = [&](glm::dvec2 place, double down_px) {
        place.y += down_px;
        sketch.draw(&place);
        return ImGui::GetCurrentContext()->HoveredId;
    };
    sketch.status.time = ShownTime{};
    for (const Page page : {Page::kView, Page::kScenes, Page::kMethod, Page::kTime}) {
        sketch.settings.page = page;
        sketch.chooser.showFolder(kBuiltinFolder);
        const WidgetPlaces places = sketch.draw().places;
        for (const auto& [name, place] : places) {
            const ImGuiID id = hoveredAt(place, 0.0);
            CAPTURE(name);
            CHECK((id != 0 || name == "Up"));  // there is none above
            const bool is_large =
                std::ranges::count(std::array{"Sharp", "Balanced", "Fast", "Recentre", "Level", "Reset", "Step back", "Pause", "Step on"},
                                   name) != 0;
            for (const double side : {-0.97, 0.97}) { CHECK(hoveredAt(place, side * half_px * (is_large ? 2.0 : 1.0)) == id); }
        }
    }
}

TEST_CASE("a click reaches what it points at: boxes, buttons, sliders and pages") {
    PanelSketch sketch;
    sketch.click("Method");
    CHECK(sketch.settings.page == Page::kMethod);
    CHECK(sketch.click("paper").places.contains("Centre ROI (paper)"));
    CHECK(sketch.settings.stereo.mode == Mode::kPaper);
    sketch.click("Centre ROI (paper)");
    CHECK(sketch.settings.stereo.warp.center_rois);
    CHECK(sketch.settings.stereo.foveation_deg == 0.0);
    sketch.click("Foveation");
    CHECK(sketch.settings.stereo.foveation_deg > 0.0);
    sketch.click("Foveation");
    CHECK(sketch.settings.stereo.foveation_deg == 0.0);
    sketch.click("budget");
    CHECK(sketch.settings.stereo.warp.budget == doctest::Approx(0.5).epsilon(0.02));
    CHECK(sketch.click("Save").save);
    CHECK(sketch.click("Load").load);
    CHECK(sketch.click("Quit").quit);
    sketch.click("View");
    CHECK(sketch.settings.page == Page::kView);
    CHECK(sketch.click("Quit").quit);
    CHECK(sketch.click("Save").save);
    CHECK(sketch.click("Load").load);
    CHECK(sketch.click("Level").level_scene);
    CHECK(sketch.click("Recentre").recentre);
    CHECK(sketch.click("Reset").reset_scene);
    CHECK(sketch.click("Picture").take_picture);
    sketch.click("Scenes");
    CHECK(sketch.settings.page == Page::kScenes);
    CHECK(sketch.click("Quit").quit);
    CHECK(sketch.click("Next scene").scene_step == 1);
    CHECK(sketch.click("Previous scene").scene_step == -1);
    CHECK(sketch.click("Last shown").last_scene);
    CHECK(sketch.click("Next viewpoint").viewpoint_step == 1);
    CHECK(sketch.click("Previous viewpoint").viewpoint_step == -1);
    CHECK(sketch.click("Keep this one").keep_viewpoint);
}

TEST_CASE("a scene that moves has a page of its own, with what lets it rest, step, and go to a frame") {
    PanelSketch sketch;
    CHECK_FALSE(sketch.draw().places.contains("Time"));
    sketch.status.time = ShownTime{11, 60, 30.0, true, 0};
    sketch.click("Time");
    CHECK(sketch.settings.page == Page::kTime);
    CHECK(sketch.click("Pause").play);
    sketch.status.time->plays = false;
    CHECK(sketch.click("Play").play);
    CHECK(sketch.click("Step on").frame_step == 1);
    CHECK(sketch.click("Step back").frame_step == -1);
    // The handle's ends are those of the line.
    glm::dvec2 place = sketch.draw().places.at("frame");
    place.x = 0.5 * kPanelPx.x;
    sketch.draw(&place);
    const std::optional<std::size_t> middle = sketch.draw(&place, true).frame;
    REQUIRE(middle.has_value());
    CHECK(std::abs(static_cast<int>(*middle) - 29) <= 1);
    place.x = kPanelPx.x - 1.0;
    CHECK(sketch.draw(&place, true).frame == 59);
    sketch.draw(&place);
    // The next scene stays as it is.
    sketch.status.time.reset();
    sketch.draw();
    CHECK(sketch.settings.page == Page::kView);
}

TEST_CASE("the time of a scene that moves goes on while it plays, rests, steps around, and goes to a frame") {
    SceneClock clock(10.0, 5);
    CHECK(clock.frame() == 0);
    for (int i = 0; i < 7; ++i) { clock.pass(0.1); }
    CHECK(clock.time_s() == doctest::Approx(0.7));
    CHECK(clock.frame() == 2);
    clock.togglePlaying();
    clock.pass(10.0);
    CHECK(clock.frame() == 2);
    clock.step(1);
    CHECK(clock.frame() == 3);
    clock.step(2);
    CHECK(clock.frame() == 0);
    clock.step(-1);
    CHECK(clock.frame() == 4);
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

TEST_CASE("a picture of a scene lies in the font's texture as it is, and letters stay there") {
    PanelSketch sketch;
    ScenePicture picture{"red", "a.png", {}};
    for (std::size_t i = 0; i < std::size_t{kScenePicturePx.x} * kScenePicturePx.y; ++i) {
        picture.rgba.insert(picture.rgba.end(), {200, 10, 20, 255});
    }
    CHECK(sketch.bringLetters("", {picture}));
    CHECK_FALSE(sketch.bringLetters("", {picture}));
    REQUIRE(sketch.font->pictures().contains("red"));
    const PictureCorners& corners = sketch.font->pictures().at("red");
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    CHECK(std::lround((corners.high.x - corners.low.x) * static_cast<float>(width)) == kScenePicturePx.x);
    CHECK(std::lround((corners.high.y - corners.low.y) * static_cast<float>(height)) == kScenePicturePx.y);
    const auto x = static_cast<std::size_t>(0.5f * (corners.low.x + corners.high.x) * static_cast<float>(width)),
               y = static_cast<std::size_t>(0.5f * (corners.low.y + corners.high.y) * static_cast<float>(height));
    const unsigned char* const middle = pixels + 4 * (y * static_cast<std::size_t>(width) + x);
    CHECK(std::array{middle[0], middle[1], middle[2], middle[3]} == std::array<unsigned char, 4>{200, 10, 20, 255});
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback('A') != nullptr);
    sketch.draw();
    // A later picture of the same scene takes its place; those of others stay.
    ScenePicture other = picture, later = picture;
    other.key = "other";
    other.file = "b.png";
    later.key = "later";
    CHECK(sketch.bringLetters("", {other}));
    CHECK(sketch.bringLetters("", {later}));
    CHECK(sketch.font->pictures().size() == 2);
    CHECK(sketch.font->pictures().contains("later"));
    CHECK(sketch.font->pictures().contains("other"));
}

TEST_CASE("size and height are changed while their buttons are held, and what moves and what is behind is chosen by name") {
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
        CHECK(times > 5);  // of a second
        return std::pair(growth, rise_m);
    };
    CHECK(held("Smaller").first < 0.4);
    CHECK(held("Larger").first > 2.5);
    CHECK(held("Higher").second > 0.4);
    CHECK(held("Lower").second < -0.4);
    CHECK(sketch.click("1:1").natural_size);
    sketch.click("Teleport");
    CHECK(sketch.settings.teleport);
    sketch.click("Walk");
    CHECK_FALSE(sketch.settings.teleport);
    sketch.click("Turn smoothly");
    CHECK(sketch.settings.smooth_turn);
    sketch.click("Grey");
    CHECK(sketch.settings.backdrop == Backdrop::kGrey);
    // A second click on what is chosen leaves the settings as they are made on the page of methods.
    sketch.click("Sharp");
    CHECK(sketch.settings.quality == Quality::kSharp);
    sketch.click("Fast");
    CHECK(sketch.settings.quality == Quality::kFast);
    sketch.click("Fast");
    CHECK(sketch.settings.quality == Quality::kOff);
}

TEST_CASE("the panel has the names and ranges of the table of options") {
    PanelSketch sketch;
    sketch.settings.page = Page::kMethod;
    const auto isChosen = [&](const auto& row, const auto& owner, std::string_view name) { return textOf(row.field.value(owner)) == name; };
    for (const char* key : {"mode", "dominant", "depth"}) {
        const OptionRow<RunOptions>& row = *findRunRow(key);
        CHECK(row.field.choices.size() >= 2);
        for (const std::string_view name : row.field.choices) {
            sketch.click(std::string(name));
            RunOptions options;
            options.stereo = sketch.settings.stereo;
            CHECK_MESSAGE(isChosen(row, options, name), name);
        }
    }
    const OptionRow<ViewSettings>& quality = *findViewRow("quality");
    for (const std::string_view name : quality.field.choices) {
        sketch.click(std::string(name));
        CHECK_MESSAGE(isChosen(quality, sketch.settings, name), name);
    }
    const auto slide = [&](const char* name, double to_px) {
        glm::dvec2 place = sketch.draw().places.at(name);
        sketch.draw(&place);
        sketch.draw(&place, true);
        place.x = to_px;
        sketch.draw(&place, true);
        sketch.draw(&place);
    };
    for (const char* name : {"margin (paper)", "budget", "resolution"}) { slide(name, 0.0); }
    CHECK(sketch.settings.stereo.warp.margin_px == 0);
    CHECK(sketch.settings.stereo.warp.budget == 0.0);
    CHECK(sketch.settings.resolution_scale == *findViewRow("resolution-scale")->field.least);
    for (const char* name : {"margin (paper)", "budget", "resolution"}) { slide(name, kPanelPx.x); }
    CHECK(sketch.settings.stereo.warp.margin_px == 128);
    CHECK(sketch.settings.stereo.warp.budget == 1.0);
    CHECK(sketch.settings.resolution_scale == *findViewRow("resolution-scale")->field.most);
}

TEST_CASE("scenes are looked for by clicks: down, up, to other places, page by page, and what cannot be read does nothing") {
    const Workplace work;
    fs::create_directories(work.path / "inner");
    for (int i = 0; i < 12; ++i) { write(work.path / "inner" / fmt::format("room{}.ply", i)); }
    write(work.path / "a##b.ply");
    fs::create_symlink("nowhere", work.path / "gone.ply");
    setenv("XDG_CONFIG_HOME", (work.base / "config").c_str(), 1);
    PanelSketch sketch;
    sketch.status.scene = (work.path / "a##b.ply").string();
    // The page opens where the scene that is shown lies.
    sketch.click("Scenes");
    CHECK(sketch.chooser.list().title == work.path.string());
    CHECK(sketch.click("gone.ply").chosen_scene.empty());
    CHECK(sketch.click("a##b.ply").chosen_scene == (work.path / "a##b.ply").string());
    CHECK(sketch.click("inner/").chosen_scene.empty());
    CHECK(sketch.chooser.list().title == (work.path / "inner").string());
    CHECK(sketch.chooser.pageCount() == 2);
    CHECK_FALSE(sketch.draw().places.contains("room11.ply"));
    sketch.click(">");
    sketch.click(">");
    CHECK(sketch.chooser.page() == 1);
    CHECK(sketch.click("room11.ply").chosen_scene == (work.path / "inner" / "room11.ply").string());
    sketch.click("<");
    CHECK(sketch.click("room0.ply").chosen_scene == (work.path / "inner" / "room0.ply").string());
    sketch.click("Up");
    CHECK(sketch.chooser.list().title == work.path.string());
    sketch.click("Built-in");
    CHECK(sketch.click("step-edge").chosen_scene == "builtin:step-edge");
    sketch.click("Up");  // there is none above
    CHECK(sketch.chooser.list().title == "Built-in scenes");
    sketch.click("Recent");
    CHECK(sketch.chooser.list().entries.empty());
    rememberScene((work.path / "a##b.ply").string());
    sketch.click("Recent");
    CHECK(sketch.click("a##b.ply").chosen_scene == (work.path / "a##b.ply").string());
    const std::string home = environment("HOME");
    setenv("HOME", work.base.c_str(), 1);
    sketch.click("Home");
    CHECK(sketch.chooser.list().title == work.base.string());
    setenv("HOME", home.c_str(), 1);
    // A file that came meanwhile is there when the page is opened again.
    sketch.chooser.showFolder(work.path.string());
    write(work.path / "new.ply");
    sketch.click("Scenes");
    CHECK(sketch.draw().places.contains("new.ply"));
    unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE("no folder is read while the panel is drawn: it says that it reads until a list is there, and an outdated one is not shown") {
    const Workplace work;
    fs::create_directory(work.path / "inner");
    write(work.path / "inner" / "a.ply");
    PanelSketch sketch;
    sketch.settings.page = Page::kScenes;
    SceneChooser& chooser = sketch.chooser;
    chooser.showFolder(work.path.string());
    const std::optional<SceneListWish> first = chooser.takeWish();
    REQUIRE(first.has_value());
    CHECK_FALSE(chooser.takeWish().has_value());
    CHECK(chooser.isReading());
    CHECK(chooser.list().title == work.path.string());
    CHECK(chooser.list().entries.empty());
    const WidgetPlaces quiet = sketch.draw().places;
    const auto drawnVertices = [] { return ImGui::GetDrawData()->TotalVtxCount; };
    const int without = drawnVertices();
    sketch.status.files = std::string("reading ") + first->name();
    CHECK(sketch.draw().places == quiet);
    CHECK(drawnVertices() > without);
    // Who goes on before the first list is there sees the second one alone.
    chooser.showFolder((work.path / "inner").string());
    const std::optional<SceneListWish> second = chooser.takeWish();
    REQUIRE(second.has_value());
    chooser.show(makeSceneList(*first), *first);
    CHECK(chooser.list().entries.empty());
    chooser.show(makeSceneList(*second), *second);
    CHECK_FALSE(chooser.isReading());
    CHECK(sketch.draw().places.contains("a.ply"));
    // Looked at again, what is seen stays until then.
    chooser.refresh("");
    CHECK(chooser.isReading());
    CHECK(chooser.list().entries.size() == 1);
    // Letters, too, are read and drawn elsewhere: a second wish waits for the first.
    CHECK(sketch.font->want("\xd7\x90"));
    CHECK_FALSE(sketch.font->want("\xe1\x83\x90"));
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x5d0) == nullptr);
    sketch.font->build();
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x5d0) == nullptr);
    sketch.font->take();
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x5d0) != nullptr);
    CHECK(sketch.bringLetters("\xe1\x83\x90"));
    sketch.draw();
}

TEST_CASE("names of any bytes and of any length are shown, and a long message is wrapped within the panel") {
    const Workplace work;
    std::string longest(240, 'w');
    longest += ".ply";
    for (const std::string& name : {std::string("\xce\xa9\xd0\x96\xc3\xa4.ply"), std::string("line\nbreak.ply"), std::string("%s%n.ply"),
                                    std::string("\xff\xfe.ply"), longest}) {
        write(work.path / name);
    }
    PanelSketch sketch;
    sketch.settings.page = Page::kScenes;
    sketch.chooser.showFolder(work.path.string());
    CHECK(sketch.draw().places.size() == 16 + 2 * 5);
    CHECK(sketch.click(longest).chosen_scene == (work.path / longest).string());
    CHECK(asShown("a\nb\x1b[1m\x7f") ==
          "a\xef\xbf\xbd"
          "b\xef\xbf\xbd[1m\xef\xbf\xbd");
    // What is said moves nothing that can be pointed at.
    for (const Page page : {Page::kView, Page::kScenes, Page::kMethod}) {
        sketch.settings.page = page;
        sketch.status.message.clear();
        const WidgetPlaces before = sketch.draw().places;
        for (int i = 0; i < 40; ++i) { sketch.status.message += "/a/long/way/to/a/file "; }
        sketch.status.message += longest;
        CHECK(sketch.draw().places == before);
    }
}

TEST_CASE("the rates that the headset offers can be chosen, and left to it; where it offers none there is no row") {
    PanelSketch sketch;
    CHECK_FALSE(sketch.draw().places.contains("Automatic"));
    sketch.status.refresh_rates = {72.0, 89.9988, 144.0};
    sketch.settings.refresh_rate = 72.0;
    sketch.click("90 Hz");
    CHECK(sketch.settings.refresh_rate == 89.9988);
    sketch.click("144 Hz");
    CHECK(sketch.settings.refresh_rate == 144.0);
    sketch.click("Automatic");
    CHECK(sketch.settings.refresh_rate == 0.0);
    // What is above stays where it is.
    const WidgetPlaces with = sketch.draw().places;
    sketch.status.refresh_rates.clear();
    for (const auto& [name, place] : sketch.draw().places) { CHECK(with.at(name) == place); }
}

}  // namespace panel_test
