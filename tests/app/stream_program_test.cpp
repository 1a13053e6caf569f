// The program with streamed scenes: what it shows within a budget of splats, what it says of that, and what it refuses.
#include "engine/builtin/procedural.h"
#include "engine/picture/image_io.h"
#include "tests/engine/stream/split_scene.h"
#include "tests/run_program.h"

SUITE(stream_program) {

const std::string kCamera = " --size 64x64 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 --mode shared ";

// The atelier in 16 leaves of four levels, 16,000 splats at the finest.
struct Streamed : Workplace {
    Streamed() {
        splitScene(makeBuiltin("builtin:atelier", 16'000), (path / "split").string(),
                   {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    }
    [[nodiscard]] nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(bytesOf(file)); }
    [[nodiscard]] nlohmann::json counters(const std::string& folder) const { return json(folder + "/report.json")["counters"]; }
    [[nodiscard]] std::string picture(const std::string& folder) const {
        return bytesOf(folder + "/left" + extensionOf(PictureKind::kDisplay));
    }
};

TEST_CASE("a budget is what the splats of a picture keep within, of a path and of a bench, and without one the scene is loaded whole") {
    const Streamed work;
    for (const int budget : {3000, 8000}) {
        work.go(fmt::format("render split{}--splat-budget {} --out {}", kCamera, budget, budget));
        const nlohmann::json counters = work.counters(std::to_string(budget));
        CHECK(counters["splats_read"] <= budget);
        CHECK(counters["splats_read"] > budget / 4);
        CHECK(these(counters["splats_resident"], counters["chunks_resident"], counters["frames_waited_for_loading"]) ==
              these(counters["splats_read"], 16, 0));
    }
    CHECK(work.json("8000/report.json")["options"]["splat-budget"] == 8000);
    work.go("render split/lod-meta.json" + kCamera + "--splat-budget 8000 --out again");
    CHECK(work.picture("again") == work.picture("8000"));
    CHECK(work.picture("3000") != work.picture("8000"));

    work.write("poses.csv", "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n1,0,0,-1,0,0,0,1\n2,0,0,0,0,0.7071068,0,0.7071068\n");
    const Outcome walked = work.go("render split" + kCamera + "--splat-budget 6000 --path poses.csv --out frames");
    CHECK(walked.output.find("splats drawn in a frame, of a budget of 6000") != std::string::npos);
    const nlohmann::json frames = work.json("frames/report.json")["frames"];
    for (const nlohmann::json& frame : frames) {
        CHECK(frame["counters"]["splats_read"] <= 6000);
        CHECK(frame["counters"]["frames_waited_for_loading"] == 0);
        CHECK(frame["counters"]["splats_read"] > 1500);
    }
    CHECK(frames.size() == 3);

    work.write("one.toml", "[bench]\nmodes = [\"shared\"]\nscores = [\"none\"]\nwarm-up = 0\nrepeats = 1\n");
    work.go("bench split --size 64x64 --splat-budget 5000 --config one.toml --out measured");
    const nlohmann::json results = work.json("measured/bench.json")["results"];
    REQUIRE(!results.empty());
    for (const nlohmann::json& result : results) {
        CHECK(result["counters"]["splats_read"] <= 5000);
        CHECK(result["counters"]["chunks_resident"] == 16);
    }

    work.go("render split" + kCamera + "--out whole");
    work.go("render split" + kCamera + "--lod 0 --out finest");
    CHECK(these(work.picture("whole"), work.counters("whole").contains("splats_resident"), work.counters("whole")["splats_read"]) ==
          these(work.picture("finest"), false, 16'000));
}

TEST_CASE_FIXTURE(Streamed, "a budget is refused of a scene without levels and beside a level, and a chunk that is missing is one line") {
    checkRefused("render builtin:fence --splat-budget 100 --out out", 1, "builtin:fence: has no levels of detail");
    checkRefused("render split --lod 1 --splat-budget 100 --out out", 1, "lod 1 is one level, splat-budget chooses among all");
    checkRefused("bench split --orders --splat-budget 100 --out out", 1, "which compare whole scenes");
    checkRefused("render nowhere --splat-budget 100 --out out", 1, "nowhere: no such file");
    CHECK_FALSE(holds("out"));
    std::filesystem::remove(path / "split" / "0_1.sog");
    const Outcome outcome = go("render split" + kCamera + "--splat-budget 16000 --out part");
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.errors.find("0_1.sog is not there, expected a chunk of the scene; what is there stays") != std::string::npos);
    CHECK(counters("part")["chunks_resident"] == 16);
    // Even of the coarsest level.
    std::filesystem::remove(path / "split" / "3_0.sog");
    go("render split" + kCamera + "--splat-budget 16000 --out less");
    CHECK(counters("less")["chunks_resident"] == 16);
}

}  // SUITE(stream_program)
