// Facts about rendering along a path: numbered frames of both eyes, between poses too, and nothing half-written.
#include "engine/picture/image_io.h"
#include "engine/picture/metrics.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <set>

TEST_SUITE_BEGIN("path");

namespace path_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::string kRender = "render builtin:fence --size 64x48 --eye 0,0,0 --look 0,0,3 --up 0,-1,0 --fov-x 60 ";
// A tenth of a metre to the right and 20 degrees to the left in half a second, and back again in another one.
const std::string kPoses = fmt::format("time_s,x,y,z,qx,qy,qz,qw\n5,0,0,0,0,0,0,1\n5.5,0.1,0,0,0,{:.9f},0,{:.9f}\n6.5,0,0,0,0,0,0,1\n",
                                       std::sin(std::acos(-1.0) / 18.0), std::cos(std::acos(-1.0) / 18.0));

struct Way : Workplace {
    explicit Way(const std::string& poses = kPoses) { std::ofstream(path / "poses.csv") << poses; }

    [[nodiscard]] Outcome walk(const std::string& options, const std::string& environment = "") const {
        return run(kRender + "--path poses.csv --out frames " + options, environment);
    }
    void checkRefused(const std::string& options, int exit_code, const std::string& part) const {
        const Outcome outcome = walk(options);
        INFO("stderr: " << outcome.errors);
        CHECK(outcome.exit_code == exit_code);
        CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
        CHECK(outcome.errors.find(part) != std::string::npos);
        CHECK_FALSE(fs::exists(path / "frames"));
    }
    [[nodiscard]] std::set<std::string> written() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(path / "frames")) { names.insert(entry.path().filename().string()); }
        return names;
    }
    [[nodiscard]] nlohmann::json report() const {
        std::ifstream file(path / "frames" / "report.json");
        return nlohmann::json::parse(file);
    }
};

const std::string kExtension = extensionOf(PictureKind::kDisplay);

}  // namespace

TEST_CASE("every pose becomes a frame of both eyes, the same as one that is rendered there") {
    const Way way;
    const Outcome outcome = way.walk("--mode shared");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("3 frames along poses.csv") != std::string::npos);
    std::set<std::string> expected{"report.json"};
    for (const int frame : {0, 1, 2}) {
        for (const char* eye : {"left", "right"}) { expected.insert(fmt::format("frame_{:06}_{}{}", frame, eye, kExtension)); }
    }
    CHECK(way.written() == expected);
    const double turn = std::acos(-1.0) / 9.0;
    const std::string moved = fmt::format("--eye 0.1,0,0 --look {:.9f},0,{:.9f}", 0.1 - std::sin(turn), std::cos(turn));
    REQUIRE(way.run("render builtin:fence --size 64x48 --up 0,-1,0 --fov-x 60 --mode shared --out alone " + moved).exit_code == 0);
    REQUIRE(way.run(kRender + "--mode shared --out start").exit_code == 0);
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const auto frame = [&](int number) {
            return readPicture(way.path / "frames" / fmt::format("frame_{:06}_{}{}", number, eye, kExtension));
        };
        const Image start = readPicture(way.path / "start" / (eye + kExtension)),
                    alone = readPicture(way.path / "alone" / (eye + kExtension));
        CHECK(frame(0).values == start.values);
        CHECK(compare(frame(1), alone).psnrDb() > 50.0);
        CHECK(compare(frame(1), start).psnrDb() < 30.0);
        CHECK(compare(frame(2), start).psnrDb() > 50.0);
    }
}

TEST_CASE(
    "without a mode both eyes are made from their pasts, of which no frame is taken for blind, and roi_left and roi_right show the last "
    "one's tiles") {
    const Way way("time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.01,0,0,0,0,0,1\n0.2,0.02,0,0,0,0,0,1\n");
    const Outcome outcome = way.walk("");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find("temporal") != std::string::npos);
    CHECK(outcome.errors.empty());
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const Image shown = readPicture(way.path / "frames" / ("frame_000002_" + eye + kExtension)),
                    tinted = readPicture(way.path / "frames" / ("roi_" + eye + kExtension));
        const double db = compare(shown, tinted).psnrDb();
        CHECK(db > 5.0);
        CHECK(db < 40.0);  // some tiles were rendered again
    }
}

