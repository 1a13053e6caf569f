// Facts about the wearer's place in the scene, and about saving it.
#include "app/view/placement/placement.h"
#include "app/options/start_view.h"
#include "app/view/headset/losses.h"
#include "app/view/placement/ruler.h"
#include "app/view/placement/view_eyes.h"
#include "app/view/settings/preferences.h"
#include "app/view/settings/view_files.h"
#include "app/view/settings/view_settings.h"
#include "tests/app/camera_file.h"
#include "tests/app/options/parsed.h"
#include "tests/run_program.h"
#include "xr/convert.h"

SUITE(placement) {

void checkNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
    CHECK_MESSAGE(glm::distance(a, b) <= tolerance, a.x, " ", a.y, " ", a.z);
}

const Similarity kSome{glm::normalize(glm::dquat(0.9, 0.1, -0.3, 0.2)), {1.0, -2.0, 3.0}, 2.5};

// A quarter turn about x, upwards.
const glm::dquat kUpwards = glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(1, 0, 0));

TEST_CASE("the mouse makes the scene grow, and tilts it, about the wearer") {
    const glm::dvec3 head(0.3, -1.5, 0.2), ahead = head + glm::dvec3(0.0, 0.0, 2.0);
    const Similarity grown = grownBy(kSome, 2.0, head);
    CHECK(grown.scale == doctest::Approx(0.5 * kSome.scale));
    checkNear(transform(grown, head), transform(kSome, head));
    // What lay two metres ahead now lies four metres ahead.
    checkNear(transform(grown, head + 2.0 * (ahead - head)), transform(kSome, ahead));
    CHECK(grownBy(kSome, 1e300, head).scale > 0.0);
    // A quarter turn upwards, about the axis to the right: what lay ahead now lies above.
    const Similarity tilted = tiltedBy(kSome, kUpwards, head);
    checkNear(transform(tilted, head), transform(kSome, head));
    checkNear(transform(tilted, head + glm::dvec3(0.0, -2.0, 0.0)), transform(kSome, ahead));
    CHECK(tilted.scale == kSome.scale);
}

TEST_CASE("a levelled scene stands upright about the wearer, as large and turned as it was") {
    const glm::dvec3 about(0.3, -0.1, 0.5), down(0.0, 1.0, 0.0);
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 0.7, -0.4));
    const Similarity level = levelledAlong(kSome, up, about);
    checkNear(level.orientation * down, -up, 1e-9);
    checkNear(transform(level, about), transform(kSome, about), 1e-9);
    CHECK(level.scale == kSome.scale);
    const Similarity again = levelledAlong(level, up, about);
    checkNear(again.position, level.position, 1e-9);
    CHECK(std::abs(glm::dot(again.orientation, level.orientation)) == doctest::Approx(1.0));
}

TEST_CASE_FIXTURE(AtWork, "settings of a scene lie in the user's folder, by the file's place and size") {
    const fs::path folder = work.path;
    fs::create_directories(folder / "elsewhere");
    setenv("XDG_CONFIG_HOME", "/somewhere", 1);
    const auto fileOf = [&](const std::string& name, const std::string& text) {
        work.write(name, text);
        return viewSettingsFile((folder / name).string());
    };
    const fs::path first = fileOf("a.ply", "one");
    CHECK(first.parent_path() == "/somewhere/binosplat/scenes");
    CHECK(first.filename().string().starts_with("a-"));
    CHECK(fileOf("a.ply", "two") == first);
    CHECK(fileOf("a.ply", "longer") != first);
    CHECK(fileOf("elsewhere/a.ply", "one") != first);
    CHECK(viewSettingsFile((folder / "elsewhere/../a.ply").string()) == fileOf("a.ply", "longer"));
    CHECK(viewSettingsFile((folder / "elsewhere/").string()) ==
          viewSettingsFile((folder / "elsewhere").string()));
    // Long names are cut between letters: here one byte, followed by 124 letters of two bytes each.
    std::string letters = "a";
    for (int i = 0; i < 124; ++i) { letters += "\xc3\xa4"; }
    const std::string cut = fileOf(letters + ".ply", "one").filename().string();
    CHECK(cut.size() == 254);
    CHECK(cut.starts_with(letters.substr(0, 227) + "-"));
    CHECK(fileOf(letters + ".spz", "one").filename() != cut);
    CHECK(viewSettingsFile("builtin:fence") == "/somewhere/binosplat/scenes/fence.view.toml");
    unsetenv("XDG_CONFIG_HOME");
    setenv("HOME", "/home/of", 1);
    CHECK(viewSettingsFile("builtin:fence") == "/home/of/.config/binosplat/scenes/fence.view.toml");
    unsetenv("HOME");
    CHECK_THROWS_AS(static_cast<void>(viewSettingsFile("builtin:fence")), Error);
}

