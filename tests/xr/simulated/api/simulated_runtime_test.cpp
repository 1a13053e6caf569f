// A program that was not written for the simulated runtime, Khronos's hello_xr: what it does and sees on it,
// also when the session is lost, and whether runs in lock-step repeat bit for bit. BINOSPLAT_WRITE_GOLDENS=1
// writes a new golden picture.
#include "tests/shared_data.h"
#include "tests/xr/simulated/api/simulated_fixture.h"
#include "tests/xr/simulated/installed.h"
#include "xr/simulated/compose/picture_file.h"

#include <sys/wait.h>

SUITE(simulated_runtime) {

using simulated::kLeft;
using simulated::kRight;
using simulated::RgbPicture;

using Json = nlohmann::json;

constexpr double kLeastDb = 40.0;

// Periods of 10 ms are whole nanoseconds: frame n is displayed at exactly n * 0.01 s.
const std::string kQuiet = "rate 100\nsize 64 64\nframes none\n";

// Unequal, canted views of a head that looks around, with hands in sight; the picture is of frame 20, while
// the head turns.
const char* const kLooking =
    "size 240 200\n"
    "eye left angles -35 28 27 -33\n"
    "eye right angles -28 35 27 -33\n"
    "eye left cant 4\n"
    "eye right cant 4\n"
    "head 0 position 0 1.6 0 turn 0 0\n"
    "head 0.4 position 0.1 1.6 0.1 turn 16 -16\n"
    "controller left 0 position -0.25 1.35 -0.7 turn 30 20\n"
    "controller right 0 position 0.15 1.35 -0.6 turn -20 -10\n"
    "axis right squeeze 0 0\n"
    "axis right squeeze 0.4 1\n"
    "frames from 10 to 20 every 10\n"
    "at 0.3 exit\n";

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

double psnrDb(const RgbPicture& a, const RgbPicture& b) {
    REQUIRE(a.size_px == b.size_px);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.bytes.size(); ++i) {
        sum += std::pow((a.bytes[i] - b.bytes[i]) / 255.0, 2.0);
    }
    return sum == 0.0 ? 200.0 : -10.0 * std::log10(sum / static_cast<double>(a.bytes.size()));
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

TEST_CASE("a recorded walk reaches the program as it was walked" * needsSharedData()) {
    const auto data = sharedData();
    if (!data || !haveHelloXr()) { return; }
    const Run run(kQuiet + "head-motion \"" +
                  std::filesystem::absolute(*data / "headmotion" / "User3.csv").string() +
                  "\" axes unity skip 5\nat 1 exit\n");
    CHECK_MESSAGE(run.exit_status == 0, run.output);
    const auto vectorOf = [](const Json& json) {
        return glm::dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
    };
    double way_m = 0.0, largest_error_m = 0.0;
    for (std::size_t i = 10; i < 100; ++i) {
        const Json& frame = run.frames.at(i);
        const Json& layer = frame["layers"].at(0);
        // LOCAL is level and faces where the head faced at time 0; the log has the head's heading.
        const Json& q = layer["stage_from_space"]["orientation"];
        const glm::dquat stage_from_local(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                                          q[2].get<double>());
        for (const std::size_t eye : {0u, 1u}) {
            const glm::dvec3 submitted =
                vectorOf(layer["stage_from_space"]["position"]) +
                stage_from_local * vectorOf(layer["views"].at(eye)["pose"]["position"]);
            largest_error_m =
                std::max(largest_error_m,
                         glm::length(submitted - vectorOf(frame["eyes"].at(eye)["pose"]["position"])));
        }
        way_m += glm::length(vectorOf(frame["head"]["position"]) -
                             vectorOf(run.frames.at(i - 1)["head"]["position"]));
    }
    CHECK(largest_error_m < 1e-6);
    CHECK(way_m > 0.1);
    CHECK(way_m < 2.0);
}

TEST_CASE("hello_xr looks as it did, and a lock-step run writes the same files again") {
    if (!haveHelloXr()) { return; }
    const Run run(kLooking), again(kLooking);
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    // Two pictures and the log.
    CHECK(std::distance(std::filesystem::directory_iterator(run.written), {}) == 3);
    CHECK(std::system(("diff -r " + run.written.string() + " " + again.written.string()).c_str()) == 0);
    const auto eye = [&](std::size_t frame, simulated::Side side) {
        return run.part(frame, side, {0, 0}, {240, 200});
    };
    const RgbPicture left = eye(20, kLeft);
    const std::filesystem::path file =
        std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "tests/golden/hello_xr_left.png";
    const char* const write = std::getenv("BINOSPLAT_WRITE_GOLDENS");
    if (write != nullptr && std::string(write) == "1") { simulated::writePng(file, left); }
    const RgbPicture golden = simulated::readPng(file);
    const double db = psnrDb(golden, left);
    CHECK(db >= kLeastDb);
    if (db < kLeastDb) {
        const std::filesystem::path actual =
            std::filesystem::path(BINOSPLAT_OUTPUT_DIR) / "golden" / "hello_xr_left_actual.png";
        std::filesystem::create_directories(actual.parent_path());
        simulated::writePng(actual, left);
        MESSAGE("look at " << actual.string());
    }
    // What the comparison must be able to tell apart.
    CHECK(psnrDb(golden, eye(20, kRight)) < kLeastDb);
    CHECK(psnrDb(golden, eye(10, kLeft)) < kLeastDb);
}

TEST_CASE(
    "a cube ahead has its disparity and is upright, and controllers are seen where the script holds them") {
    if (!haveHelloXr()) { return; }
    // 150 pixels per unit of tangent, eyes 0.1 m apart. hello_xr puts a cube of 0.25 m 2 m in front of the
    // head, and others on the floor. Its near face, 1.875 m away, is the +z side, pure blue. The right
    // controller's cube has 0.1 m; it is held 0.3 m to the right and 0.2 m above eye height, with its near
    // face 0.5 m ahead.
    const Run run(
        "size 300 300\nipd 0.1\nframes from 20 to 50 every 30\ncontroller left 0 position 0 9 9\n"
        "controller right 0 position 0.3 1.8 -0.55\nat 0.3 controller right off\nat 0.7 exit\n",
        "hello_xr -g Vulkan2 --space View");
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    for (const auto side : {kLeft, kRight}) {
        const double aside_m = side == kLeft ? 0.05 : -0.05;
        const glm::dvec2 ahead = centreOfBlue(run.part(20, side, {100, 100}, {100, 100})) + glm::dvec2(100.0);
        CHECK(std::abs(ahead.x - (150.0 + 150.0 * aside_m / 1.875)) <= 0.5);
        CHECK(std::abs(ahead.y - 150.0) <= 0.5);
        const glm::dvec2 held =
            centreOfBlue(run.part(20, side, {200, 0}, {100, 140})) + glm::dvec2(200.0, 0.0);
        CHECK(std::abs(held.x - (150.0 + 150.0 * (0.3 + aside_m) / 0.5)) <= 0.5);
        CHECK(std::abs(held.y - 90.0) <= 0.5);
    }
    // No longer tracked: only the background, in one colour.
    const RgbPicture empty = run.part(50, kLeft, {200, 0}, {100, 140});
    for (std::size_t i = 0; i < empty.bytes.size(); ++i) { REQUIRE(empty.bytes[i] == empty.bytes[i % 3]); }
}

}  // SUITE(simulated_runtime)
