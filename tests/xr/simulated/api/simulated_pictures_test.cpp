// Facts about what a wearer sees of hello_xr's cubes, and that lock-step runs repeat bit for bit.
// BINOSPLAT_WRITE_GOLDENS=1 makes the golden picture anew.
#include "tests/xr/simulated/hello_xr.h"

#include <algorithm>
#include <cmath>
#include <map>

TEST_SUITE_BEGIN("simulated_pictures");

namespace simulated_pictures_test {

using namespace binosplat::test;
using simulated::kLeft;
using simulated::kRight;
using simulated::RgbPicture;

namespace {

constexpr double kLeastDb = 40.0;
constexpr std::size_t kFrame = 20;

// Unequal, canted views of a head that looks about, hands in sight; the picture is of frame 20, when the head turns.
const char* const kScript =
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

double psnrDb(const RgbPicture& a, const RgbPicture& b) {
    REQUIRE(a.size_px == b.size_px);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.bytes.size(); ++i) {
        const double difference = (static_cast<double>(a.bytes[i]) - static_cast<double>(b.bytes[i])) / 255.0;
        sum += difference * difference;
    }
    return sum == 0.0 ? 200.0 : -10.0 * std::log10(sum / static_cast<double>(a.bytes.size()));
}

RgbPicture shiftedRight(const RgbPicture& picture) {
    RgbPicture shifted = picture;
    const std::size_t row_bytes = std::size_t{3} * picture.size_px.x;
    for (std::size_t row = 0; row < picture.bytes.size(); row += row_bytes) {
        std::copy_n(picture.bytes.begin() + static_cast<std::ptrdiff_t>(row), row_bytes - 3,
                    shifted.bytes.begin() + static_cast<std::ptrdiff_t>(row + 3));
    }
    return shifted;
}

RgbPicture upsideDown(const RgbPicture& picture) {
    RgbPicture turned{picture.size_px, {}};
    const auto row_bytes = static_cast<std::ptrdiff_t>(3 * picture.size_px.x);
    for (auto row = picture.bytes.end(); row != picture.bytes.begin(); row -= row_bytes) {
        turned.bytes.insert(turned.bytes.end(), row - row_bytes, row);
    }
    return turned;
}

// The mean column and row of pixels of a pure colour; the cube's faces are drawn in six, and nothing else is.
glm::dvec2 centreOf(const RgbPicture& picture, const std::array<int, 3>& colour) {
    glm::dvec2 sum(0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < picture.bytes.size() / 3; ++i) {
        const auto matches = [&](std::size_t c) { return std::abs(picture.bytes[3 * i + c] - colour[c]) <= 2; };
        if (!matches(0) || !matches(1) || !matches(2)) { continue; }
        sum += glm::dvec2(static_cast<double>(i % picture.size_px.x) + 0.5, static_cast<double>(i / picture.size_px.x) + 0.5);
        count += 1.0;
    }
    REQUIRE(count > 0.0);
    return sum / count;
}

std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files[entry.path().filename().string()] = HelloXr::readFile(entry.path());
    }
    return files;
}

}  // namespace

TEST_CASE("hello_xr looks as it did") {
    if (!haveHelloXr()) { return; }
    const HelloXr run(kScript);
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    const RgbPicture left = run.eye(kFrame, kLeft), right = run.eye(kFrame, kRight);
    const std::filesystem::path file = std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "tests/golden/hello_xr_left.png";
    const char* write = std::getenv("BINOSPLAT_WRITE_GOLDENS");
    if (write != nullptr && std::string(write) == "1") { simulated::writePng(file, left); }
    const RgbPicture golden = simulated::readPng(file);
    const double db = psnrDb(golden, left);
    CHECK(db >= kLeastDb);
    if (db < kLeastDb) {
        const std::filesystem::path actual = std::filesystem::path(BINOSPLAT_OUTPUT_DIR) / "golden" / "hello_xr_left_actual.png";
        std::filesystem::create_directories(actual.parent_path());
        simulated::writePng(actual, left);
        MESSAGE("look at " << actual.string());
    }
    // What the comparison must tell apart.
    CHECK(psnrDb(golden, right) < kLeastDb);
    CHECK(psnrDb(golden, shiftedRight(left)) < kLeastDb);
    CHECK(psnrDb(golden, upsideDown(left)) < kLeastDb);
    CHECK(psnrDb(golden, run.eye(10, kLeft)) < kLeastDb);
}

