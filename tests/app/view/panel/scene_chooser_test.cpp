// Facts about the panel's page of scenes: what is looked for by clicks is found, whatever its name.
#include "app/view/scenes/recent_scenes.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/run_program.h"

SUITE(scene_chooser) {

TEST_CASE_FIXTURE(Home, "scenes are looked for by clicks, and what cannot be read does nothing") {
    const std::string here = path.string(), inner = here + "/inner", scene = here + "/a##b.ply";
    fs::create_directories(inner);
    for (int i = 0; i < 12; ++i) { write(fmt::format("inner/room{}.ply", i), "x"); }
    write("a##b.ply", "x");
    fs::create_symlink("nowhere", path / "gone.ply");
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
    CHECK(sketch.click("favourite a##b.ply").favourite == scene);
    CHECK(titleAfter("inner/") == inner);
    CHECK(sketch.chooser.pageCount() == 2);
    CHECK_FALSE(sketch.draw().places.contains("room11.ply"));
    for (int i = 0; i < 2; ++i) { sketch.click(">"); }
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
    setenv("HOME", base.c_str(), 1);
    CHECK(titleAfter("Home") == base.string());
    setenv("HOME", home.c_str(), 1);
    // A file that was added in the meantime appears when the page is opened again.
    sketch.chooser.showFolder(here);
    write("new.ply", "x");
    sketch.click("Scenes");
    CHECK(sketch.draw().places.contains("new.ply"));
    unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE_FIXTURE(AtWork, "no folder is read while the panel is drawn, and an outdated list is not shown") {
    fs::create_directory(work.path / "inner");
    work.write("inner/a.ply", "x");
    PanelSketch sketch;
    SceneChooser& chooser = sketch.chooser;
    sketch.showFolder(work.path);
    const std::optional<SceneListWish> first = chooser.takeWish();
    REQUIRE(first.has_value());
    CHECK_FALSE(chooser.takeWish().has_value());
    CHECK(these(chooser.isReading(), chooser.list().title, chooser.list().entries.empty()) ==
          these(true, work.path.string(), true));
    const WidgetPlaces quiet = sketch.draw().places;
    const int without = ImGui::GetDrawData()->TotalVtxCount;
    sketch.status.files = std::string("reading ") + first->name();
    CHECK(sketch.draw().places == quiet);
    CHECK(ImGui::GetDrawData()->TotalVtxCount > without);
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
    CHECK(these(chooser.isReading(), chooser.list().entries.size()) == these(true, 1));
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

TEST_CASE_FIXTURE(AtWork, "names of any bytes and length are shown, and a long message is wrapped") {
    const std::string longest = std::string(240, 'w') + ".ply";
    for (const std::string name :
         {"\xce\xa9\xd0\x96\xc3\xa4.ply", "line\nbreak.ply", "%s%n.ply", "\xff\xfe.ply", longest.c_str()}) {
        work.write(name, "x");
    }
    PanelSketch sketch;
    sketch.showFolder(work.path);
    CHECK(sketch.draw().places.size() == 26 + 2 * 5);
    CHECK(sketch.click(longest).chosen_scene == (work.path / longest).string());
    CHECK(asShown("a\nb\x1b[1m\x7f") == "a\ufffdb\ufffd[1m\ufffd");
    // Messages move nothing that can be pointed at.
    for (const PanelPage page : {PanelPage::kView, PanelPage::kScenes, PanelPage::kMethod}) {
        sketch.settings.page = page;
        sketch.status.message.clear();
        const WidgetPlaces before = sketch.draw().places;
        for (int i = 0; i < 40; ++i) { sketch.status.message += "/a/long/way/to/a/file "; }
        sketch.status.message += longest;
        CHECK(sketch.draw().places == before);
    }
}

}  // SUITE(scene_chooser)
