// Facts about the viewer's panel: clicks take effect, are visible, and come back when saved.
#include "app/view/panel/message_picture.h"
#include "tests/app/view/view_acts.h"
#include "xr/simulated/extensions.h"

SUITE(view_panel) {

const std::string kBlind = "rate 50\nsize 64 64\nframes none\n",
                  kSmall = "rate 50\nsize 96 96\nframes every 2\n";
const std::string kScene = kWall + " --mode mono";
const std::string kSources = BINOSPLAT_SOURCE_DIR "/shaders";

const std::string kAsHeadset = " --size 96x96 --fov-x 90 --ipd 0.063";

TEST_CASE_FIXTURE(AtWork, "what is clicked on the panel is so, and the place is saved, and comes back") {
    Acts acts("rate 50\nsize 160 160\nframes none\n");
    // A step forwards.
    acts.push("left thumbstick", {0.0, 1.0}, 0.1).wait(0.15).click({1.2, 0.3}).click({-0.2, 0.3});
    const double beside = acts.look(0.05);
    // Files are read and written alongside the frames, for which this many in lock-step are enough.
    constexpr double kFilesSeconds = 100 / 50.0;
    acts.click(onMethod("right")).click(onMethod("Save")).wait(kFilesSeconds);
    acts.click(onMethod("left")).click(onMethod("Load")).wait(kFilesSeconds);
    acts.click(onMethod("margin (paper)")).click(onMethod("budget"));
    // The resolution changes when the trigger is released.
    const double held = acts.point(onMethod("resolution")).hold("right trigger", 0.1).wait(0.05).look(0.1);
    const double let_go = acts.look(0.05);
    // Shaders can be reloaded only if their folder was given.
    acts.click(onMethod("Shaders", true))
        .click(onMethod("reproject"))
        .click(onMethod("View"))
        .click(placeOf("120 Hz", true));
    const double other_rate = acts.wait(0.05).look(0.05);
    acts.click(placeOf("Quit")).wait(0.5);
    // What the command line says about the simulated headset overrides the environment.
    const ViewRun run = runClean(
        work, acts, kScene + withConfig(work, kMethodPage),
        kValidated +
            " BINOSPLAT_SHADERS= SIMULATED_OPENXR_OUT=elsewhere SIMULATED_OPENXR_SCRIPT=nowhere.script");
    CHECK_FALSE(fs::exists(work.path / "elsewhere"));
    CHECK(run.endSeconds() < acts.now_s - 0.3);
    CHECK_FALSE(run.says("shaders"));
    CHECK(glm::distance(panelOf(run, 8).position, acts.panel.position) < 1e-5);
    CHECK(std::abs(glm::dot(panelOf(run, 8).orientation, acts.panel.orientation)) > 1.0 - 1e-9);
    const auto size = run.panels(8).at(0).at("size").get<std::array<double, 2>>();
    CHECK(glm::length(glm::dvec2(size[0], size[1]) - kPanelMetres) < 1e-6);
    checkOrder(run, {"dominant = \"right\"", "saved as ", "dominant = \"left\"", "loaded ", "margin = ",
                     "budget = ", "resolution-scale = ", "mode = \"reproject\"", "refresh-rate = 120"});
    CHECK(static_cast<double>(frameOf(run.lines(" = ").at(0))) > 50.0 * beside);
    const auto valueOf = [&](const std::string& key) {
        const std::string line = run.lines(key + " = ").at(0);
        return std::stod(line.substr(line.rfind(' ')));
    };
    // Ranges of 0 to 128 pixels, 0 to 100 % and 0.1 to 2, all clicked at the same share of their length.
    const double share = valueOf("budget"), scale = valueOf("resolution-scale");
    CHECK(share == between(0.4, 0.6));
    CHECK(valueOf("margin") == doctest::Approx(128.0 * share).epsilon(0.02));
    CHECK(scale == doctest::Approx(0.1 + 1.9 * share).epsilon(0.02));
    CHECK(these(run.width(run.frameAt(held)), run.width(run.frameAt(let_go) + 2),
                run.periodNs(run.frameAt(let_go))) ==
          these(160, static_cast<int>(std::round(160.0 * scale)), 20'000'000));
    CHECK(run.periodNs(run.frameAt(other_rate)) == 8'333'333);
    // Both the viewer and `render` accept the file.
    const std::string said = run.lines("saved as ").at(0);
    const fs::path file = said.substr(said.find("saved as ") + 9);
    CHECK(fs::weakly_canonical(file) == wallSettings(work));
    CHECK(run.says("loaded " + file.string()));
    const std::string with_file = " --config '" + file.string() + "'";
    work.go("render builtin:slanted-wall --out rendered --size 32x32" + with_file);
    // The wearer stands there again, unless an option gives another place.
    const auto look = [&](const std::string& arguments) {
        return runClean(work, "rate 50\nsize 96 96\nframes every 5\nat 0.15 exit\n",
                        kWall + " --hide-panel --mode mono --dominant right" + arguments);
    };
    const ViewRun there = look(""), named = look(with_file),
                  before = look(" --eye 0,0,0 --look 0,0,3 --up 0,-1,0");
    CHECK(there.says("the wearer stands where this scene was saved"));
    CHECK_FALSE(before.says("where this scene was saved"));
    CHECK(compare(there.eye(5, kLeft), named.eye(5, kLeft)).psnrDb() > 60.0);
    CHECK(compare(there.eye(5, kLeft), before.eye(5, kLeft)).psnrDb() < 40.0);
    // The panel's button reads a folder of shaders, but neither one that does not exist nor a pipe, which
    // would keep the compiler, and the wearer, waiting.
    Acts reload(kBlind);
    reload.click(onMethod("Shaders", true)).wait(0.1);
    REQUIRE(work.runCommand("mkdir -p pipe/sort && mkfifo pipe/sort/cull_pages.comp").exit_code == 0);
    for (const auto& [folder, why] : {std::pair("nowhere", "there"), std::pair("pipe", "a file")}) {
        const ViewRun other =
            runClean(work, reload, kOneSplat + " --mode mono" + withConfig(work, kMethodPage),
                     kValidated + " BINOSPLAT_SHADERS=" + folder);
        CHECK(other.says(
            fmt::format("shaders stay as they were: {}/sort/cull_pages.comp is not {}", folder, why)));
    }
}

TEST_CASE_FIXTURE(AtWork, "the panel comes before the eyes of a wearer who has turned round for a while") {
    Acts acts(kBlind);
    acts.head("position 0 1.6 0 turn 180 0").wait(0.5);
    const double turned = acts.look(2.0), there = acts.look();
    const ViewRun run = runClean(work, acts, kScene);
    const auto panelAt = [&](double seconds) { return panelOf(run, run.frameAt(seconds)).position; };
    CHECK(glm::distance(panelAt(turned), acts.panel.position) < 1e-4);
    CHECK(glm::distance(panelAt(there), {0.45, 1.5, 0.9}) < 1e-4);
}

TEST_CASE_FIXTURE(AtWork, "a rate that the headset lacks, or that it refuses, is said, and is no end") {
    Acts acts("rate 90 fixed\nsize 64 64\nframes none\n");
    acts.click(placeOf("120 Hz", true)).wait(0.1);
    // Rates that the script will change to, even long after the end, are on the headset's list, too.
    const ViewRun run =
        runView(work, "fixed", acts.script() + "at 20 rate 72\nat 21 rate 80\nat 22 rate 120\n",
                kScene + withConfig(work, "[view]\nrefresh-rate = 75\n"));
    CHECK(run.outcome.exit_code == 0);
    CHECK_FALSE(run.says("VUID"));
    CHECK(run.says("refresh-rate is 75, this headset has 72, 80, 90, 120"));
    CHECK(run.says(
        "refresh-rate is 120, this headset refuses it (XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB)"));
    CHECK(run.periodNs(run.frames.size() - 1) == 11'111'111);
}

TEST_CASE_FIXTURE(AtWork, "shaders are reloaded by a button, all or none, with a verdict") {
    // First unchanged; then one line is broken; then it draws nothing.
    fs::copy(kSources, work.path / "edited", fs::copy_options::recursive);
    const fs::path present = fs::path("edited") / "present" / "present.comp";
    const std::string text = textIn(work.path / present),
                      line = "    const uvec3 bytes = uvec3(colour * 255 + 0.5);";
    fs::create_directory(work.path / "edits");
    for (const auto& [edit, replacement] : {std::pair("1", "    const uvec3 bytes = nonsense;"),
                                            std::pair("2", "    const uvec3 bytes = uvec3(0);")}) {
        work.write(std::string("edits/") + edit, edited(text, line + " => " + replacement));
    }
    writeCompilerOfChangedShaders(work.path / "tools",
                                  "if [ $name = present ]; then for edit in edits/*; do [ -e $edit ] && mv "
                                  "$edit $last; break; done; fi\n");
    Acts acts(kSmall);
    std::vector<double> looks{acts.look()};
    for (int i = 0; i < 3; ++i) {
        acts.click(onMethod("Shaders", true));
        looks.push_back(acts.look());
    }
    const ViewRun run = runClean(work, acts, kScene + " --shaders edited" + withConfig(work, kMethodPage),
                                 kValidated + " PATH=\"$PWD/tools:$PATH\"");
    const auto count =
        std::ranges::count_if(fs::recursive_directory_iterator(kSources),
                              [](const auto& file) { return file.path().extension() == ".comp"; });
    checkOrder(run,
               {fmt::format("{} shaders reloaded in ", count),
                "shaders stay as they were: " + present.string() + ":", "nonsense", " shaders reloaded in "});
    // Away from the panel and the ray: the upper third of the right half.
    const auto seenAt = [&](double seconds) {
        return partOf(run.eye(run.pictureAt(seconds), kRight), {49, 0}, {96, 32});
    };
    for (const std::size_t i : {1, 2, 3}) {
        CHECK_MESSAGE((seenAt(looks[0]).values == seenAt(looks[i] + 0.04).values) == (i != 3), i);
    }
}

TEST_CASE_FIXTURE(AtWork, "every shader is compiled from its source as the build does it" * nightly()) {
    Acts acts(kBlind);
    acts.click(onMethod("Shaders", true)).wait(0.1);
    const ViewRun run = runClean(
        work, acts, kScene + " --shaders '" + kSources + "'" + withConfig(work, kMethodPage), kValidated);
    CHECK(run.says(" shaders reloaded in "));
}

TEST_CASE_FIXTURE(AtWork, "a resolution without memory for it is refused, and what was shown stays") {
    const std::string config = withConfig(work, kMethodPage + "resolution-scale = 0.25\n");
    const auto choose = [&](const std::string& headset, const std::string& arguments) {
        Acts acts("rate 50\n" + headset);
        acts.wait(0.1).press("right b").click(onMethod("resolution")).press("right b").wait(0.2);
        return runClean(work, acts, arguments + " --hide-panel" + config);
    };
    const ViewRun run =
        choose("size 1024 1024\nframes from 12 to 36 every 24\n", kWall + " --memory-limit 16");
    CHECK(run.says("does not fit: "));
    CHECK(run.says("the limit is 16.0 MiB (memory-limit)"));
    CHECK(run.width(36) == 256);
    CHECK(compare(run.eye(36, kLeft), run.eye(12, kLeft), 3).psnrDb() > 60.0);
    // At the slider's middle the eyes' pictures fit, but those that are handed to the headset do not.
    CHECK(choose("size 845 845\nframes none\n", kOneSplat + " --mode shared --axes view --memory-limit 21")
              .says("presented pixels needs "));
}

TEST_CASE_FIXTURE(AtWork, "tint and ROIs are seen in the eye made from the other, a walk as rendered") {
    Acts acts("rate 50\nsize 96 96\nframes every 5\n");
    const double plain = acts.look();
    acts.press("right b").click(onMethod("Show how tiles were made"));
    const double tinted = acts.look();
    acts.click(onMethod("Centre ROI (paper)"));
    const double centred = acts.look();
    for (const auto name : {"Show how tiles were made", "predicted", "right"}) { acts.click(onMethod(name)); }
    acts.press("right b").wait(0.2).head("position 0.15 1.57 -0.2 rotation 0.1 0.15 0 0.98", 1.0);
    const double walked = acts.now_s - 0.4;
    // So close to the bars that holes open inside the picture.
    const ViewRun run = runClean(work, acts,
                                 "builtin:fence --load-first --hide-panel --hide-hands --axes view --mode "
                                 "paper --margin 0 --eye 0,0,0.5 --look 0,0,3 --up 0,-1,0" +
                                     withConfig(work, kMethodPage));
    checkOrder(run, {"tint = true", "center-roi = true", "tint = false", "mode = \"predicted\"",
                     "dominant = \"right\"", "the runtime asked for the end"});
    // The share of pixels that are greener than in the other picture.
    const auto shareAt = [&](int side) {
        const Image before = run.eye(run.pictureAt(tinted), side),
                    after = run.eye(run.pictureAt(centred), side);
        const auto isTinted = [](const glm::vec3& was, const glm::vec3& is) {
            return is[1] - was[1] > 0.06f && was[0] - is[0] > 0.03f;
        };
        return static_cast<double>(countPixels(before, after, isTinted)) /
               static_cast<double>(before.pixelCount());
    };
    CHECK(shareAt(kRight) > 0.02);
    CHECK(shareAt(kLeft) < 0.005);
    const glm::dvec3 start(0.0, 0.0, 0.5);
    checkAgreesWithRender(work, run, run.pictureAt(plain), start, "--mode paper --margin 0" + kAsHeadset);
    checkAgreesWithRender(work, run, run.pictureAt(walked), start,
                          "--mode predicted --margin 0 --dominant right --center-roi" + kAsHeadset);
    // The head walked, and every frame matched the eyes' poses.
    for (const double seconds : {walked - 0.3, walked - 0.1, walked}) {
        const std::size_t frame = run.frameAt(seconds);
        for (const std::size_t side : {0, 1}) {
            const glm::dvec3 shown = run.viewPlace(frame, side), was = run.loggedEye(frame, side).position;
            for (const int axis : {0, 2}) { CHECK(shown[axis] == doctest::Approx(was[axis]).epsilon(1e-4)); }
        }
    }
    CHECK(run.loggedEye(run.frameAt(walked), 0).position.z < -0.05);
}

TEST_CASE_FIXTURE(AtWork, "a runtime with only OpenXR 1.0 and Vulkan shows every method and takes clicks") {
    std::string begin = "rate 50\nsize 96 96\nframes every 4\nstage off\nprofile khr/simple_controller\n";
    for (const simulated::Extension& extension : simulated::kExtensions) {
        const std::string name = extension.name;
        if (name != "XR_KHR_vulkan_enable2") { begin += fmt::format("extension {} off\n", name); }
    }
    Acts acts(begin);
    std::vector<std::string> said{"the room now begins where the wearer stands\n"};
    for (const char* mode : {"reproject", "paper", "mono", "two-pass", "shared"}) {
        acts.click(onMethod(mode), "right select");
        said.push_back(fmt::format("mode = \"{}\"", mode));
    }
    acts.point(kBeside).press("right menu").at("controller left off").at("controller right off").wait(0.05);
    const double shared = acts.look();
    acts.at("controller left on").at("controller right on").wait(0.1).press("right menu");
    acts.click(onMethod("View"), "right select").click(placeOf("Teleport"), "right select");
    acts.right(lookingAt({0.2, 1.2, -0.35}, {0.2, 1.2, -1.0})).wait(0.05);
    const double aiming = acts.hold("right select", 0.2).wait(0.05).look();
    const ViewRun run = runClean(
        work, acts,
        "builtin:fence --load-first --eye 0,0,0 --look 0,0,3 --up 0,-1,0" + withConfig(work, kMethodPage));
    checkOrder(run, said);
    const std::size_t frame = run.pictureAt(shared);
    CHECK_FALSE(run.view(frame).contains("depth"));
    checkAgreesWithRender(work, run, frame, {}, "--mode shared" + kAsHeadset);
    // Rays, controllers and an arc beside the panel.
    CHECK(run.layers(run.frameAt(aiming), "quad").size() > 10);
    // Without a floor, the target is as far below as people are tall.
    const auto targets = run.quadsAsWide(run.frameAt(aiming), 0.5);
    REQUIRE(targets.size() == 1);
    CHECK(poseOf(targets[0].at("pose")).position.y == doctest::Approx(-1.59));
}

TEST_CASE_FIXTURE(AtWork, "the first start shows three gestures in turn, and no other start does") {
    const auto shown = [&](const std::string& when) {
        const ViewRun run = runClean(
            work, "rate 20\nsize 64 64\nframes none\nat 23 exit\n",
            kOneSplat + " --mode mono" + withConfig(work, "[view]\nfirst-steps = \"" + when + "\"\n"));
        const auto isMessage = [](const nlohmann::json& quad) {
            return quad.at("views").at(0).at("rect").at(3) == kMessagePx.y;
        };
        std::size_t quads = 0;
        for (std::size_t i = 0; i < run.frames.size(); ++i) { quads += run.quadsWhere(i, isMessage).size(); }
        return quads;
    };
    // Three times seven seconds, minus the first frames, which wait for a file to be read.
    CHECK(shown("once") == between(380, 430));
    CHECK(shown("once") == 0);
    CHECK(shown("never") == 0);
    CHECK(shown("always") == between(380, 430));
}

}  // SUITE(view_panel)
