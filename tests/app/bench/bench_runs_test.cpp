// bench_runs_test.txt, and how a bench ends when frames are limited to almost no time.
#include "tests/app/bench/benches.h"
#include "tests/app/program_script.h"
#include "tests/app/scores/lpips_weights.h"

SUITE(bench_runs) {

// A short walk, and a camera whose photograph is a render of the scene, seen by one eye in the middle.
struct Walk : Bench {
    Walk() {
        write("m.csv",
              "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.02,0,0,0,0,0,1\n0.2,0.04,0,0,0,0,0,1\n");
        write("c.json",
              R"([{"img_name": "a", "width": 48, "height": 40, "fx": 48, "fy": 48, "position": [0,0,0],
                             "rotation": [[1,0,0],[0,1,0],[0,0,1]]}])");
        writeFloats(path / "w.bin", makeLpipsWeights(9));
    }
};

// front: one of the first two results lies on the Pareto front of time and error.
SCRIPT(bench_runs, "app/bench/bench_runs") {
    const Walk bench;
    ScriptHost host = programIn(bench);
    const std::string motion = "--motion m.csv --from 0.1 --seconds 0.1 --rate 40 --out out",
                      extension = host.names.at("DISPLAYED");
    host.names["MOTION"] = "bench builtin:step-edge --size 48x48 --config b.toml " + motion;
    host.names["PHOTOS"] =
        "bench builtin:step-edge --cameras c.json --config b.toml --photos photos --out out";
    host.names["PHOTOGRAPH"] = "> render builtin:step-edge --cameras c.json --mode mono --out photo";
    host.names["HUNG"] = fmt::format("$ mkdir photos && mv photo/mono{0} photos/a{0}", extension);
    host.verbs["front"] = [&](const std::string&) {
        const nlohmann::json results = bench.results("out/bench.json");
        CHECK((results[0]["on_front"] == true || results[1]["on_front"] == true));
    };
    runScript(host);
}

TEST_CASE("where frames may take next to nothing the controller lowers resolution and bound, and says so") {
    const Walk bench;
    bench.write("b.toml",
                "[bench]\nmodes = [\"temporal\"]\nwarm-up = 0\n[[methods]]\nname = \"at will\"\n"
                "mode = \"temporal\"\nframe-time = 0\n");
    const std::string play =
        "bench builtin:step-edge --size 48x48 --config b.toml --motion m.csv --rate 60 --out ";
    for (const std::string limit : {"0.001", "1%"}) {
        CAPTURE(limit);
        bench.go(play + "out --frame-time " + limit);
        std::vector<std::string> ends;
        for (const std::string& row : linesIn(bench.bytesOf("out/motion.csv"))) {
            if (contains(row, ",temporal,temporal,")) { ends.push_back(row); }
            CHECK((ends.size() > 0 || row.ends_with("error_bound_db") || row.ends_with(",,")));
        }
        REQUIRE(ends.size() >= 10);
        CHECK(ends.front().ends_with(",1,30"));
        CHECK(ends.back().ends_with(",0.6,20"));
    }
    bench.checkRefused(play + "none --frame-time 0%", 1, "--frame-time is 0%, must be a number of ms");
    bench.checkRefused("bench builtin:step-edge --frame-time 5 --out none", 2, "without --motion");
}

}  // SUITE(bench_runs)
