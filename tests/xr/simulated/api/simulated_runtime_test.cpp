// A program that was not written for the simulated runtime, Khronos's hello_xr: what it does and sees on it,
// also when the session is lost, and whether runs in lock-step repeat bit for bit.
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "tests/xr/simulated/installed.h"
#include "xr/simulated/compose/picture_file.h"

#include <sys/wait.h>

SUITE(simulated_runtime) {

using simulated::kLeft;
using simulated::kRight;
using simulated::RgbPicture;

using Json = nlohmann::json;

// Periods of 10 ms are whole nanoseconds: frame n is displayed at exactly n * 0.01 s.
const std::string kQuiet = "rate 100\nsize 64 64\nframes none\n";

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

    [[nodiscard]] bool says(const std::string& part) const { return output.find(part) != std::string::npos; }
    // Frames with the event.
    [[nodiscard]] std::size_t count(const std::string& event) const {
        const auto has = [&](const Json& frame) {
            return std::ranges::find(frame["events"], Json(event)) != frame["events"].end();
        };
        return static_cast<std::size_t>(std::ranges::count_if(frames, has));
    }
    // A part of one eye's half of a frame's picture.
    [[nodiscard]] RgbPicture part(std::size_t frame, simulated::Side side, const glm::uvec2& from,
                                  const glm::uvec2& size_px) const {
        const RgbPicture both = simulated::readPng(written / frames.at(frame)["picture"].get<std::string>());
        RgbPicture part{size_px, {}};
        for (std::uint32_t y = from.y; y < from.y + size_px.y; ++y) {
            const std::size_t first =
                std::size_t{3} * (y * both.size_px.x + side * both.size_px.x / 2 + from.x);
            const auto row = both.bytes.begin() + static_cast<std::ptrdiff_t>(first);
            part.bytes.insert(part.bytes.end(), row, row + std::ptrdiff_t{3} * size_px.x);
        }
        return part;
    }
};

void checkSilent(const std::string& output) {
    for (const char* complaint :
         {"VUID-", "SYNC-HAZARD", "UNASSIGNED-", "Validation Error", "Validation Warning"}) {
        const std::size_t place = output.find(complaint);
        if (place != std::string::npos) { FAIL_CHECK(output.substr(place, 500)); }
    }
}

// The mean column and row of pure blue pixels: a cube's faces have six pure colours, which nothing else has.
glm::dvec2 centreOfBlue(const RgbPicture& picture) {
    glm::dvec2 sum(0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < picture.bytes.size() / 3; ++i) {
        const std::uint8_t* const pixel = &picture.bytes[3 * i];
        if (pixel[0] > 2 || pixel[1] > 2 || pixel[2] < 253) { continue; }
        sum += glm::dvec2(static_cast<double>(i % picture.size_px.x) + 0.5,
                          static_cast<double>(i / picture.size_px.x) + 0.5);
        count += 1.0;
    }
    REQUIRE(count > 0.0);
    return sum / count;
}

TEST_CASE("hello_xr runs on it from start to end, and no validation layer has anything to say") {
    if (!haveHelloXr()) { return; }
    const std::string script = "size 128 128\nframes every 10\npress right squeeze 0.1 0.3\nat 0.4 exit\n";
    const std::string validation =
        "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "
        "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT ";
    std::vector<std::string> outputs;
    {
        // With other controllers, and under OpenXR's own layer.
        const Run hello(script, "hello_xr -g Vulkan2",
                        validation +
                            "SIMULATED_OPENXR_PROFILE=valve/index_controller "
                            "XR_ENABLE_API_LAYERS=XR_APILAYER_LUNARG_core_validation "
                            "XR_CORE_VALIDATION_EXPORT_TYPE=text "
                            "XR_CORE_VALIDATION_FILE_NAME=$SIMULATED_OPENXR_SCRIPT.validation");
        CHECK(hello.exit_status == 0);
        CHECK(hello.says("Left hand Index controller Squeeze"));
        CHECK(std::filesystem::exists(hello.written / "frame_000010.png"));
        CHECK(std::filesystem::exists(hello.written / "frame_000030.png"));
        CHECK(hello.says("Core Validation output type: text"));
        outputs = {hello.output, textIn(hello.folder / "test.script.validation")};
    }
    // With the older extension, and a real clock.
    const Run older(script, "hello_xr -g Vulkan", validation + "SIMULATED_OPENXR_CLOCK=real");
    CHECK(older.exit_status == 0);
    outputs.push_back(older.output);
    for (const std::string& output : outputs) { checkSilent(output); }
    for (const std::string& output : {outputs[0], outputs[2]}) {
        CHECK(output.find("XR_SESSION_STATE_VISIBLE->XR_SESSION_STATE_FOCUSED") != std::string::npos);
        CHECK(output.find("XR_SESSION_STATE_IDLE->XR_SESSION_STATE_EXITING") != std::string::npos);
    }
}

