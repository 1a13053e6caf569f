// See bench_runs_test.txt.
#include "tests/app/bench/benches.h"
#include "tests/app/camera_file.h"
#include "tests/app/program_script.h"
#include "tests/app/scores/lpips_weights.h"

SUITE(bench_runs) {

// A short walk, and a camera whose photograph is a render of the scene, seen by one eye in the middle.
struct Walk : Bench {
    Walk() {
        write("m.csv",
              "time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.02,0,0,0,0,0,1\n0.2,0.04,0,0,0,0,0,1\n");
        write("c.json", "[" + cameraJson("a", {0, 0, 0}, kNotTurned, {48, 40}, 48.0) + "]");
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

}  // SUITE(bench_runs)
