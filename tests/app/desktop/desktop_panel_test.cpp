// Facts about the panel in a window without a headset.
#include "app/desktop/desktop_panel.h"
#include "tests/app/view/panel/panel_sketch.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

SUITE(desktop_panel) {

TEST_CASE_FIXTURE(PanelSketch, "in the window, buttons do what keys do, and set how both eyes are shown") {
    using Asked = PanelRequests;
    settings.page = PanelPage::kHelp;
    status.window.emplace();
    draw();
    CHECK(settings.page == PanelPage::kView);
    const auto check = [&](const char* name, int key, bool Asked::*flag) {
        CHECK_MESSAGE(these(click(name).*flag, requestsOf(key, settings, status).*flag) == these(true, true),
                      name);
    };
    check("Open", 'O', &Asked::open_file);
    check("Compare", 'C', &Asked::compare);
    check("Whole scene", 'F', &Asked::show_whole);
    check("Start view", 'R', &Asked::reset_scene);
    check("Picture", 'P', &Asked::take_picture);
    check("Help", 'H', &Asked::help);
    check("Full screen", GLFW_KEY_F11, &Asked::fill_screen);
    status.window->fills_screen = true;
    check("Window", GLFW_KEY_ESCAPE, &Asked::fill_screen);
    CHECK(click("True size").measure);
    for (int key = '1'; key <= '9'; ++key) {
        CHECK(requestsOf(key, settings, status).viewpoint == static_cast<std::size_t>(key - '1'));
    }
    for (const auto& [name, stereo] :
         {std::pair("Red-cyan", WindowStereo::kAnaglyph), std::pair("Top, bottom", WindowStereo::kTopBottom),
          std::pair("Cross-eyed", WindowStereo::kCrossEyed), std::pair("One eye", WindowStereo::kMono),
          std::pair("Side by side", WindowStereo::kSideBySide)}) {
        click(name);
        CHECK(settings.window_stereo == stereo);
    }
    settings.window_plane = 5.0;
    for (const char* slider : {"eye distance", "screen plane"}) { click(slider); }
    CHECK(settings.window_eyes == doctest::Approx(0.1).epsilon(0.05));
    CHECK(settings.window_plane == doctest::Approx(1.0).epsilon(0.1));
    // The list of keys.
    const int vertices = (draw(), ImGui::GetDrawData()->TotalVtxCount);
    status.window->helps = true;
    draw();
    CHECK(ImGui::GetDrawData()->TotalVtxCount > vertices + 1000);
}

}  // SUITE(desktop_panel)
