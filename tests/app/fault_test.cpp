// Facts about machines that fail under the program: a device that is lost or full, a full disk, a signal. A
// Vulkan layer (tests/faults) or the shell's limit of file sizes makes the failure. Each time the program
// prints one line, ends with the right exit code and leaves nothing behind.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "engine/places/standpoint.h"
#include "tests/app/program_script.h"

SUITE(fault) {

struct Machine : Workplace {
    Machine() {
        write("one.toml", "[bench]\nmodes = [\"shared\"]\nscores = [\"psnr\"]\nwarm-up = 1\nrepeats = 2\n");
        write("full.toml", "[run]\nmemory_limit = 1\n");
        write("small.script", "size 64 64\n");
    }
};

SCRIPT(fault, "app/fault") {
    const Machine machine;
    const std::string render = "render builtin:slanted-wall --size 64x48 --out out/pictures --mode ";
    ScriptHost host = programIn(machine);
    host.names.merge(std::map<std::string, std::string>{
        {"MONO", render + "mono"},
        {"SHARED", render + "shared"},
        {"BENCH", "bench builtin:slanted-wall --size 64x48 --out out/tables --config one.toml"},
        {"LOST", "the device was lost"},
        {"FULL", "MiB of device memory, which is more than it has free"},
        {"STOPPED", "stopped by SIGINT, nothing was written"},
        {"ENDED", "stopped by SIGTERM, nothing was written"},
        {"KEPT", "files full.toml one.toml small.script"}});
    runScript(host);
}

#ifdef BINOSPLAT_LIBRARY_USER

// What tests/app/library_user.cpp says of its second scene when the Nth allocation fails, and of the pictures
// after it; empty if there was no Nth allocation.
std::string loadWithout(const Machine& machine, int number) {
    CAPTURE(number);
    const Outcome outcome = machine.runCommand(fault("allocate", number, "no-device-memory-once") +
                                               " '" BINOSPLAT_LIBRARY_USER "'");
    INFO(outcome.output << outcome.errors);
    if (outcome.exit_code == 1) { return ""; }
    REQUIRE(outcome.exit_code == 0);
    CHECK((outcome.output == "loaded\n" || outcome.output.ends_with("\nthe same pictures\n")));
    return outcome.output;
}

TEST_CASE_FIXTURE(Machine, "the library draws a small scene from nearby, and one far from 0 where it is") {
    struct Seen {
        double share = 0.0;
        glm::dvec3 from{0.0};
    };
    // An atelier scaled to this size.
    const auto look = [&](double size, const glm::dvec3& at) {
        Scene scene = makeBuiltin("builtin:atelier", 3000);
        const double factor = size / coreSize(scene);
        for (glm::vec3& position : scene.positions) { position *= static_cast<float>(factor); }
        for (glm::vec2& scale : scene.scales) { scale *= static_cast<float>(factor); }
        scene.origin = at;
        writePly(scene, (path / "scene.ply").string());
        const Outcome outcome = runCommand("'" BINOSPLAT_LIBRARY_USER "' scene.ply");
        INFO(outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        Seen seen;
        std::istringstream(outcome.output) >> seen.share >> seen.from.x >> seen.from.y >> seen.from.z;
        return seen;
    };
    const Seen large = look(8.0, glm::dvec3(0.0)), small = look(0.08, glm::dvec3(0.0));
    CHECK(large.share > 0.5);
    CHECK(small.share == doctest::Approx(large.share).epsilon(0.1));
    const glm::dvec3 away(500'000.0, -4'200'000.0, 0.0);
    const Seen far = look(8.0, away);
    CHECK(far.share == doctest::Approx(large.share).epsilon(0.01));
    CHECK(glm::distance(far.from - away, large.from) < 0.01);
}

TEST_CASE("a scene for which the library's frame finds no room leaves the scene before as it was") {
    CHECK(loadWithout(Machine(), 32).find("visibility needs ") != std::string::npos);
}

TEST_CASE("wherever the memory for it ends it does so" * nightly()) {
    const Machine machine;
    int failed = 0;
    for (int number = 1;; ++number) {
        const std::string said = loadWithout(machine, number);
        if (said == "loaded\n") { break; }
        failed += said.empty() ? 0 : 1;
    }
    CHECK(failed >= 3);
}
#endif

#ifdef BINOSPLAT_OPENXR
TEST_CASE_FIXTURE(Machine,
                  "faults end the viewer with a line of its own, SIGTERM ends it as its wearer would") {
    const std::string view =
        "view builtin:slanted-wall --mode mono --simulate small.script --load-first --out seen";
    const std::string no_display = "DISPLAY= WAYLAND_DISPLAY= ";
    const auto checkEnds = [&](const std::string& environment, int exit_code, const std::string& part) {
        CAPTURE(environment);
        const Outcome outcome = run(view + " --frames 6", no_display + environment);
        INFO("stdout: " << outcome.output << " stderr: " << outcome.errors);
        CHECK(outcome.exit_code == exit_code);
        CHECK(outcome.errors.find(part) != std::string::npos);
        std::size_t own = 0;
        for (const std::string& line : linesIn(outcome.errors)) {
            const bool is_own = line.starts_with("binosplat: ");
            CHECK((is_own || line.starts_with("simulated runtime: ")));
            own += is_own;
        }
        CHECK(own == 1);
        for (const std::string& name : files()) { CHECK(name.find("unfinished") == std::string::npos); }
    };
    // The scene is uploaded beside the first frames, so the call may belong to either.
    checkEnds(fault("submit", 2, "lost"), 3, "DeviceLost");
    checkEnds(fault("wait", 12, "lost"), 3, "DeviceLost");
    checkEnds(fault("allocate", 1, "no-device-memory"), 1,
              "not enough memory for this scene and picture size");
    checkEnds("ulimit -f 1;", 3, "frames.jsonl: cannot be written");
    const Outcome ended = go(view, no_display + fault("submit", 30, "SIGTERM"));
    CHECK(ended.output.find("the runtime asked for the end") != std::string::npos);
    CHECK(ended.errors.empty());
}
#endif

}  // SUITE(fault)