TEST_CASE("a headset's frusta go along the path") {
    const Way way;
    const std::string headset = "render builtin:one-splat --headset '" BINOSPLAT_SOURCE_DIR
                                "/configs/headsets/reverb_g2.toml' --size 64x48 "
                                "--mode two-pass --eye 0,0,0 --look 0,0,3 --up 0,-1,0 ";
    const Outcome outcome = way.run(headset + "--path poses.csv --out frames");
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    REQUIRE(way.run(headset + "--out start").exit_code == 0);
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const Image first = readPicture(way.path / "frames" / ("frame_000000_" + eye + kExtension));
        CHECK(first.values == readPicture(way.path / "start" / (eye + kExtension)).values);
        CHECK(first.values != readPicture(way.path / "frames" / ("frame_000001_" + eye + kExtension)).values);
    }
}

TEST_CASE("the report has what each frame took, and where its eyes were") {
    const Way way;
    REQUIRE(way.walk("--metres-per-unit 0.5").exit_code == 0);
    const nlohmann::json report = way.report();
    CHECK(report.at("options").at("path") == "poses.csv");
    CHECK(report.at("options").at("path-axes") == "openxr");
    CHECK(report.at("options").at("rate").is_null());
    REQUIRE(report.at("frames").size() == 3);
    const nlohmann::json& second = report.at("frames").at(1);
    CHECK(second.at("time_s") == doctest::Approx(0.5));
    // A tenth of a metre is 0.2 units here, and the eyes are 0.126 units apart.
    const auto x = [&](const char* eye) { return second.at("eyes").at(eye).at("position").at(0).get<double>(); };
    CHECK(0.5 * (x("left") + x("right")) == doctest::Approx(0.2));
    CHECK(x("right") - x("left") == doctest::Approx(0.126 * std::cos(std::acos(-1.0) / 9.0)));
    for (const nlohmann::json& frame : report.at("frames")) {
        CHECK(frame.at("gpu_total_ms") > 0.0);
        CHECK(frame.at("gpu_total_ms") <= report.at("most_gpu_total_ms"));
        CHECK(frame.at("counters").at("splats_read") > 0);
    }
}

TEST_CASE("a rate puts frames between the poses, turns by the great arc") {
    const Way way;
    REQUIRE(way.walk("--mode mono --rate 4").exit_code == 0);
    const nlohmann::json frames = way.report().at("frames");
    REQUIRE(frames.size() == 7);
    CHECK(way.written().size() == 8);
    CHECK(way.written().contains("frame_000006_mono" + kExtension));
    for (std::size_t i = 0; i < 7; ++i) {
        CAPTURE(i);
        CHECK(frames.at(i).at("time_s") == doctest::Approx(0.25 * static_cast<double>(i)));
        const double share = i < 2 ? 0.5 * static_cast<double>(i) : 1.5 - 0.25 * static_cast<double>(i);
        const nlohmann::json& eye = frames.at(i).at("eyes").at("mono");
        CHECK(eye.at("position").at(0) == doctest::Approx(0.1 * share));
        CHECK(std::abs(eye.at("orientation_wxyz").at(2).get<double>()) == doctest::Approx(std::sin(share * std::acos(-1.0) / 18.0)));
    }
}

TEST_CASE("a path may begin on the way, where the camera then stands, and end before its end") {
    const Way way;
    REQUIRE(way.walk("--mode mono --from 0.5 --seconds 0.5 --rate 4").exit_code == 0);
    const nlohmann::json frames = way.report().at("frames");
    REQUIRE(frames.size() == 2);
    CHECK(frames.at(0).at("time_s") == 0.0);
    CHECK(frames.at(0).at("eyes").at("mono").at("position").at(0) == doctest::Approx(0.0));
    CHECK(frames.at(0).at("eyes").at("mono").at("orientation_wxyz").at(2) == doctest::Approx(0.0));
    // A quarter of the way back, of which the head that looks 20 degrees aside sees that part as going aside.
    const double turn = std::acos(-1.0) / 9.0;
    CHECK(frames.at(1).at("time_s") == doctest::Approx(0.25));
    CHECK(frames.at(1).at("eyes").at("mono").at("position").at(0) == doctest::Approx(-0.025 * std::cos(turn)));
    CHECK(std::abs(frames.at(1).at("eyes").at("mono").at("orientation_wxyz").at(2).get<double>()) == doctest::Approx(std::sin(turn / 8.0)));
}

