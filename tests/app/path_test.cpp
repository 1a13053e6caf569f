// Facts about rendering along a path: numbered frames of both eyes, and nothing half-written.
#include "tests/app/program_script.h"
#include "tests/xr/simulated/installed.h"

SUITE(path) {

const std::string kScene = "render builtin:fence --size 64x48 --up 0,-1,0 --fov-x 60 ";
const std::string kRender = kScene + "--eye 0,0,0 --look 0,0,3 ";
// A tenth of a metre to the right and 20 degrees to the left in half a second, and back again in the next.
const std::string kPoses = fmt::format(
    "time_s,x,y,z,qx,qy,qz,qw\n5,0,0,0,0,0,0,1\n5.5,0.1,0,0,0,{:.9f},0,{:.9f}\n6.5,0,0,0,0,0,0,1\n",
    std::sin(std::numbers::pi / 18.0), std::cos(std::numbers::pi / 18.0));
const std::string kExtension = extensionOf(PictureKind::kDisplay);

struct Way : Workplace {
    Way() { write("poses.csv", kPoses); }
    [[nodiscard]] nlohmann::json report(const std::string& folder = "frames") const {
        return nlohmann::json::parse(bytesOf(folder + "/report.json"));
    }
};

// frame NUMBER TIME X SINE: of one eye's frame; its offset to the side, and the sine of half its turn.
SCRIPT(path, "app/path") {
    const Way way;
    ScriptHost host = programIn(way);
    host.names["SCENE"] = kScene;
    host.names["WALK"] = kRender + "--path poses.csv --out frames";
    host.verbs["count"] = [&](const std::string& count) { CHECK(way.files().size() == std::stoul(count)); };
    host.verbs["frame"] = [&](const std::string& line) {
        const std::vector<std::string> words = wordsIn(line);
        const nlohmann::json frame = way.report().at("frames").at(std::stoul(words.at(0))),
                             eye = frame.at("eyes").at("mono");
        CHECK(frame.at("time_s") == doctest::Approx(std::stod(words.at(1))));
        CHECK(eye.at("position").at(0) == doctest::Approx(std::stod(words.at(2))));
        CHECK(std::abs(eye.at("orientation_wxyz").at(2).get<double>()) ==
              doctest::Approx(std::stod(words.at(3))));
    };
    runScript(host);
}

TEST_CASE_FIXTURE(Way, "frames that were finished before a signal are kept, and --resume makes the others") {
    // A film needs ffmpeg.
    const bool films = isInstalled("ffmpeg", "ffmpeg");
    for (const std::string mode : {"shared", "temporal"}) {
        CAPTURE(mode);
        const bool is_film = films && mode == "temporal";
        const std::string walk = kRender + "--path poses.csv --rate 4 --layout " +
                                 (is_film ? "sbs --video" : "separate") + " --mode " + mode + " --out ";
        const std::vector<std::string> eyes =
            is_film ? std::vector<std::string>{"stereo"} : std::vector<std::string>{"left", "right"};
        const auto nameOf = [&](int frame, const std::string& eye) {
            return fmt::format("/frame_{:06}_{}{}", frame, eye, kExtension);
        };
        const std::string whole = "whole-" + mode, frames = "frames-" + mode;
        go(walk + whole);
        const Outcome stopped = run(walk + frames, fault("submit", 13, "SIGINT"));
        CHECK(stopped.exit_code == 130);
        int kept = 0;
        while (holds(frames + nameOf(kept, eyes.back()))) { ++kept; }
        CHECK(kept == within(1, 6));
        CHECK(contains(stopped.errors,
                       fmt::format("{} of 7 frames are in {}, --resume continues", kept, frames)));
        CHECK(report(frames).at("frames").size() == static_cast<std::size_t>(kept));
        checkRefused(edited(walk, "64x48 => 32x32") + frames + " --resume", 1,
                     fmt::format("must be {} as the frames that --resume adds", is_film ? "64x32" : "32x32"));
        go(walk + frames + " --resume");
        CHECK(report(frames).at("frames").size() == static_cast<std::size_t>(7 - kept));
        for (int frame = 0; frame < 7; ++frame) {
            for (const std::string& eye : eyes) {
                CHECK_MESSAGE(bytesOf(frames + nameOf(frame, eye)) == bytesOf(whole + nameOf(frame, eye)),
                              nameOf(frame, eye));
            }
        }
        if (is_film) { CHECK(bytesOf(frames + "/video.mp4") == bytesOf(whole + "/video.mp4")); }
    }
}

}  // SUITE(path)
