// The program with moving scenes: pictures along a path, what is reported, and what is refused.
#include "engine/picture/image_io.h"
#include "tests/engine/stream/moving_frames.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>

TEST_SUITE_BEGIN("moving_program");

namespace moving_program_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kCamera = " --size 96x96 --eye 0.4,-1.6,0.6 --look 0,-1.1,4 --up 0,-1,0 ";
constexpr int kFrames = 5;

struct Sliding : Workplace {
    Sliding() {
        writeSliding((path / "slide").string(), kFrames, 4000);
        std::ofstream still(path / "still.csv");
        still << "timestamp_us,x,y,z,qx,qy,qz,qw\n";
        for (int i = 0; i <= 10; ++i) { still << 100000 * i << ",0,0,0,0,0,0,1\n"; }
    }
    [[nodiscard]] nlohmann::json report(const std::string& folder) const {
        std::ifstream file(path / folder / "report.json");
        return nlohmann::json::parse(file);
    }
    [[nodiscard]] std::string bytesOf(const std::string& name) const {
        std::ifstream file(path / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void go(const std::string& arguments) const {
        const Outcome outcome = run(arguments);
        INFO("stderr: " << outcome.errors);
        REQUIRE(outcome.exit_code == 0);
    }
    void checkRefused(const std::string& arguments, const std::string& part) const {
        const Outcome outcome = run(arguments);
        INFO("stderr: " << outcome.errors);
        CHECK(outcome.exit_code == 1);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(outcome.errors.find(part) != std::string::npos);
    }
    // As render makes them of one file.
    [[nodiscard]] std::string pictureOfFrame(int frame, const std::string& name) const {
        const std::string out = fmt::format("whole{}", frame);
        if (!fs::exists(path / out)) { go(fmt::format("render slide/frame_{:04}.ply{}--mode shared --out {}", frame + 1, kCamera, out)); }
        return bytesOf(out + "/" + name);
    }
};

const std::string kEnd = extensionOf(PictureKind::kDisplay);

}  // namespace

TEST_CASE("a picture shows the first frame, and along a path time goes on with the frames, around and around") {
    const Sliding work;
    work.go("render slide" + kCamera + "--mode shared --out first");
    CHECK(work.bytesOf("first/left" + kEnd) == work.pictureOfFrame(0, "left" + kEnd));
    CHECK(work.report("first")["counters"]["scene_frames_late"] == 0);
    CHECK(work.report("first")["options"]["scene-rate"] == 30.0);

    work.go("render slide" + kCamera + "--mode shared --path still.csv --rate 10 --scene-rate 10 --out path");
    for (int i = 0; i < 11; ++i) {
        CAPTURE(i);
        CHECK(work.bytesOf(fmt::format("path/frame_{:06}_left{}", i, kEnd)) == work.pictureOfFrame(i % kFrames, "left" + kEnd));
    }
    CHECK(work.report("path")["frames"][3]["counters"]["splats_resident"] == 4000);
    // Half as fast, from the middle on: time begins where the path does.
    work.go("render slide" + kCamera + "--mode shared --path still.csv --from 0.5 --rate 10 --scene-rate 5 --out half");
    for (int i = 0; i < 6; ++i) {
        CHECK(work.bytesOf(fmt::format("half/frame_{:06}_right{}", i, kEnd)) == work.pictureOfFrame(i / 2, "right" + kEnd));
    }
    // What lies between.
    work.go("render slide" + kCamera + "--mode shared --path still.csv --rate 10 --scene-rate 5 --scene-blend --out blend");
    CHECK(work.bytesOf("blend/frame_000002_left" + kEnd) == work.pictureOfFrame(1, "left" + kEnd));
    CHECK(work.bytesOf("blend/frame_000003_left" + kEnd) != work.pictureOfFrame(1, "left" + kEnd));
    CHECK(work.bytesOf("blend/frame_000003_left" + kEnd) != work.pictureOfFrame(2, "left" + kEnd));
}

TEST_CASE("bench measures a moving scene along a motion, and other commands take its first frame") {
    const Sliding work;
    std::ofstream(work.path / "methods.toml") << "[bench]\nmodes = [\"two-pass\", \"predicted\", \"temporal\"]\nrepeats = 2\n";
    work.go("bench slide" + kCamera + "--config methods.toml --motion still.csv --rate 10 --scene-rate 10 --seconds 0.4 --out moved");
    const std::string csv = work.bytesOf("moved/motion.csv");
    CHECK(csv.find(",scene_frames_late,moved_share,psnr_moved_db\n") != std::string::npos);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 4 * 4);
    work.go("bench slide" + kCamera + "--config methods.toml --out still");
    work.go("convert slide first.ply");
    work.go("convert slide/frame_0001.ply same.ply");
    CHECK(work.bytesOf("first.ply") == work.bytesOf("same.ply"));
    CHECK(work.run("info slide").output.find("4000") != std::string::npos);
}

TEST_CASE("hostile folders end in one line") {
    const Sliding work;
    const std::string path = " --mode shared --path still.csv --rate 10 --scene-rate 10 --out out";
    // Nobody who does not come to it is told of a broken file.
    std::ofstream(work.path / "slide/frame_0004.ply", std::ios::binary | std::ios::trunc)
        << "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n";
    work.checkRefused("render slide" + kCamera + path, "frame_0004.ply");
    CHECK_FALSE(fs::exists(work.path / "out"));
    work.go("render slide" + kCamera + "--mode shared --path still.csv --rate 10 --seconds 0.1 --scene-rate 10 --out begin");
    // Of another format, or another kind of splat.
    std::ofstream(work.path / "slide/frame_0004.ply", std::ios::binary | std::ios::trunc) << std::string(32, '\x40');
    work.checkRefused("render slide" + kCamera + path, "frame_0004.ply");
    fs::remove(work.path / "slide/frame_0004.ply");
    work.go("render slide" + kCamera + path);
    CHECK(work.run("render slide" + kCamera + path).output.find("1 of 5 numbered files are missing, the first after frame_0003.ply") !=
          std::string::npos);
    CHECK(work.bytesOf("out/frame_000003_left" + kEnd) == work.pictureOfFrame(2, "left" + kEnd));
    for (const int frame : {1, 2, 3, 5}) {
        fs::rename(work.path / fmt::format("slide/frame_{:04}.ply", frame), work.path / fmt::format("slide/{}", frame));
    }
    work.go("render slide" + kCamera + "--mode shared --out out2");
    for (const char* bad : {"0", "-1", "nan", "fast"}) {
        CHECK(work.run(fmt::format("render slide{}--out o --scene-rate {}", kCamera, bad)).exit_code != 0);
    }
    work.checkRefused("render slide" + kCamera + "--splat-budget 100 --out o", "no levels of detail");
    work.checkRefused("render slide" + kCamera + "--lod 1 --out o", "no levels of detail");
}

}  // namespace moving_program_test