TEST_CASE_FIXTURE(AtWork, "a wearer starts where the options put the eye or their camera is, upright") {
    const std::string cameras = (work.path / "c.json").string();
    const auto startWith = [&](const std::string& options) {
        const CameraOptions camera = parse<ViewOptions>("view box.ply " + options).run.camera;
        return startPlacement(startView(makeBox((work.path / "box.ply").string()), camera, 0.5), 0.5);
    };
    const Similarity start = startWith("--eye 1,2,3 --look 1,3,5");  // down and ahead, since y points down
    checkNear(transform(start, glm::dvec3(0.0)), {1, 2, 3});
    checkNear(transform(start, {0, 0, 1}), {1, 2, 5});   // ahead is level
    checkNear(transform(start, {0, -1, 0}), {1, 0, 3});  // up is up
    // Looking straight down, no direction ahead is level, but the wearer still stands upright.
    checkNear(startWith("--eye 1,2,3 --look 1,2.001,8 --up 0,0,-1").orientation * glm::dvec3(0, -1, 0),
              {0, 0, -1}, 1e-6);
    // A camera that looks about 37 degrees down, along (0, 0.6, 0.8), keeps its own up.
    const std::string camera = cameraJson("a", {1, 2, 3}, "[[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]]");
    work.write("c.json", fmt::format("[{}]", camera));
    const Similarity at_camera = startWith("--cameras " + cameras);
    checkNear(at_camera.position, {1, 2, 3}, 1e-12);
    checkNear(at_camera.orientation * glm::dvec3(0, -1, 0), {0, -0.8, 0.6}, 1e-6);
}

TEST_CASE("a scene looked at from nearer than half a metre is shown larger, and no other one is") {
    const auto growthAt = [](double distance, double metres_per_unit) {
        return growthToSee({{1, 2, 3}, {1, 2, 3 + distance}, {0, -1, 0}, 60.0}, metres_per_unit);
    };
    CHECK(these(growthAt(0.25, 1.0), growthAt(0.25, 0.1)) ==
          these(doctest::Approx(2.0), doctest::Approx(20.0)));
    for (const double distance : {0.5, 2.0, 100.0}) { CHECK(growthAt(distance, 1.0) == 1.0); }
    CHECK(growthAt(0.25, 10.0) == 1.0);
    CHECK(growthAt(0.0, 1.0) == 1000.0);  // the limit to which hands can enlarge it
}

TEST_CASE("both hands hold what they took, upright or, where they may tilt it, turned any way") {
    const std::array<glm::dvec3, 2> from{glm::dvec3(-0.2, 0.4, 0.3), glm::dvec3(0.2, 0.4, 0.3)};
    const auto checkHeld = [&](const std::array<glm::dvec3, 2>& to, bool tilts) {
        const Similarity held = heldBy(kSome, from, to, tilts);
        for (std::size_t h = 0; h < 2; ++h) { checkNear(transform(held, to[h]), transform(kSome, from[h])); }
        // Hands twice as far apart make the scene twice as large, so a metre is half as many units.
        const double growth = glm::length(to[1] - to[0]) / glm::length(from[1] - from[0]);
        CHECK(held.scale == doctest::Approx(kSome.scale / growth));
        return held;
    };
    for (const auto& to : {std::array{glm::dvec3(-0.1, 0.1, 0.5), glm::dvec3(0.4, 0.1, 0.9)},
                           std::array{glm::dvec3(0.3, 0.4, 0.3), glm::dvec3(-0.1, 0.4, 0.1)},
                           std::array{glm::dvec3(-0.4, 0.4, 0.3), glm::dvec3(0.4, 0.4, 0.3)}, from}) {
        // The vertical stays vertical.
        checkNear(checkHeld(to, false).orientation * glm::dvec3(0, 1, 0),
                  kSome.orientation * glm::dvec3(0, 1, 0));
    }
    checkHeld({glm::dvec3(0.1, 0.1, 0.3), glm::dvec3(0.15, 0.5, 0.4)}, true);
    checkHeld({from[1], from[0]}, true);  // half a turn, too
    // Hands at one point give neither size nor direction.
    CHECK(heldBy(kSome, {from[0], from[0]}, from).scale == doctest::Approx(kSome.scale));
}

