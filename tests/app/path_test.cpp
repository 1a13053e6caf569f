// Facts about rendering along a path: numbered frames of both eyes, between poses too, and nothing half-written.
#include "app/scores/metrics.h"
#include "engine/picture/image_io.h"
#include "tests/run_program.h"

SUITE(path) {

const double kPi = std::acos(-1.0);
const std::string kScene = "render builtin:fence --size 64x48 --up 0,-1,0 --fov-x 60 ";
const std::string kRender = kScene + "--eye 0,0,0 --look 0,0,3 ";
// A tenth of a metre to the right and 20 degrees to the left in half a second, and back again in another one.
const std::string kPoses = fmt::format("time_s,x,y,z,qx,qy,qz,qw\n5,0,0,0,0,0,0,1\n5.5,0.1,0,0,0,{:.9f},0,{:.9f}\n6.5,0,0,0,0,0,0,1\n",
                                       std::sin(kPi / 18.0), std::cos(kPi / 18.0));
const std::string kExtension = extensionOf(PictureKind::kDisplay);

struct Way : Workplace {
    explicit Way(const std::string& poses = kPoses) { write("poses.csv", poses); }

    Outcome walk(const std::string& options) const { return go(kRender + "--path poses.csv --out frames " + options); }
    void checkNoWay(const std::string& options, int exit_code, const std::string& part, const std::string& environment = "") const {
        checkRefused(kRender + "--path poses.csv --out frames " + options, exit_code, part, environment);
        CHECK(files() == std::set<std::string>{"poses.csv"});
    }
    [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(bytesOf("frames/report.json")); }
    [[nodiscard]] Image picture(const std::string& name) const { return readPicture(path / (name + kExtension)); }
};

TEST_CASE_FIXTURE(Way, "every pose becomes a frame of both eyes, the same as one that is rendered there") {
    CHECK(walk("--mode shared").output.find("3 frames along poses.csv") != std::string::npos);
    std::set<std::string> expected{"poses.csv", "frames", "frames/report.json"};
    for (const int frame : {0, 1, 2}) {
        for (const char* eye : {"left", "right"}) { expected.insert(fmt::format("frames/frame_{:06}_{}{}", frame, eye, kExtension)); }
    }
    CHECK(files() == expected);
    const double turn = kPi / 9.0;
    go(kScene + fmt::format("--mode shared --out alone --eye 0.1,0,0 --look {:.9f},0,{:.9f}", 0.1 - std::sin(turn), std::cos(turn)));
    go(kRender + "--mode shared --out start");
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const auto frame = [&](int number) { return picture(fmt::format("frames/frame_{:06}_{}", number, eye)); };
        const Image start = picture("start/" + eye);
        CHECK(frame(0).values == start.values);
        CHECK(compare(frame(1), picture("alone/" + eye)).psnrDb() > 50.0);
        CHECK(compare(frame(1), start).psnrDb() < 30.0);
        CHECK(compare(frame(2), start).psnrDb() > 50.0);
    }
}

TEST_CASE("without a mode both eyes are made from their pasts, of which no frame is taken for blind, and the report has what each took") {
    const Way way("time_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.1,0.01,0,0,0,0,0,1\n0.2,0.02,0,0,0,0,0,1\n");
    const Outcome outcome = way.walk("");
    CHECK(outcome.output.find("temporal") != std::string::npos);
    CHECK(outcome.errors.empty());
    // Tinted by how the last one's tiles were made.
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const double db = compare(way.picture("frames/frame_000002_" + eye), way.picture("frames/roi_" + eye)).psnrDb();
        CHECK(db > 5.0);
        CHECK(db < 40.0);  // some tiles were rendered again
    }
    const nlohmann::json report = way.report();
    CHECK(these(report.at("options").at("path"), report.at("options").at("path-axes")) == these("poses.csv", "openxr"));
    CHECK(report.at("options").at("rate").is_null());
    REQUIRE(report.at("frames").size() == 3);
    CHECK(report.at("frames").at(1).at("time_s") == doctest::Approx(0.1));
    for (const nlohmann::json& frame : report.at("frames")) {
        CHECK(frame.at("gpu_total_ms") > 0.0);
        CHECK(frame.at("gpu_total_ms") <= report.at("most_gpu_total_ms"));
        CHECK(frame.at("counters").at("splats_read") > 0);
    }
}

TEST_CASE("a headset's frusta go along the path, in metres, and a recording in Unity's axes goes the other way") {
    const Way way("0,0,0,0,0,0,0,1\n1,0,0,0.5,0,0,0,1\n");
    const std::string headset = "render builtin:one-splat --headset '" BINOSPLAT_SOURCE_DIR
                                "/configs/headsets/reverb_g2.toml' --size 64x48 "
                                "--mode two-pass --eye 0,0,0 --look 0,0,3 --up 0,-1,0 --ipd 0.063 --metres-per-unit 0.5 ";
    way.go(headset + "--out start");
    for (const std::string axes : {"unity", "openxr"}) {
        way.go(headset + "--path poses.csv --out frames --path-axes " + axes);
        const nlohmann::json eyes = way.report().at("frames").at(1).at("eyes");
        const auto at = [&](const char* eye, int axis) { return eyes.at(eye).at("position").at(axis).get<double>(); };
        // Half a metre is a unit here, and the eyes are 0.126 units apart.
        CHECK(0.5 * (at("left", 2) + at("right", 2)) == doctest::Approx(axes == "unity" ? 1.0 : -1.0));
        CHECK(at("right", 0) - at("left", 0) == doctest::Approx(0.126));
    }
    for (const std::string eye : {"left", "right"}) {
        CAPTURE(eye);
        const Image first = way.picture("frames/frame_000000_" + eye);
        CHECK(first.values == way.picture("start/" + eye).values);
        CHECK(first.values != way.picture("frames/frame_000001_" + eye).values);
    }
}