TEST_CASE("a recording in Unity's axes goes the other way") {
    const Way way("0,0,0,0,0,0,0,1\n1,0,0,0.5,0,0,0,1\n");
    const auto depth = [&](const std::string& axes) {
        REQUIRE(way.walk("--mode mono --path-axes " + axes).exit_code == 0);
        return way.report().at("frames").at(1).at("eyes").at("mono").at("position").at(2).get<double>();
    };
    CHECK(depth("openxr") == doctest::Approx(-0.5));
    CHECK(depth("unity") == doctest::Approx(0.5));
}

TEST_CASE("a path that cannot be used is one line and one, and leaves nothing") {
    Way("").checkRefused("", 1, "poses.csv: holds no poses");
    Way("time_s,x,y,z,qx,qy,qz,qw\n").checkRefused("", 1, "poses.csv: holds no poses");
    Way("0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0\n").checkRefused("", 1, "poses.csv:2: 7 columns, must be 8");
    Way("0,0,0,0,0,0,0,1\n1,0,nan,0,0,0,0,1\n").checkRefused("", 1, "poses.csv:2: y is nan");
    Way("0,0,0,0,0,0,0,1\n1000,0,0,0,0,0,0,1\n")
        .checkRefused("--rate 1000", 1, "makes 1000001 frames of --rate 1000, must be at most 1000000");
    const Way way;
    way.checkRefused("--rate 0", 1, "--rate is 0, must be");
    way.checkRefused("--from 2", 1, "poses.csv: --from is 2, must be at most 1.5, where the recording ends");
    way.checkRefused("--seconds 0", 1, "--seconds is 0, must be");
    way.checkRefused("--path-axes vulkan", 1, "--path-axes is vulkan");
    const Outcome missing = way.run(kRender + "--path nowhere.csv --out frames");
    CHECK(missing.exit_code == 1);
    CHECK(missing.errors.find("nowhere.csv") != std::string::npos);
    for (const std::string option : {"--rate 5", "--from 1", "--seconds 1", "--path-axes unity"}) {
        const Outcome alone = way.run(kRender + "--out frames " + option);
        CHECK(alone.exit_code == 2);
        CHECK(alone.errors.find("is given without --path") != std::string::npos);
    }
    CHECK_FALSE(fs::exists(way.path / "frames"));
}

TEST_CASE("frames of another path are not mixed with these, the same ones are replaced") {
    const Way way;
    REQUIRE(way.walk("--mode mono --rate 10").exit_code == 0);
    const std::set<std::string> before = way.written();
    const Outcome shorter = way.walk("--mode mono");
    CHECK(shorter.exit_code == 1);
    CHECK(shorter.errors.find("is a frame of another path") != std::string::npos);
    CHECK(way.written() == before);
    CHECK(way.walk("--mode shared --rate 10").exit_code == 1);
    std::ofstream(way.path / "frames" / "frame_notes.txt") << "mine";
    const Outcome again = way.walk("--mode mono --rate 10");
    INFO(again.errors);
    CHECK(again.exit_code == 0);
    CHECK(way.written().size() == before.size() + 1);
}

TEST_CASE("a signal on the way ends it with nothing written") {
    const Way way;
    // While the scene is uploaded, in the first frame, and in later ones.
    for (const int number : {1, 3, 6, 9}) {
        CAPTURE(number);
        const Outcome outcome = way.walk("", fmt::format("VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                                                         "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT=submit:{}:SIGINT",
                                                         number));
        INFO(outcome.errors);
        CHECK(outcome.exit_code == 130);
        CHECK(outcome.errors == "binosplat: stopped by SIGINT, nothing was written\n");
        CHECK_FALSE(fs::exists(way.path / "frames"));
    }
}

}  // namespace path_test
