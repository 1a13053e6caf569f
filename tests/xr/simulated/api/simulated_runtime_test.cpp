// A program that was not written for the simulated runtime, Khronos's hello_xr: what it does and sees on it,
// also when the session is lost, and whether runs in lock-step repeat bit for bit; see
// simulated_runtime_test.txt, too.
#include "tests/script.h"
#include "tests/xr/simulated/api/simulated_painter.h"
#include "tests/xr/simulated/installed.h"

#include <sys/wait.h>

SUITE(simulated_runtime) {

using simulated::kLeft;
using simulated::kRight;
using simulated::RgbPicture;

using Json = nlohmann::json;

bool haveHelloXr() { return isInstalled("hello_xr", "libopenxr-utils"); }

// A run of a foreign program. hello_xr ends when its session ends or when a key is pressed: its input is a
// pipe that stays open and silent.
struct Run : Headset {
    int exit_status = -1;  // 124: it did not end in time
    std::string output;
    std::vector<Json> frames;  // from the log

    explicit Run(const std::string& script, const std::string& command = "hello_xr -g Vulkan2",
                 const std::string& environment = "")
        : Headset(script) {
        const std::string keys = (folder / "keys").string(), log = (folder / "output").string();
        const std::string line = "mkfifo " + keys + " && " BINOSPLAT_STRANGERS_ENVIRONMENT + environment +
                                 " timeout 60 " + command + " 0<>" + keys + " > " + log + " 2>&1";
        const int status = std::system(line.c_str());
        exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        output = textIn(log);
        for (const Json& json : logged()) {
            if (json.contains("frame")) { frames.push_back(json); }
        }
    }

    // Frames with the event.
    [[nodiscard]] std::size_t count(const std::string& event) const {
        std::size_t count = 0;
        for (const Json& frame : frames) { count += std::ranges::count(frame["events"], Json(event)) > 0; }
        return count;
    }
    // The colours of a square in one eye's half of a frame's picture, row by row.
    [[nodiscard]] std::vector<Rgb> square(std::size_t frame, simulated::Side side, const glm::uvec2& from,
                                          std::uint32_t size_px) const {
        const RgbPicture both = simulated::readPng(written / frames.at(frame)["picture"].get<std::string>());
        std::vector<Rgb> pixels;
        for (std::uint32_t i = 0; i < size_px * size_px; ++i) {
            pixels.push_back(at(both, side, from.x + i % size_px, from.y + i / size_px));
        }
        return pixels;
    }
};

SCRIPT(simulated_runtime, "xr/simulated/api/simulated_runtime") {
    if (!haveHelloXr()) { return; }
    std::unique_ptr<Run> hello;
    ScriptHost host;
    host.run = [&](const std::string& words, const std::string& environment) {
        const std::size_t space = words.find(' ');
        const std::string command = "hello_xr -g " + words.substr(0, space);
        hello = std::make_unique<Run>(unescaped(words.substr(space + 1)), command, environment);
        host.folder = hello->folder;
        return Outcome{0, fmt::format("{}exit code {}\n", hello->output, hello->exit_status), ""};
    };
    runScript(host);
}

TEST_CASE("a lost session and a lost instance are left and made anew") {
    if (!haveHelloXr()) { return; }
    const Run run(kQuietScript + "rate 100\nat 0.2 lose-session\nat 0.6 lose-instance\nat 1 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    CHECK(run.count("lose-session") == 1);
    CHECK(run.count("state FOCUSED") == 3);
    CHECK(contains(run.output, "XR_SESSION_STATE_LOSS_PENDING"));
    // Frame numbers continue, and times of a new session are later.
    XrTime last = 0;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        REQUIRE(run.frames[i]["frame"] == i);
        REQUIRE(run.frames[i]["display_time_ns"] > last);
        last = run.frames[i]["display_time_ns"];
    }
}

glm::dvec3 vectorOf(const Json& json) { return {json[0], json[1], json[2]}; }

// The middle of the pure blue pixels: a cube's faces have six pure colours, which nothing else has.
glm::dvec2 centreOfBlue(const std::vector<Rgb>& square, std::uint32_t size_px) {
    glm::dvec2 sum(0.0);
    double count = 0.0;
    for (std::uint32_t i = 0; i < square.size(); ++i) {
        if (square[i][0] > 2 || square[i][1] > 2 || square[i][2] < 253) { continue; }
        sum += glm::dvec2(i % size_px, i / size_px) + 0.5;
        count += 1.0;
    }
    REQUIRE(count > 0.0);
    return sum / count;
}

// Where an eye sees a point that is this far from the middle between both: 300 pixels from 45 degrees to the
// left to 50 to the right and from 45 up to 40 down. The eyes are 0.1 m apart, and each is turned outwards by
// 4 degrees.
glm::dvec2 seenAt(simulated::Side side, const glm::dvec3& point) {
    const double outwards = side == kLeft ? 1.0 : -1.0, degree = std::numbers::pi / 180.0;
    const glm::dvec3 place = glm::angleAxis(-4.0 * outwards * degree, glm::dvec3(0, 1, 0)) *
                             (point + glm::dvec3(0.05 * outwards, 0.0, 0.0));
    const glm::dvec2 tangent(place.x / -place.z, place.y / -place.z);
    const double right = std::tan(50.0 * degree), down = std::tan(40.0 * degree);
    return 300.0 * glm::dvec2((tangent.x + 1.0) / (1.0 + right), (1.0 - tangent.y) / (1.0 + down));
}

TEST_CASE("cubes are seen where they stand and controllers where they are held, each time the same") {
    if (!haveHelloXr()) { return; }
    // hello_xr puts a cube of 0.25 m 2 m in front of the head, and others on the floor. Its near face, 1.875
    // m away, is the +z side, pure blue. The right controller's cube has 0.1 m; it is held 0.3 m to the right
    // and 0.2 m above eye height, with its near face 0.5 m ahead. Later the head looks around.
    const std::string script =
        "size 300 300\nipd 0.1\neye left angles -45 50 45 -40\neye right angles -45 50 45 -40\n"
        "eye left cant 4\neye right cant 4\nframes from 20 to 65 every 15\n"
        "head 0.5 position 0 1.6 0 turn 0 0\nhead 0.7 position 0.1 1.6 0.1 turn 16 -16\n"
        "controller left 0 position 0 9 9\ncontroller right 0 position 0.3 1.8 -0.55\n"
        "axis right squeeze 0.5 0\naxis right squeeze 0.7 1\nat 0.3 controller right off\nat 0.7 exit\n";
    const Run run(script, "hello_xr -g Vulkan2 --space View"),
        again(script, "hello_xr -g Vulkan2 --space View");
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    for (const auto side : {kLeft, kRight}) {
        for (const glm::dvec3 face : {glm::dvec3(0.0, 0.0, -1.875), glm::dvec3(0.3, 0.2, -0.5)}) {
            const glm::dvec2 expected = seenAt(side, face);
            const glm::uvec2 corner(expected - 30.0);
            const glm::dvec2 seen = centreOfBlue(run.square(20, side, corner, 60), 60) + glm::dvec2(corner);
            CHECK(std::abs(seen.x - expected.x) <= 0.5);
            CHECK(std::abs(seen.y - expected.y) <= 0.5);
        }
    }
    // No longer tracked: only the background, in one colour.
    const std::vector<Rgb> empty =
        run.square(50, kLeft, glm::uvec2(seenAt(kLeft, {0.3, 0.2, -0.5}) - 30.0), 60);
    CHECK(std::ranges::count(empty, empty[0]) == 60 * 60);
    // What the program shows was drawn from where the eyes are.
    for (std::size_t i = 10; i <= 65; ++i) {
        const Json &layer = run.frames.at(i)["layers"].at(0), &space = layer["stage_from_space"];
        const Json& q = space["orientation"];
        const glm::dquat stage_from_space(q[3], q[0], q[1], q[2]);
        for (const std::size_t eye : {0u, 1u}) {
            const glm::dvec3 drawn_from =
                vectorOf(space["position"]) +
                stage_from_space * vectorOf(layer["views"].at(eye)["pose"]["position"]);
            const Json& seen_from = run.frames[i]["eyes"].at(eye)["pose"]["position"];
            CHECK(glm::length(drawn_from - vectorOf(seen_from)) < 1e-6);
        }
    }
    // Four pictures and the log.
    CHECK(std::distance(std::filesystem::directory_iterator(run.written), {}) == 5);
    CHECK(std::system(("diff -r " + run.written.string() + " " + again.written.string()).c_str()) == 0);
}

}  // SUITE(simulated_runtime)