TEST_CASE("lock-step runs write the same files") {
    if (!haveHelloXr()) { return; }
    const HelloXr once(kScript), again(kScript);
    REQUIRE(once.exit_status == 0);
    const auto files = filesOf(once.written);
    CHECK(files.size() == 3);  // two pictures and the log
    CHECK(files == filesOf(again.written));
}

TEST_CASE("a cube ahead has its disparity and is upright") {
    if (!haveHelloXr()) { return; }
    // hello_xr puts a cube of 0.25 m 2 m ahead of the head; its near face, 1.875 m away, is the +z side, pure blue. 150 pixels per unit
    // of tangent; eyes 0.1 m apart: left at 150 + 150 * 0.05 / 1.875 = 154 pixels, right at 146, and in the middle of the height.
    const HelloXr run(
        "size 300 300\nipd 0.1\nframes from 10 to 10\nat 0.2 exit\ncontroller left 0 position 0 9 9\ncontroller right 0 position 0 9 9\n",
        "--space View");
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    const auto centre = [&](simulated::Side side) {
        RgbPicture picture = run.eye(10, side);
        // The other cubes stand on the floor.
        picture.size_px.y = 200;
        picture.bytes.resize(std::size_t{3} * 300 * 200);
        return centreOf(picture, {0, 0, 255});
    };
    CHECK(std::abs(centre(kLeft).x - 154.0) <= 0.5);
    CHECK(std::abs(centre(kRight).x - 146.0) <= 0.5);
    CHECK(std::abs(centre(kLeft).y - 150.0) <= 0.5);
}

TEST_CASE("controllers are seen where the script holds them") {
    if (!haveHelloXr()) { return; }
    // Cubes of 0.1 m. The right one is held 0.3 m to the right, 0.2 m above the eyes' height, its near face 0.45 + 0.05 m ahead.
    const std::string script =
        "size 300 300\nipd 0\nframes from 20 to 50 every 30\ncontroller left 0 position 0 9 9\n"
        "controller right 0 position 0.3 1.8 -0.55\nat 0.3 controller right off\nat 0.7 exit\n";
    const HelloXr run(script);
    REQUIRE_MESSAGE(run.exit_status == 0, run.output);
    const auto upperRight = [&](std::size_t frame) {
        const RgbPicture picture = run.eye(frame, kLeft);
        RgbPicture part{{100, 140}, {}};
        for (std::size_t y = 0; y < 140; ++y) {
            const auto row = picture.bytes.begin() + static_cast<std::ptrdiff_t>(3 * (300 * y + 200));
            part.bytes.insert(part.bytes.end(), row, row + 300);
        }
        return part;
    };
    // x = 150 + 150 * 0.3 / 0.5 = 240, y = 150 - 150 * 0.2 / 0.5 = 90.
    const glm::dvec2 centre = centreOf(upperRight(20), {0, 0, 255}) + glm::dvec2(200.0, 0.0);
    CHECK(std::abs(centre.x - 240.0) <= 0.5);
    CHECK(std::abs(centre.y - 90.0) <= 0.5);
    // Not tracked any more: only the background, of one colour.
    const RgbPicture empty = upperRight(50);
    const std::array<std::uint8_t, 3> first{empty.bytes[0], empty.bytes[1], empty.bytes[2]};
    for (std::size_t i = 0; i < empty.bytes.size(); ++i) { REQUIRE(empty.bytes[i] == first[i % 3]); }
}

}  // namespace simulated_pictures_test
