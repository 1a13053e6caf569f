// Where the panel stands and what lies on it, as docs/simulated_script.md says it to those who write scripts.
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_runs.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <iterator>
#include <regex>

TEST_SUITE_BEGIN("view_panel_place");

namespace view_panel_place_test {

using namespace binosplat::test;

namespace {

std::string pageText() {
    std::ifstream stream(std::string(BINOSPLAT_SOURCE_DIR) + "/docs/simulated_script.md");
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("the documented line of a script clicks on Quit, on a panel of the documented place and size") {
    const std::string page = pageText();
    std::smatch pointing, clicking;
    REQUIRE(std::regex_search(page, pointing, std::regex("`(controller right 0 [^`]* look [^`]*)`")));
    REQUIRE(std::regex_search(page, clicking, std::regex("`(press right trigger [^`]*)`")));
    const Workplace work;
    const std::string script =
        "rate 90\nsize 64 64\nframes none\ncontroller left 0 turn 0 -80\n" + pointing[1].str() + "\n" + clicking[1].str() + "\nat 3 exit\n";
    const ViewRun run = runView(work, "quit", script, "builtin:slanted-wall --load-first --mode mono");
    checkClean(run);
    CHECK(run.frames.size() > 18);
    CHECK(run.frames.size() < 60);
    const nlohmann::json quad = run.layers(8, "quad").at(0);
    const auto place = quad.at("pose").at("position").get<std::array<double, 3>>();
    const auto room = quad.at("stage_from_space").at("position").get<std::array<double, 3>>();
    const auto size = quad.at("size").get<std::array<double, 2>>();
    CHECK(page.find("the middle is at -0.45 1.5 -0.9") != std::string::npos);
    CHECK(page.find("0.468 m wide and 0.585 m high") != std::string::npos);
    CHECK(glm::length(glm::dvec3(place[0] + room[0], place[1] + room[1], place[2] + room[2]) - glm::dvec3(-0.45, 1.5, -0.9)) < 1e-5);
    CHECK(std::abs(size[0] - 0.468) < 1e-6);
    CHECK(std::abs(size[1] - 0.585) < 1e-6);
}

TEST_CASE("the documented places of widgets are where they are") {
    const std::string page = pageText();
    const std::regex row("\\n\\| \\*([^*|]+)\\* \\| ([0-9.]+) \\| ([0-9.]+) \\|");
    std::size_t rows = 0;
    for (std::sregex_iterator match(page.begin(), page.end(), row); match != std::sregex_iterator{}; ++match, ++rows) {
        const std::string name = (*match)[1];
        CAPTURE(name);
        const bool is_on_method = static_cast<std::size_t>(match->position()) > page.find("The page *Method* has");
        const glm::dvec2 place = is_on_method ? onMethod(name, true) : placeOf(name, true),
                         said(std::stod((*match)[2]), std::stod((*match)[3]));
        CAPTURE(place.x);
        CAPTURE(place.y);
        CHECK(glm::length(place - said) < 0.003);
    }
    CHECK(rows >= 40);
}

TEST_CASE("what the command line says of the simulated headset counts before the environment") {
    const Workplace work;
    const ViewRun run = runView(work, "own", "size 64 64\nframes none\nat 0.1 exit\n", "builtin:slanted-wall --load-first --mode mono",
                                kValidated + " SIMULATED_OPENXR_OUT=elsewhere SIMULATED_OPENXR_SCRIPT=nowhere.script");
    checkClean(run);
    CHECK(run.frames.size() > 8);
    CHECK_FALSE(std::filesystem::exists(work.path / "elsewhere"));
}

}  // namespace view_panel_place_test