TEST_CASE("rounding between parallel eyes is taken out, canting is not") {
    const XrQuaternionf q{0.1f, 0.2f, -0.3f, 0.92736185f};
    std::array<xr::EyeView, 2> views{};
    const glm::dquat turn = xr::fromXr(XrPosef{q, {}}).orientation;
    const glm::dvec3 right = glm::dvec3(5.0, -1.0, 2.0) + turn * glm::dvec3(0.063, 0, 0);
    views[0].pose = {q, xr::toXr(glm::dvec3(5.0, -1.0, 2.0))};
    views[1].pose = {q, xr::toXr(right)};
    const auto eyes = roomFromEyes(views);
    const glm::dvec3 shift = glm::conjugate(eyes[0].orientation) * (eyes[1].position - eyes[0].position);
    checkNear(shift, {0.063, 0.0, 0.0}, 1e-4 * 0.063);
    CHECK(std::max(std::abs(shift.y), std::abs(shift.z)) < 1e-15);
    views[1].pose.orientation = {0.1f, 0.2001f, -0.3f, 0.92734f};
    CHECK(roomFromEyes(views)[1].orientation != eyes[0].orientation);
    views[1].pose = {q, xr::toXr(right + glm::dvec3(0, 0.001, 0))};
    checkNear(roomFromEyes(views)[1].position, right + glm::dvec3(0, 0.001, 0), 1e-6);
    // The same goes for their angles.
    views[0].fov = {-0.9f, 0.8f, 0.85f, -0.95f};
    views[1].fov = {-0.8f, 0.9f, std::nextafter(0.85f, 1.0f), std::nextafter(-0.95f, 0.0f)};
    const std::array<xr::EyeView, 2> alike = withoutNoise(views);
    CHECK(these(alike[1].fov.angleUp, alike[1].fov.angleDown, alike[1].fov.angleLeft) ==
          these(0.85f, -0.95f, -0.8f));
    views[1].fov.angleUp = 0.8501f;
    CHECK(withoutNoise(views)[1].fov.angleUp == 0.8501f);
}

TEST_CASE("sessions lost one after the other are too many after three, those now and then are not") {
    Losses losses;
    Losses::Time now{};
    for (int i = 0; i < 3; ++i) { CHECK(losses.add(now += std::chrono::seconds(1))); }
    CHECK_FALSE(losses.add(now += std::chrono::seconds(1)));
    losses.forget();
    for (int i = 0; i < 20; ++i) { CHECK(losses.add(now += std::chrono::seconds(11))); }
    CHECK(losses.count() == 1);
}

TEST_CASE_FIXTURE(Home, "what somebody sets on the panel is kept, key by key, and is there the next time") {
    const auto settingsOf = [](const std::string& words) {
        const auto options = parse<ViewOptions>("view builtin:fence " + words);
        ViewSettings settings;
        settings.stereo = options.run.stereo;
        return readViewSettings(options.tables, settings);
    };
    ViewSettings now = settingsOf("");
    const ViewSettings begin = now;
    Preferences preferences;
    preferences.note(now, 0.1);
    CHECK(preferences.takeChanges(true).empty());
    now.quality = Quality::kFast;
    now.stereo.mode = Mode::kShared;
    now.panel = !now.panel;
    now.scene_from_room = kSome;
    preferences.note(now, 0.1);
    CHECK(preferences.takeChanges().empty());  // it may still change
    preferences.note(now, 2.0);
    const PreferenceLines changes = preferences.takeChanges();
    CHECK(changes == PreferenceLines{{{"stereo", "mode"}, "\"shared\""}, {{"view", "quality"}, "\"fast\""}});
    keepPreferences(changes);
    keepPreferences({{{"view", "vignette"}, "false"}});
    const ViewSettings next = settingsOf("");
    CHECK(describeChange(begin, next) == "mode = \"shared\", vignette = false, quality = \"fast\"");
    // The command line and a config override preferences, and the simulated headset ignores them.
    CHECK(settingsOf("--mode mono").stereo.mode == Mode::kMono);
    write("own.toml", "[view]\nquality = \"sharp\"\n");
    CHECK(settingsOf("--config " + at("own.toml")).quality == Quality::kSharp);
    CHECK(describeChange(begin, settingsOf("--simulate")) == "");
    // A broken file does not prevent the start, and is put aside.
    std::ofstream(preferencesFile()) << "[view]\nnonsense = 1\n";
    CHECK(describeChange(begin, settingsOf("")) == "");
    keepPreferences({{{"view", "vignette"}, "false"}});
    CHECK(describeChange(begin, settingsOf("")) == "vignette = false");
    CHECK(fs::file_size(preferencesFile().string() + ".unread") == 20);
}

