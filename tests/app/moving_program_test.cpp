// moving_program_test.txt, with four frames of 2000 sliding splats and a head that stands still.
#include "tests/app/program_script.h"
#include "tests/engine/stream/moving_frames.h"

SUITE(moving_program) {

SCRIPT(moving_program, "app/moving_program") {
    const Workplace work;
    writeSliding((work.path / "slide").string(), 4, 2000);
    std::string still = "timestamp_us,x,y,z,qx,qy,qz,qw\n";
    for (int i = 0; i <= 4; ++i) { still += fmt::format("{},0,0,0,0,0,0,1\n", 100000 * i); }
    work.write("still.csv", still);
    const std::string place = "--size 64x64 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 ",
                      camera = place + "--mode shared ";
    ScriptHost host = programIn(work);
    host.names["CAMERA"] = camera;
    host.names["PATH"] = camera + "--path still.csv --rate 10";
    host.names["BENCH"] = place + "--config few.toml";
    runScript(host);
}

}  // SUITE(moving_program)
