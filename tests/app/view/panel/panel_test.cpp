// Facts about the panel's pages: what can be pointed at, whatever they show.
#include "app/options/option_table.h"
#include "app/view/panel/first_steps.h"
#include "app/view/panel/message_picture.h"
#include "app/view/settings/view_settings_table.h"
#include "tests/app/view/panel/panel_sketch.h"

#include <imgui_internal.h>

SUITE(panel) {

using Page = PanelPage;
constexpr std::array kPages{Page::kView, Page::kScenes, Page::kMethod, Page::kTime, Page::kHelp};

TEST_CASE("on each page every widget lies on the panel, none on another, and is large enough to point at") {
    const double half_px = 0.5 * 1.5 * kPanelPx.x / 26.0;
    for (const auto& [all, in_window] :
         {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
        PanelSketch sketch;
        if (in_window) {
            sketch.status.window.emplace(ShownWindow{.helps = true});
            sketch.settings.window_stereo = WindowStereo::kTopBottom;
        }
        sketch.status.can_reload_shaders = sketch.status.can_pass_through = all;
        sketch.status.compares = true;
        if (all) {
            sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0, 144.0};
            sketch.status.time = ShownTime{11, 60, 30.0, true, 3};
        }
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
    using Asked = PanelRequests;
    using Flag = std::pair<const char*, bool Asked::*>;
    const auto checkPage = [&](const char* tab, Page page, const std::vector<Flag>& flags) {
        click(tab);
        CHECK(settings.page == page);
        for (const auto& [name, flag] : flags) { CHECK_MESSAGE(click(name).*flag, name); }
    };
    const Flag save("Save", &Asked::save), load("Load", &Asked::load), quit("Quit", &Asked::quit);
    checkPage("Method", Page::kMethod, {save, load, quit});
    CHECK(click("paper").places.contains("Centre ROI (paper)"));
    click("Centre ROI (paper)");
    CHECK(settings.stereo.warp.center_rois);
    for (const bool is_on : {true, false}) {
        click("Foveation");
        CHECK((settings.stereo.foveation_deg > 0.0) == is_on);
    }
    click("Axes stay");
    CHECK(settings.stereo.axes == Axes::kStay);
    checkPage("View", Page::kView,
              {save, load, quit, Flag("Level", &Asked::level_scene), Flag("Recentre", &Asked::recentre),
               Flag("Reset", &Asked::reset_scene), Flag("1:1", &Asked::natural_size),
               Flag("True size", &Asked::measure), Flag("Picture", &Asked::take_picture)});
    checkPage("Scenes", Page::kScenes,
              {quit, Flag("Last shown", &Asked::last_scene), Flag("Keep this one", &Asked::keep_viewpoint),
               Flag("Tour", &Asked::tour), Flag("Name", &Asked::rename_viewpoint),
               Flag("Forget", &Asked::forget_viewpoint), Flag("Export", &Asked::share_viewpoints),
               Flag("Import", &Asked::read_viewpoints), Flag("Compare", &Asked::compare)});
    for (const auto& [name, step, by] : {std::tuple("Next scene", &Asked::scene_step, 1),
                                         std::tuple("Previous scene", &Asked::scene_step, -1),
                                         std::tuple("Next viewpoint", &Asked::viewpoint_step, 1),
                                         std::tuple("Previous viewpoint", &Asked::viewpoint_step, -1),
                                         std::tuple("Earlier", &Asked::viewpoint_move, -1),
                                         std::tuple("Later", &Asked::viewpoint_move, 1)}) {
        CHECK_MESSAGE(click(name).*step == by, name);
    }
    // Only during a comparison there is another scene to keep in sight.
    for (const bool compares : {false, true}) {
        status.compares = compares;
        CHECK(click("Other").show_other == compares);
    }
    CHECK(click("Compare").compare);
    checkPage("Help", Page::kHelp, {Flag("Leave", &Asked::quit)});
}

// What covers this place in what was drawn last: red, green and blue, from 0 to 1.
glm::dvec3 drawnAt(const glm::dvec2& place) {
    glm::dvec3 colour(0.0);
    const ImDrawData& drawn = *ImGui::GetDrawData();
    for (int l = 0; l < drawn.CmdListsCount; ++l) {
        const ImDrawList& list = *drawn.CmdLists[l];
        for (int i = 0; i + 2 < list.IdxBuffer.Size; i += 3) {
            const auto corner = [&](int k) {
                const ImVec2 at = list.VtxBuffer[list.IdxBuffer[i + k % 3]].pos;
                return glm::dvec2(at.x, at.y);
            };
            std::vector<double> turns;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec2 side = corner(k + 1) - corner(k), to = place - corner(k);
                turns.push_back(side.x * to.y - side.y * to.x);
            }
            const ImVec4 seen = ImGui::ColorConvertU32ToFloat4(list.VtxBuffer[list.IdxBuffer[i]].col);
            const auto [least, most] = std::ranges::minmax(turns);
            if (least * most > 0.0 && seen.w == 1.0f) { colour = {seen.x, seen.y, seen.z}; }
        }
    }
    return colour;
}

TEST_CASE_FIXTURE(PanelSketch, "a button is brighter under the ray, yellow while pressed, blue if chosen") {
    draw();
    click("Sharp");
    glm::dvec2 place = draw().places.at("Fast"), chosen = draw().places.at("Sharp");
    for (glm::dvec2* at : {&place, &chosen}) { at->y += 0.4 * kLargeTargetPx; }  // below the name
    const auto lookAt = [&](bool hovered, bool pressed) {
        draw(hovered ? &place : nullptr, pressed);
        return drawnAt(place + glm::dvec2(60.0, 0.0));  // beside the dot of the pointer
    };
    const glm::dvec3 rests = lookAt(false, false), hovered = lookAt(true, false),
                     pressed = lookAt(true, true), blue = drawnAt(chosen);
    const auto sum = [](const glm::dvec3& colour) { return colour.r + colour.g + colour.b; };
    CHECK(sum(hovered) > sum(rests) + 0.3);
    CHECK(std::min(pressed.r, pressed.g) > pressed.b + 0.3);
    for (const glm::dvec3& grey : {rests, hovered}) { CHECK(grey.b - grey.r == between(0.0, 0.2)); }
    CHECK(blue.b > blue.r + 0.5);
}

TEST_CASE_FIXTURE(PanelSketch, "what the panel asks for is written with its keys or a keyboard") {
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
    entry.type("r");
    CHECK(click("Done").entered == std::pair(What::kViewpointName, std::string("my dOor")));
    CHECK(these(entry.isOpen(), draw().places.contains("Recentre")) == these(false, true));
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

TEST_CASE_FIXTURE(PanelSketch, "a message is white letters on a dark plate, in two lines if it is long") {
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
    CHECK(rowsWith(line).size() == within(13, 29));
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
        CHECK(first_white == between(first_yellow + 20, kMessagePx.x / 2));
        CHECK(yellow.size() > 20);
        drawings.insert(yellow);
    }
    CHECK(drawings.size() == kGestures);
}

TEST_CASE("inputs have the names that people call them") {
    for (const auto& [path, name] :
         {std::pair("thumbstick", "stick"), std::pair("y/click", "Y"), std::pair("squeeze/force", "squeeze"),
          std::pair("select/click", "select"), std::pair("select/value", "pinch"),
          std::pair("cluster_back_logitech/click", "back button")}) {
        CHECK(xr::inputName(("input/" + std::string(path)).c_str()) == name);
    }
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

TEST_CASE_FIXTURE(PanelSketch, "a scene that moves has a page: it rests, steps, and goes to a frame") {
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

TEST_CASE_FIXTURE(PanelSketch, "a picture of a scene lies in the font's texture, and letters stay there") {
    ScenePicture picture{"red", "a.png", {}};
    for (std::size_t i = 0; i < std::size_t{kScenePicturePx.x} * kScenePicturePx.y; ++i) {
        picture.rgba.insert(picture.rgba.end(), {200, 10, 20, 255});
    }
    CHECK(bringLetters("", {picture}));
    CHECK_FALSE(bringLetters("", {picture}));
    REQUIRE(font->pictures().contains("red"));
    const PictureCorners& corners = font->pictures().at("red");
    const FontTexture texture = fontTexture();
    const auto inTexels = [&](auto at) { return glm::dvec2(at.x, at.y) * glm::dvec2(texture.size_px); };
    const glm::dvec2 low = inTexels(corners.low), high = inTexels(corners.high);
    CHECK(glm::uvec2(glm::round(high - low)) == kScenePicturePx);
    CHECK(texture.at(glm::uvec2(0.5 * (low + high))) == std::array<unsigned char, 4>{200, 10, 20, 255});
    CHECK(isThere('A'));
    // A later picture of the same scene replaces it; pictures of other scenes stay.
    for (const auto& [key, file] : {std::pair("other", "b.png"), std::pair("later", "a.png")}) {
        picture.key = key;
        picture.file = file;
        CHECK(bringLetters("", {picture}));
    }
    CHECK(these(font->pictures().size(), font->pictures().contains("later"),
                font->pictures().contains("other")) == these(2, true, true));
}

TEST_CASE_FIXTURE(PanelSketch, "size and height change while buttons are held; the rest is chosen by name") {
    const auto held = [&](const char* name) {
        const glm::dvec2 place = draw().places.at(name);
        int times = 0;
        double growth = 1.0, rise_m = 0.0;
        draw(&place);
        for (int frame = 0; frame < 100; ++frame) {
            const PanelRequests requests = draw(&place, true);
            times += requests.growth != 1.0 || requests.rise_m != 0.0;
            growth *= requests.growth;
            rise_m += requests.rise_m;
        }
        draw(&place);
        draw();
        CHECK(times > 5);  // times a second
        return std::pair(growth, rise_m);
    };
    CHECK(held("Smaller").first < 0.4);
    CHECK(held("Larger").first > 2.5);
    CHECK(held("Higher").second > 0.4);
    CHECK(held("Lower").second < -0.4);
    for (const char* way : {"Teleport", "Walk"}) {
        click(way);
        CHECK(settings.teleport == (std::string_view(way) == "Teleport"));
    }
    click("Turn smoothly");
    CHECK(settings.smooth_turn);
    status.can_pass_through = true;
    using Box = std::pair<const char*, bool ViewSettings::*>;
    for (const auto& [name, box] :
         {Box("On ground", &ViewSettings::follow_ground), Box("Two-handed tilt", &ViewSettings::tilt),
          Box("Vignette", &ViewSettings::vignette), Box("Hands", &ViewSettings::hands),
          Box("Passthrough", &ViewSettings::passthrough),
          Box("Both eyes", &ViewSettings::picture_both_eyes)}) {
        for (const bool toggled : {!(settings.*box), settings.*box}) {
            click(name);
            CHECK_MESSAGE(settings.*box == toggled, name);
        }
    }
    click("Grey");
    CHECK(settings.backdrop == Backdrop::kGrey);
    // A second click on the chosen quality leaves the settings as the page of methods has them.
    for (const auto& [name, quality] :
         {std::pair("Sharp", Quality::kSharp), std::pair("Fast", Quality::kFast),
          std::pair("Fast", Quality::kOff)}) {
        click(name);
        CHECK(settings.quality == quality);
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

TEST_CASE_FIXTURE(PanelSketch, "the headset's rates can be chosen; where it offers none there is no row") {
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