TEST_CASE("a machine without GPU is told apart from one without headset and from a broken script") {
    if (!haveHelloXr()) { return; }
    const Run no_gpu(kQuiet, "hello_xr -g Vulkan2",
                     "VK_ICD_FILENAMES=/nowhere.json VK_DRIVER_FILES=/nowhere.json");
    CHECK(no_gpu.says("simulated runtime: xrCreateVulkanInstanceKHR: no GPU: Vulkan has no driver"));
    const Run no_headset("plugged off\n", "hello_xr -g Vulkan2", "SIMULATED_OPENXR_EXPLAIN=1");
    CHECK(no_headset.says("simulated runtime: xrGetSystem: XR_ERROR_FORM_FACTOR_UNAVAILABLE: no headset"));
    CHECK_FALSE(no_headset.says("no GPU"));
    const Run no_script("at noon exit\n");
    CHECK(no_script.says("test.script:1: "));
    CHECK_FALSE(no_script.says("no GPU"));
}

TEST_CASE("a lost session and a lost instance are left and made anew") {
    if (!haveHelloXr()) { return; }
    const Run run(kQuiet + "at 0.2 lose-session\nat 0.6 lose-instance\nat 1 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    CHECK(run.count("lose-session") == 1);
    CHECK(run.count("state FOCUSED") == 3);
    CHECK(run.says("XR_SESSION_STATE_LOSS_PENDING"));
    // Frame numbers continue, and times of a new session are later.
    XrTime last = 0;
    for (std::size_t i = 0; i < run.frames.size(); ++i) {
        REQUIRE(run.frames[i]["frame"] == i);
        REQUIRE(run.frames[i]["display_time_ns"].get<XrTime>() > last);
        last = run.frames[i]["display_time_ns"].get<XrTime>();
    }
}

glm::dvec3 vectorOf(const Json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
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

TEST_CASE(
    "a cube ahead has its disparity and is upright, controllers are seen where the script holds them, and a "
    "lock-step run writes the same files again") {
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
            const glm::uvec2 corner(expected - glm::dvec2(30.0));
            const glm::dvec2 seen = centreOfBlue(run.part(20, side, corner, {60, 60})) + glm::dvec2(corner);
            CHECK(std::abs(seen.x - expected.x) <= 0.5);
            CHECK(std::abs(seen.y - expected.y) <= 0.5);
        }
    }
    // No longer tracked: only the background, in one colour.
    const glm::uvec2 corner(seenAt(kLeft, {0.3, 0.2, -0.5}) - glm::dvec2(30.0));
    const RgbPicture empty = run.part(50, kLeft, corner, {60, 60});
    for (std::size_t i = 0; i < empty.bytes.size(); ++i) { REQUIRE(empty.bytes[i] == empty.bytes[i % 3]); }
    // What the program shows was drawn from where the eyes are.
    for (std::size_t i = 10; i <= 65; ++i) {
        const Json& layer = run.frames.at(i)["layers"].at(0);
        const Json& q = layer["stage_from_space"]["orientation"];
        const glm::dquat stage_from_space(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                                          q[2].get<double>());
        for (const std::size_t eye : {0u, 1u}) {
            const glm::dvec3 drawn_from =
                vectorOf(layer["stage_from_space"]["position"]) +
                stage_from_space * vectorOf(layer["views"].at(eye)["pose"]["position"]);
            CHECK(glm::length(drawn_from - vectorOf(run.frames[i]["eyes"].at(eye)["pose"]["position"])) <
                  1e-6);
        }
    }
    // Four pictures and the log.
    CHECK(std::distance(std::filesystem::directory_iterator(run.written), {}) == 5);
    CHECK(std::system(("diff -r " + run.written.string() + " " + again.written.string()).c_str()) == 0);
}

}  // SUITE(simulated_runtime)