TEST_CASE_FIXTURE(Way, "a rate puts frames between the poses, turns by the great arc, and no frame of another path is mixed with them") {
    walk("--mode mono --rate 4");
    const nlohmann::json frames = report().at("frames");
    REQUIRE(frames.size() == 7);
    const std::set<std::string> before = files();
    CHECK(these(before.size(), before.contains("frames/frame_000006_mono" + kExtension)) == these(2 + 8, true));
    for (std::size_t i = 0; i < 7; ++i) {
        CAPTURE(i);
        CHECK(frames.at(i).at("time_s") == doctest::Approx(0.25 * static_cast<double>(i)));
        const double share = i < 2 ? 0.5 * static_cast<double>(i) : 1.5 - 0.25 * static_cast<double>(i);
        const nlohmann::json& eye = frames.at(i).at("eyes").at("mono");
        CHECK(eye.at("position").at(0) == doctest::Approx(0.1 * share));
        CHECK(std::abs(eye.at("orientation_wxyz").at(2).get<double>()) == doctest::Approx(std::sin(share * kPi / 18.0)));
    }
    // The same frames are replaced.
    for (const std::string options : {"--mode mono", "--mode shared --rate 4"}) {
        checkRefused(kRender + "--path poses.csv --out frames " + options, 1, "is a frame of another path");
        CHECK(files() == before);
    }
    write("frames/frame_notes.txt", "mine");
    walk("--mode mono --rate 4");
    CHECK(files().size() == before.size() + 1);
}

TEST_CASE("a path may begin on the way, where the camera then stands, and end before its end") {
    const Way way;
    way.walk("--mode mono --from 0.5 --seconds 0.5 --rate 4");
    const nlohmann::json frames = way.report().at("frames");
    REQUIRE(frames.size() == 2);
    const nlohmann::json &first = frames.at(0).at("eyes").at("mono"), &second = frames.at(1).at("eyes").at("mono");
    CHECK(frames.at(0).at("time_s") == 0.0);
    CHECK(these(first.at("position").at(0), first.at("orientation_wxyz").at(2)) == these(doctest::Approx(0.0), doctest::Approx(0.0)));
    // A quarter of the way back, of which the head that looks 20 degrees aside sees that part as going aside.
    const double turn = kPi / 9.0;
    CHECK(frames.at(1).at("time_s") == doctest::Approx(0.25));
    CHECK(second.at("position").at(0) == doctest::Approx(-0.025 * std::cos(turn)));
    CHECK(std::abs(second.at("orientation_wxyz").at(2).get<double>()) == doctest::Approx(std::sin(turn / 8.0)));
}

TEST_CASE("a path that cannot be used is one line and one, and leaves nothing") {
    Way("").checkNoWay("", 1, "poses.csv: holds no poses");
    Way("time_s,x,y,z,qx,qy,qz,qw\n").checkNoWay("", 1, "poses.csv: holds no poses");
    Way("0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0\n2,0,0,0,0,0,0,1\n").checkNoWay("", 1, "poses.csv:2: 7 columns, must be 8");
    Way("0,0,0,0,0,0,0,1\n1,0,nan,0,0,0,0,1\n").checkNoWay("", 1, "poses.csv:2: y is nan");
    Way("0,0,0,0,0,0,0,1\n1000,0,0,0,0,0,0,1\n")
        .checkNoWay("--rate 1000", 1, "makes 1000001 frames of --rate 1000, must be at most 1000000");
    Way().checkNoWay("--from 2", 1, "poses.csv: --from is 2, must be at most 1.5, where the recording ends");
    Way().checkRefused(kRender + "--path nowhere.csv --out frames", 1, "nowhere.csv");
}

// Stops with a signal at the Nth submission to the device.
std::string stoppedAt(int submission) {
    return fmt::format("VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
                       "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults BINOSPLAT_FAULT=submit:{}:SIGINT",
                       submission);
}

TEST_CASE_FIXTURE(Way, "a signal before the first frame is whole ends the path with nothing written") {
    for (const int submission : {1, 3}) { checkNoWay("", 130, "stopped by SIGINT, nothing was written", stoppedAt(submission)); }
}

TEST_CASE_FIXTURE(Way, "frames that were finished before a signal are kept, and --resume makes the others") {
    const std::string walk = kRender + "--path poses.csv --mode shared --rate 4 --out ";
    go(walk + "whole");
    const Outcome stopped = run(walk + "frames", stoppedAt(9));
    CHECK(stopped.exit_code == 130);
    std::size_t kept = 0;
    while (holds(fmt::format("frames/frame_{:06}_right{}", kept, kExtension))) { ++kept; }
    CHECK(kept > 0);
    CHECK(stopped.errors.find(fmt::format("{} of 7 frames are in frames, --resume continues", kept)) != std::string::npos);
    CHECK(these(files().contains("frames/report.json"), report().at("frames").size()) == these(true, kept));
    checkRefused("render builtin:fence --size 32x32 --eye 0,0,0 --look 0,0,3 --path poses.csv --mode shared --rate 4 --resume --out frames",
                 1, "must be 32x32 as the frames that --resume adds");
    go(walk + "frames --resume");
    CHECK(report().at("frames").size() == 7 - kept);
    for (int frame = 0; frame < 7; ++frame) {
        for (const char* eye : {"left", "right"}) {
            const std::string name = fmt::format("frame_{:06}_{}{}", frame, eye, kExtension);
            CHECK_MESSAGE(bytesOf("frames/" + name) == bytesOf("whole/" + name), name);
        }
    }
}

}  // SUITE(path)