TEST_CASE("a ruler has two ends, and is put away with the second") {
    Ruler ruler;
    CHECK_FALSE(ruler.isOpen());
    ruler.open();
    CHECK_FALSE(ruler.add({1.0, 2.0, 3.0}).has_value());
    ruler.open();  // starts over
    CHECK_FALSE(ruler.hasFirst());
    CHECK_FALSE(ruler.add({1.0, 2.0, 3.0}).has_value());
    CHECK(ruler.add({1.0, 5.0, 7.0}) == 5.0);
    CHECK(these(ruler.isOpen(), ruler.units()) == these(false, 5.0));
}

TEST_CASE_FIXTURE(Home, "of a scene only its place and its measure are kept; an older file is taken whole") {
    ViewSettings settings;
    settings.stereo.mode = Mode::kPaper;
    settings.stereo.dominant = kRight;
    settings.stereo.warp.center_rois = true;
    settings.stereo.warp.margin_px = 48;
    settings.stereo.warp.budget = 0.25;
    settings.stereo.warp.depth_choice = gpu::kDepthMean;
    settings.resolution_scale = 0.7;
    settings.tint = settings.teleport = settings.passthrough = true;
    settings.panel = settings.hands = settings.vignette = false;
    settings.scene_from_room = kSome;
    settings.metres_per_unit = 0.25;
    CHECK(saveViewSettings("builtin:fence", settings).starts_with("saved as "));
    const RememberedPlace there = rememberedPlace("builtin:fence");
    REQUIRE(there.scene_from_room.has_value());
    checkNear(there.scene_from_room->position, kSome.position);
    CHECK(these(there.scene_from_room->scale, there.metres_per_unit) == these(kSome.scale, 0.25));
    CHECK(glm::length(there.scene_from_room->orientation - kSome.orientation) < 1e-12);
    const auto load = [] {
        ViewSettings loaded;
        CHECK(takeSavedSettings(readSavedSettings("builtin:fence"), loaded).starts_with("loaded "));
        return loaded;
    };
    CHECK(describeChange({}, load()) == "");
    std::ofstream(viewSettingsFile("builtin:fence")) << viewSettingsToml(settings);
    ViewSettings loaded = load();
    CHECK(describeChange(settings, loaded) == "");
    // In nearly every frame nothing has changed; no text is written to find that out.
    CHECK(settings == ViewSettings(settings));
    loaded.stereo.warp.margin_px = 16;
    CHECK_FALSE(settings == loaded);
    CHECK(describeChange(settings, loaded) == "margin = 16");
}

TEST_CASE("a config that places the scene in part or wrongly, and an unknown key, are refused") {
    using Items = std::vector<std::string>;
    for (const auto& [key, items, place] :
         {std::tuple("scene-position", Items{"1", "2", "3"}, "a.toml:3"),
          std::tuple("scene-position", Items{"1", "2"}, "a.toml:4: scene-position"),
          std::tuple("units-per-metre", Items{"2"}, "a.toml:3"),
          std::tuple("units-per-metre", Items{"nan"}, "a.toml:4: units-per-metre"),
          std::tuple("colour", Items{"red"}, "a.toml:4: colour")}) {
        const SettingsTable table{"view", "a.toml:3", {{key, {fmt::format("a.toml:4: {}", key), items}}}};
        CHECK_THROWS_WITH_AS(readViewSettings({table}, {}), doctest::Contains(place), Error);
    }
}

}  // SUITE(placement)
