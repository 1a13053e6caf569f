// Facts about the viewer's panel: a ray points, the trigger clicks, and what was chosen is so.
#include "engine/picture/metrics.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/unchanged_shaders.h"
#include "tests/app/view/view_scripts.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>

TEST_SUITE_BEGIN("view_panel");

namespace view_panel_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("method and dominant eye are switched, and the wearer may quit from the panel") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const std::string script = kBlind + clickOn(panel, {onMethod("reproject"), onMethod("right"), onMethod("Quit"), {0.9, 0.95}});
    const ViewRun run = runView(work, "click", script, kScene + withMethodPage(work));
    checkClean(run);
    CHECK(says(run, "mode = \"reproject\""));
    CHECK(says(run, "dominant = \"right\""));
    // It quit before the script's end at 1 s.
    CHECK(run.frames.size() < 40);
}

TEST_CASE("a rate chosen on the panel is the headset's from then on") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(work, "rate", kDense + clickOn(panel, {placeOf("120 Hz", true), {0.9, 0.95}}), kScene);
    checkClean(run);
    CHECK(says(run, "refresh-rate = 120"));
    CHECK(run.frames.front().at("period_ns").get<std::int64_t>() > 9'000'000);
    CHECK(run.frames.back().at("period_ns").get<std::int64_t>() == 8'333'333);
}

TEST_CASE("a rate that the headset refuses is said, and is no end") {
    const Workplace work;
    const ViewRun run =
        runView(work, "fixed",
                // The wearer's own changes, long after the end, are on the list as well.
                "rate 90 fixed\n" + kDense.substr(kDense.find('\n') + 1) +
                    clickOn(startPanel(work), {placeOf("120 Hz", true), {0.9, 0.95}}) + "at 20 rate 72\nat 21 rate 80\nat 22 rate 120\n",
                kScene);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.output.find("VUID") == std::string::npos);
    CHECK(says(run, "refresh-rate is 120, this headset refuses it (XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB)"));
    CHECK(run.frames.back().at("period_ns").get<std::int64_t>() > 9'000'000);
}

TEST_CASE("sliders take a click, and the resolution changes once the trigger is let go") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(
        work, "slide", kSmall + clickOn(panel, {onMethod("margin (paper)"), onMethod("budget"), onMethod("resolution"), {0.9, 0.95}}),
        kScene + withMethodPage(work));
    checkClean(run);
    const auto valueOf = [&](const std::string& key) {
        const std::size_t at = run.outcome.output.find(key + " = ");
        INFO(key << " in " << run.outcome.output);
        REQUIRE(at != std::string::npos);
        return std::stod(run.outcome.output.substr(at + key.size() + 3));
    };
    // 0 to 128 pixels, 0 to 100 %, 0.1 to 2, all clicked at the same share of their length.
    const double share = valueOf("budget");
    CHECK(share > 0.4);
    CHECK(share < 0.6);
    CHECK(valueOf("margin") == doctest::Approx(128.0 * share).epsilon(0.02));
    const double scale = valueOf("resolution-scale");
    CHECK(scale == doctest::Approx(0.1 + 1.9 * share).epsilon(0.02));
    const auto sizeIn = [&](std::size_t frame) {
        const auto rect = run.layers(frame, "projection").at(0).at("views").at(0).at("rect").get<std::array<int, 4>>();
        return rect[2];
    };
    CHECK(sizeIn(20) == 160);
    CHECK(sizeIn(35) == static_cast<int>(std::round(160.0 * scale)));
}

TEST_CASE("pointing beside the panel clicks nothing") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const ViewRun run = runView(work, "beside", kBlind + clickOn(panel, {{1.2, 0.3}, {-0.2, 0.3}}), kScene);
    checkClean(run);
    CHECK_FALSE(says(run, " = "));
}

TEST_CASE("settings and placement are saved as a config of the scene, and come back") {
    const Workplace work;
    const Panel panel = startPanel(work);
    // A step ahead and a method, before they are saved.
    const std::string walk =
        "axis left thumbstick 0.05 0 0\naxis left thumbstick 0.06 0 1\naxis left thumbstick 0.14 0 1\naxis left thumbstick 0.15 0 0\n";
    const ViewRun saved = runView(
        work, "save",
        kBlind + walk + clickOn(panel, {onMethod("reproject"), onMethod("Save"), onMethod("predicted"), onMethod("Load"), {0.9, 0.95}}),
        kScene + withMethodPage(work));
    checkClean(saved);
    const std::string& output = saved.outcome.output;
    const std::size_t at = output.find("saved as ");
    REQUIRE(at != std::string::npos);
    const std::filesystem::path file = output.substr(at + 9, output.find('\n', at) - at - 9);
    CHECK(std::filesystem::weakly_canonical(file) == work.base / "config" / "binosplat" / "scenes" / "slanted-wall.view.toml");
    CHECK(says(saved, "loaded " + file.string()));
    CHECK(output.find("mode = \"predicted\"") < output.rfind("mode = \"reproject\""));
    // The viewer and `render` take the file.
    const ViewRun again = runView(work, "again", kBlind + "at 0.1 exit\n", kWall + " --config '" + file.string() + "'");
    checkClean(again);
    CHECK(work.run("render builtin:slanted-wall --out rendered --size 32x32 --config '" + file.string() + "'").exit_code == 0);
    std::ifstream report(work.path / "rendered" / "report.json");
    CHECK(nlohmann::json::parse(report).at("options").at("mode") == "reproject");
    // The wearer stands there again, unless told where to.
    const ViewRun there = runView(work, "there", kStill + "at 0.1 exit\n", kWall + " --mode reproject --hide-panel");
    checkClean(there);
    CHECK(says(there, "the wearer stands where this scene was saved"));
    const ViewRun before =
        runView(work, "before", kStill + "at 0.1 exit\n", kWall + " --mode reproject --hide-panel --eye 0,0,0 --look 0,0,3 --up 0,-1,0");
    CHECK_FALSE(says(before, "where this scene was saved"));
    const ViewRun named = runView(work, "named", kStill + "at 0.1 exit\n", kWall + " --hide-panel --config '" + file.string() + "'");
    CHECK(compare(there.eye(8, kLeft), named.eye(8, kLeft)).psnrDb() > 60.0);
    CHECK(compare(there.eye(8, kLeft), before.eye(8, kLeft)).psnrDb() < 40.0);
    // Another scene has another place, and one that cannot be read is said and does not keep anybody out.
    CHECK_FALSE(
        says(runView(work, "other", kBlind + "at 0.1 exit\n", "builtin:one-splat --load-first --mode mono"), "where this scene was saved"));
    std::ofstream(file) << "[view]\nnonsense = 1\n";
    const ViewRun broken = runView(work, "broken", kBlind + "at 0.1 exit\n", kScene);
    checkClean(broken);
    CHECK(says(broken, "slanted-wall.view.toml:2"));
}

