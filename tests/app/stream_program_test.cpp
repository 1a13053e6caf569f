// stream_program_test.txt, with the atelier in 16 leaves of four levels, 16,000 splats at the finest.
#include "engine/builtin/procedural.h"
#include "tests/app/program_script.h"
#include "tests/engine/stream/split_scene.h"

SUITE(stream_program) {

SCRIPT(stream_program, "app/stream_program") {
    const Workplace work;
    splitScene(makeBuiltin("builtin:atelier", 16'000), (work.path / "split").string(),
               {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    ScriptHost host = programIn(work);
    host.names["CAMERA"] = "--size 64x64 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 --mode shared";
    runScript(host);
}

}  // SUITE(stream_program)
