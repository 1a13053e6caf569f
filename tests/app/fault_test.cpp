// Facts about machines that fail under the program: a device that is lost or full, a disk that is full, a signal. What fails, and where, a
// Vulkan layer says (tests/faults), or the shell's limit of file sizes; each time one line, its exit code, and nothing left behind.
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>

TEST_SUITE_BEGIN("fault");

namespace fault_test {

namespace fs = std::filesystem;
using namespace binosplat::test;

namespace {

const std::string kRender = "render builtin:slanted-wall --mode shared --size 64x48 --out out/pictures";
const std::string kBench = "bench builtin:slanted-wall --size 64x48 --out out/tables --config one.toml";

// The Nth call fails, or a signal comes with it.
std::string fault(const std::string& call, int number, const std::string& what) {
    return fmt::format("VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                       "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT={}:{}:{}",
                       call, number, what);
}

struct Machine : Workplace {
    Machine() { std::ofstream(path / "one.toml") << "[bench]\nmodes = [\"shared\"]\nscores = [\"psnr\"]\nwarm-up = 1\nrepeats = 2\n"; }

    // One line on stderr that holds `part`, and of the output nothing.
    void checkFails(const std::string& arguments, const std::string& environment, int exit_code, const std::string& part) const {
        CAPTURE(environment);
        const Outcome outcome = run(arguments, environment);
        INFO("stderr: " << outcome.errors);
        CHECK(outcome.exit_code == exit_code);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(outcome.errors.starts_with("binosplat: "));
        CHECK(outcome.errors.find(part) != std::string::npos);
        CHECK(leftOver() == std::set<std::string>{"one.toml"});
    }
    [[nodiscard]] std::set<std::string> leftOver() const {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(path)) { names.insert(fs::relative(entry.path(), path).string()); }
        return names;
    }
};

}  // namespace

TEST_CASE("without a fault the layer changes nothing") {
    const Machine machine;
    const Outcome outcome = machine.run(kRender, fault("submit", 1000000, "lost"));
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(fs::exists(machine.path / "out/pictures/left" BINOSPLAT_FLOAT_EXTENSION));
}

TEST_CASE("a lost device ends render and bench with three and one line") {
    const Machine machine;
    for (const int number : {1, 3}) {  // while the scene is uploaded, and later
        machine.checkFails(kRender, fault("submit", number, "lost"), 3, "the device was lost");
        machine.checkFails(kRender, fault("wait", number, "lost"), 3, "the device was lost");
    }
    machine.checkFails(kBench, fault("wait", 6, "lost"), 3, "the device was lost");
}

TEST_CASE("a device without memory ends with one and the buffer's name") {
    const Machine machine;
    for (const int number : {1, 4, 12}) {
        machine.checkFails(kRender, fault("allocate", number, "no-device-memory"), 1,
                           "MiB of device memory, which is more than it has free");
    }
    machine.checkFails(kRender, fault("allocate", 8, "no-host-memory"), 1, "MiB of device memory, which is more than it has free");
    machine.checkFails(kBench, fault("allocate", 30, "no-device-memory"), 1, "MiB of device memory, which is more than it has free");
    machine.checkFails(kRender, fault("submit", 2, "no-device-memory"), 1, "not enough memory for this scene and picture size");
}

TEST_CASE("a limit of device memory is kept, and named where it does not suffice") {
    const Machine machine;
    const std::string large = "render builtin:fence --size 512x512 --out out/pictures";
    machine.checkFails(large + " --memory-limit 1", "", 1, "MiB in use, the limit is 1.0 MiB (memory-limit)");
    machine.checkFails(kBench + " --memory-limit 1", "", 1, "MiB in use, the limit is 1.0 MiB (memory-limit)");
    machine.checkFails(large + " --memory-limit 0", "", 1, "--memory-limit is 0, must be a whole number from 1");
    std::ofstream(machine.path / "one.toml") << "[run]\nmemory_limit = 1\n";
    machine.checkFails(large + " --config one.toml", "", 1, "the limit is 1.0 MiB (memory-limit)");
    const Outcome enough = machine.run(large + " --memory-limit 200");
    INFO(enough.errors);
    CHECK(enough.exit_code == 0);
}