TEST_CASE("shaders are reloaded by a button, all or none, with a verdict") {
    const Workplace work;
    const Panel panel = startPanel(work);
    // The sources as they are; then a copy in which one line is broken, another that draws nothing, and a folder that is not there.
    const std::filesystem::path sources = std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "shaders";
    const auto copyOf = [&](const std::string& name, const std::string& line, const std::string& replacement) {
        std::filesystem::copy(sources, work.path / name, std::filesystem::copy_options::recursive);
        const std::filesystem::path file = work.path / name / "present/present.comp";
        std::ifstream in(file);
        const std::string text(std::istreambuf_iterator<char>(in), {});
        const std::size_t at = text.find(line);
        REQUIRE(at != std::string::npos);
        std::ofstream(file) << text.substr(0, at) + replacement + text.substr(at + line.size());
    };
    const std::string line = "    const uvec3 bytes = uvec3(colour * 255 + 0.5);";
    copyOf("broken", line, "    const uvec3 bytes = nonsense;");
    copyOf("black", line, "    const uvec3 bytes = uvec3(0);");
    const std::string script = kSmall + clickOn(panel, {onMethod("Shaders", true), {0.9, 0.95}});
    writeCompilerOfChangedShaders(work.path / "tools");  // the first run has no such help
    const auto click = [&](const std::string& name, const std::string& folder, const std::string& more = " PATH=\"$PWD/tools:$PATH\"") {
        const ViewRun run = runView(work, name, script, kScene + withMethodPage(work) + " --shaders '" + folder + "'", kValidated + more);
        checkClean(run);
        return run;
    };
    // Away from the panel and the ray: the upper third of the right half.
    const auto sameAfterwards = [&](const ViewRun& run) {
        const Image before = run.eye(8, kRight), after = run.eye(18, kRight);
        std::size_t other = 0;
        for (std::size_t i = 0; i < before.pixelCount() / 3; ++i) {
            const std::size_t at = i * static_cast<std::size_t>(before.channels);
            other +=
                i % before.size_px.x > before.size_px.x / 2 && !std::equal(&before.values[at], &before.values[at] + 3, &after.values[at])
                    ? 1
                    : 0;
        }
        return other == 0;
    };
    const ViewRun good = click("good", sources.string(), "");
    std::size_t count = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(sources)) { count += file.path().extension() == ".comp" ? 1 : 0; }
    CHECK(says(good, fmt::format("{} shaders reloaded in ", count)));
    CHECK(sameAfterwards(good));
    const ViewRun bad = click("bad", "broken");
    CHECK(says(bad, "shaders stay as they were: broken/present/present.comp:"));
    CHECK(says(bad, "nonsense"));
    CHECK(sameAfterwards(bad));
    const ViewRun black = click("black-run", "black");
    CHECK(says(black, " shaders reloaded in "));
    CHECK_FALSE(sameAfterwards(black));
    CHECK(says(click("missing", "nowhere"), "shaders stay as they were: nowhere/sort/cull_pages.comp is not there"));
    // A pipe would keep the compiler, and the wearer, waiting.
    REQUIRE(work.runCommand("mkdir -p pipe/sort && mkfifo pipe/sort/cull_pages.comp").exit_code == 0);
    CHECK(says(click("pipe-run", "pipe"), "shaders stay as they were: pipe/sort/cull_pages.comp is not a file"));
}

TEST_CASE("nobody reloads shaders who was not told where they are") {
    const Workplace work;
    const Panel panel = startPanel(work);
    const std::string script = kBlind + clickOn(panel, {onMethod("Shaders", true), {0.9, 0.95}});
    const ViewRun run = runView(work, "none", script, kScene + withMethodPage(work), kValidated + " BINOSPLAT_SHADERS=");
    checkClean(run);
    CHECK_FALSE(says(run, "shaders"));
    const ViewRun told = runView(work, "told", script, kScene + withMethodPage(work), kValidated + " BINOSPLAT_SHADERS=nowhere");
    CHECK(says(told, "shaders stay as they were: nowhere/sort/cull_pages.comp is not there"));
}

}  // namespace view_panel_test
