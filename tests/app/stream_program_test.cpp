// The program with streamed scenes: what it shows within a budget of splats, what it says of that, and what it refuses.
#include "engine/picture/image_io.h"
#include "engine/scene/procedural.h"
#include "tests/engine/stream/split_scene.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

TEST_SUITE_BEGIN("stream_program");

namespace stream_program_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kCamera = " --size 96x96 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 --mode shared ";

// The atelier in 16 leaves of four levels, 16,000 splats at the finest.
struct Streamed : Workplace {
    Streamed() {
        splitScene(makeBuiltin("builtin:atelier", 16'000), (path / "split").string(),
                   {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    }
    [[nodiscard]] nlohmann::json report(const std::string& folder) const {
        std::ifstream file(path / folder / "report.json");
        return nlohmann::json::parse(file);
    }
    [[nodiscard]] std::string bytesOf(const std::string& name) const {
        std::ifstream file(path / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void checkRefused(const std::string& arguments, const std::string& part) const {
        const Outcome outcome = run(arguments);
        INFO("stderr: " << outcome.errors);
        CHECK(outcome.exit_code == 1);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(outcome.errors.find(part) != std::string::npos);
    }
};

const std::string kPicture = std::string("left") + extensionOf(PictureKind::kDisplay);

}  // namespace

TEST_CASE("a budget is what a picture's splats keep within, and the report counts them") {
    const Streamed work;
    for (const int budget : {3000, 8000}) {
        const Outcome outcome = work.run(fmt::format("render split{}--splat-budget {} --out {}", kCamera, budget, budget));
        INFO(outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        const nlohmann::json counters = work.report(std::to_string(budget))["counters"];
        CHECK(counters["splats_read"] <= budget);
        CHECK(counters["splats_read"] > budget / 4);
        CHECK(counters["splats_resident"] == counters["splats_read"]);
        CHECK(counters["chunks_resident"] == 16);
        CHECK(counters["frames_waited_for_loading"] == 0);
        CHECK(work.report(std::to_string(budget))["options"]["splat-budget"] == budget);
    }
    REQUIRE(work.run("render split/lod-meta.json" + kCamera + "--splat-budget 8000 --out again").exit_code == 0);
    CHECK(work.bytesOf("again/" + kPicture) == work.bytesOf("8000/" + kPicture));
    CHECK(work.bytesOf("3000/" + kPicture) != work.bytesOf("8000/" + kPicture));
}

TEST_CASE("without a budget a scene that fits is loaded whole, as its finest level is") {
    const Streamed work;
    REQUIRE(work.run("render split" + kCamera + "--out whole").exit_code == 0);
    REQUIRE(work.run("render split" + kCamera + "--lod 0 --out finest").exit_code == 0);
    CHECK(work.bytesOf("whole/" + kPicture) == work.bytesOf("finest/" + kPicture));
    CHECK_FALSE(work.report("whole")["counters"].contains("splats_resident"));
    CHECK(work.report("whole")["counters"]["splats_read"] == 16'000);
}

TEST_CASE("along a path each frame has what it asks for, and the program says how much that was") {
    const Streamed work;
    std::ofstream(work.path / "poses.csv")
        << "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n1,0,0,-1,0,0,0,1\n2,0,0,0,0,0.7071068,0,0.7071068\n";
    const Outcome outcome = work.run("render split" + kCamera + "--splat-budget 6000 --path poses.csv --out frames");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("splats drawn in a frame, of a budget of 6000") != std::string::npos);
    const nlohmann::json report = work.report("frames");
    for (const nlohmann::json& frame : report["frames"]) {
        CHECK(frame["counters"]["splats_read"] <= 6000);
        CHECK(frame["counters"]["frames_waited_for_loading"] == 0);
        CHECK(frame["counters"]["splats_read"] > 1500);
    }
    CHECK(report["frames"].size() == 3);
}

TEST_CASE("a bench with a budget measures what the view asks for") {
    const Streamed work;
    std::ofstream(work.path / "one.toml") << "[bench]\nmodes = [\"shared\"]\nscores = [\"none\"]\nwarm-up = 0\nrepeats = 1\n";
    const Outcome outcome = work.run("bench split --size 64x64 --splat-budget 5000 --config one.toml --out measured");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    std::ifstream file(work.path / "measured" / "bench.json");
    const nlohmann::json bench = nlohmann::json::parse(file);
    REQUIRE(!bench["results"].empty());
    for (const nlohmann::json& result : bench["results"]) {
        CHECK(result["counters"]["splats_read"] <= 5000);
        CHECK(result["counters"]["chunks_resident"] == 16);
    }
}

TEST_CASE("a budget of a scene without levels is refused, and one beside a level") {
    const Streamed work;
    work.checkRefused("render builtin:fence --splat-budget 100 --out out", "builtin:fence: has no levels of detail");
    work.checkRefused("render split --lod 1 --splat-budget 100 --out out", "lod 1 is one level, splat-budget chooses among all");
    work.checkRefused("bench split --orders --splat-budget 100 --out out", "which compare whole scenes");
    work.checkRefused("render nowhere --splat-budget 100 --out out", "nowhere: no such file");
    CHECK_FALSE(fs::exists(work.path / "out"));
}

TEST_CASE("a chunk that is missing is one line, and the picture is made of what is there") {
    const Streamed work;
    fs::remove(work.path / "split" / "0_1.sog");
    const Outcome outcome = work.run("render split" + kCamera + "--splat-budget 16000 --out part");
    CHECK(outcome.exit_code == 0);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.errors.find("0_1.sog is not there, expected a chunk of the scene; what is there stays") != std::string::npos);
    CHECK(work.report("part")["counters"]["chunks_resident"] == 16);
    // Even of the coarsest level.
    fs::remove(work.path / "split" / "3_0.sog");
    CHECK(work.run("render split" + kCamera + "--splat-budget 16000 --out less").exit_code == 0);
    CHECK(work.report("less")["counters"]["chunks_resident"] == 16);
}

}  // namespace stream_program_test