TEST_CASE("a signal ends render and bench as a shell expects, with nothing half-written") {
    const Machine machine;
    for (const int number : {1, 2, 4}) {  // while the scene is uploaded, in a frame, while pictures are read
        machine.checkFails(kRender, fault("submit", number, "SIGINT"), 130, "stopped by SIGINT, nothing was written");
    }
    machine.checkFails(kRender, fault("submit", 2, "SIGTERM"), 143, "stopped by SIGTERM, nothing was written");
    machine.checkFails(kBench, fault("submit", 5, "SIGINT"), 130, "stopped by SIGINT, nothing was written");
    machine.checkFails(kBench, fault("submit", 12, "SIGTERM"), 143, "stopped by SIGTERM, nothing was written");
}

TEST_CASE("on a full disk the message names the file, and no file is left") {
    // Files of so many blocks (512 bytes) at most: what goes beyond fails as on a full disk, if with another reason.
    const auto limit = [](int blocks) { return fmt::format("ulimit -f {};", blocks); };
    const Machine machine;
    const std::string picture = "left" BINOSPLAT_FLOAT_EXTENSION;
    for (const int blocks : {1, 4}) { machine.checkFails(kRender, limit(blocks), 1, picture + ": cannot be written ("); }
    machine.checkFails("render builtin:fence --size 1x1 --mode mono --out out/pictures", limit(2), 1, "report.json: cannot be written (");
    machine.checkFails(kBench, limit(1), 1, "bench.json: cannot be written (");
    machine.checkFails("scene fence --out fence.ply", limit(1), 1, "fence.ply: writing failed: ");
    machine.checkFails("scene atelier --splats 20000 --out atelier.ply", limit(4000), 1, "atelier.ply: writing failed: ");
    machine.checkFails("convert builtin:fence fence.ply", limit(1), 1, "fence.ply: writing failed: ");
    machine.checkFails("convert builtin:fence fence.spz", limit(1), 1, "fence.spz: writing failed: ");
}

#ifdef BINOSPLAT_OPENXR
TEST_CASE("faults end the viewer in its own line, behind what the runtime says") {
    const Machine machine;
    std::ofstream(machine.path / "small.script") << "size 64 64\n";
    const auto checkEnds = [&](const std::string& environment, int exit_code, const std::string& part) {
        CAPTURE(environment);
        const Outcome outcome =
            machine.run("view builtin:slanted-wall --mode mono --simulate small.script --load-first --frames 6 --out seen",
                        "DISPLAY= WAYLAND_DISPLAY= " + environment);
        INFO("stdout: " << outcome.output << " stderr: " << outcome.errors);
        CHECK(outcome.exit_code == exit_code);
        CHECK(outcome.errors.find(part) != std::string::npos);
        std::istringstream lines(outcome.errors);
        std::size_t own = 0;
        for (std::string line; std::getline(lines, line);) {
            const bool is_own = line.starts_with("binosplat: ");
            CHECK((is_own || line.starts_with("simulated runtime: ")));
            own += is_own;
        }
        CHECK(own == 1);
        for (const std::string& name : machine.leftOver()) { CHECK(name.find("unfinished") == std::string::npos); }
    };
    // The scene is on its way up beside the first frames, so it may be either side's call.
    checkEnds(fault("submit", 2, "lost"), 3, "DeviceLost");
    checkEnds(fault("wait", 12, "lost"), 3, "DeviceLost");
    checkEnds(fault("allocate", 1, "no-device-memory"), 1, "not enough memory for this scene and picture size");
    checkEnds("ulimit -f 1;", 3, "frames.jsonl: cannot be written");
}

TEST_CASE("SIGTERM ends the viewer as its wearer would") {
    const Machine machine;
    std::ofstream(machine.path / "small.script") << "size 64 64\n";
    const Outcome outcome = machine.run("view builtin:slanted-wall --mode mono --simulate small.script --load-first --out seen",
                                        "DISPLAY= WAYLAND_DISPLAY= " + fault("submit", 30, "SIGTERM"));
    INFO("stdout: " << outcome.output << " stderr: " << outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.output.find("the runtime asked for the end") != std::string::npos);
    CHECK(outcome.errors.empty());
}
#endif

}  // namespace fault_test
