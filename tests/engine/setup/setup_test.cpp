// Facts about cameras, headsets, settings and output files.
#include "engine/error.h"
#include "engine/setup/camera_file.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/output_files.h"
#include "engine/setup/settings.h"
#include "engine/setup/values.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>

TEST_SUITE_BEGIN("setup");

namespace setup_test {

namespace fs = std::filesystem;
using namespace binosplat;
using binosplat::test::Workplace;

namespace {

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

fs::path writeFile(const fs::path& path, const std::string& text) {
    writeText(path, text);
    return path;
}

// Every line of the folder's C++ and CMake files: visit(file within the repository, line).
void visitLines(const std::string& folder, const std::function<void(const std::string&, const std::string&)>& visit) {
    const fs::path root(BINOSPLAT_SOURCE_DIR);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp" && extension != ".cmake" && entry.path().filename() != "CMakeLists.txt") { continue; }
        std::ifstream stream(entry.path());
        for (std::string line; std::getline(stream, line);) { visit(fs::relative(entry.path(), root).generic_string(), line); }
    }
}

}  // namespace

TEST_CASE("the readers that the engine and the simulated runtime share are a room of their own, below both") {
    const std::string room = "xr/simulated/files/", quoted = "#include \"";
    std::string links;
    visitLines("xr/simulated/files", [&](const std::string& file, const std::string& line) {
        CAPTURE(file);
        if (line.starts_with(quoted)) { CHECK_MESSAGE(line.starts_with(quoted + room), line); }
        if (line.starts_with("target_link_libraries")) { links += line; }
    });
    CHECK(links == "target_link_libraries(binosplat_files PUBLIC binosplat_flags PRIVATE third_party_toml)");
    // Of the rest of xr/ the engine includes nothing, and nobody else compiles the room's sources.
    for (const char* folder : {"engine", "third_party"}) {
        visitLines(folder, [&](const std::string& file, const std::string& line) {
            CAPTURE(file);
            if (line.starts_with(quoted + "xr/")) { CHECK_MESSAGE(line.starts_with(quoted + room), line); }
            const bool compiles = !file.ends_with(".h") && !file.ends_with(".cpp") && line.find(room) != std::string::npos;
            CHECK_MESSAGE(!compiles, line);
        });
    }
}

TEST_CASE("cameraFileIsWorldFromCameraWithRowsAsWritten") {
    const Workplace work;
    // The camera stands at (1, 2, 3) and looks along world x: its z axis is the third column, (1, 0, 0); its x axis is (0, 0, -1).
    const auto cameras = readCameraFile(writeFile(work.path / "c.json", R"([
        {"id": 0, "img_name": "a", "width": 640, "height": 480, "position": [1, 2, 3], "rotation": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], "fx": 500, "fy": 510},
        {"id": 1, "width": 640, "height": 480, "position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 500, "fy": 510, "cx": 300, "cy": 200}])"));
    REQUIRE(cameras.size() == 2);
    const Eye& eye = cameras[0].eye;
    CHECK(cameras[0].name == "a");
    CHECK(cameras[1].name == "1");
    CHECK(glm::length(transform(eye.world_from_camera, {0, 0, 1}) - glm::dvec3(2, 2, 3)) < 1e-12);
    CHECK(glm::length(transform(eye.world_from_camera, {1, 0, 0}) - glm::dvec3(1, 2, 2)) < 1e-12);
    CHECK(eye.size_px == glm::uvec2(640, 480));
    CHECK(eye.intrinsics.cx == 320.0);
    CHECK(eye.intrinsics.cy == 240.0);
    CHECK(cameras[1].eye.intrinsics.cx == 300.0);
    CHECK(cameras[1].eye.intrinsics.cy == 200.0);
}

TEST_CASE("aGitLfsPointerIsNamedAsWhatItIs") {
    const Workplace work;
    const fs::path file = writeFile(work.path / "pointer", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
    const auto refuses = [](auto&& read) {
        try {
            read();
        } catch (const Error& error) { return std::string(error.what()).find(": is a Git LFS pointer") != std::string::npos; }
        return false;
    };
    CHECK(refuses([&] { (void)readSettingsFile(file); }));
    CHECK(refuses([&] { (void)readCameraFile(file); }));
    CHECK(refuses([&] { (void)readHeadset(file); }));
    CHECK(refuses([&] { (void)readHeadMotion(file, MotionAxes::kOpenXr); }));
}

TEST_CASE("resizingAnEyeKeepsWhatItSees") {
    const Eye eye{{}, {500.0, 510.0, 300.0, 200.0}, {640, 480}};
    const Eye half = resize(eye, {320, 240});
    CHECK(half.intrinsics.fx == 250.0);
    CHECK(half.intrinsics.fy == 255.0);
    CHECK(half.intrinsics.cx == 150.0);
    CHECK(half.intrinsics.cy == 100.0);
    CHECK(half.size_px == glm::uvec2(320, 240));
}

TEST_CASE("everyHeadsetOfTheRepositoryReads") {
    int count = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(BINOSPLAT_SOURCE_DIR) / "configs" / "headsets")) {
        const Headset headset = readHeadset(entry.path());
        CHECK(!headset.source.empty());
        CHECK(headset.eye_distance_m > 0.05);
        // Outwards each eye sees more than inwards.
        CHECK(-headset.angles[kLeft].left_rad > headset.angles[kLeft].right_rad);
        CHECK(headset.angles[kRight].right_rad > -headset.angles[kRight].left_rad);
        ++count;
    }
    CHECK(count >= 4);
}

TEST_CASE("aHeadsetFileMayNameTheLensesCentres") {
    const Workplace work;
    const std::string top = "name = \"a\"\nsource = \"b\"\nsize = \"8x8\"\ncanting_deg = 0\neye_distance_m = 0.06\n";
    const std::string left = "[left]\nleft = -50\nright = 40\nup = 45\ndown = -45\n",
                      right = "[right]\nleft = -40\nright = 50\nup = 45\ndown = -45\n";
    const auto read = [&](const std::string& left_centre) {
        return readHeadset(writeFile(work.path / "h.toml", top + left + left_centre + right));
    };
    CHECK(read("").lens_centres[kLeft] == glm::dvec3(0.0, 0.0, 1.0));
    const Headset named = read("lens_centre = [-3, 2.5]\n");
    CHECK(named.lens_centres[kLeft].x == doctest::Approx(-std::tan(3.0 * std::acos(-1.0) / 180.0)));
    CHECK(named.lens_centres[kLeft].y == doctest::Approx(-std::tan(2.5 * std::acos(-1.0) / 180.0)));
    CHECK(named.lens_centres[kRight] == glm::dvec3(0.0, 0.0, 1.0));
    const auto message = [&](const std::string& left_centre) {
        try {
            read(left_centre);
        } catch (const Error& error) { return std::string(error.what()); }
        return std::string("accepted");
    };
    CHECK(message("lens_centre = 3\n").find("h.toml:11: left.lens_centre must be two angles") != std::string::npos);
    CHECK(message("lens_centre = [1, 2, 3]\n").find("must be two angles") != std::string::npos);
    CHECK(message("lens_centre = [-51, 0]\n").find("h.toml:11: left.lens_centre is -51, must be a number from -50 to 40") !=
          std::string::npos);
    CHECK(message("lens_centre = [0, nan]\n").find("left.lens_centre is nan, must be a number from -45 to 45") != std::string::npos);
}

TEST_CASE("cantedEyesTurnOutwards") {
    Headset headset;
    headset.angles = {ViewAngles{-0.8, 0.6, 0.7, -0.7}, ViewAngles{-0.6, 0.8, 0.7, -0.7}};
    headset.canting_rad = 0.1;
    const auto eyes = headsetEyes(headset, Pose{}, 0.064, {100, 100});
    const glm::dvec3 left = eyes[kLeft].world_from_camera.orientation * glm::dvec3(0, 0, 1);
    const glm::dvec3 right = eyes[kRight].world_from_camera.orientation * glm::dvec3(0, 0, 1);
    CHECK(left.x == doctest::Approx(-std::sin(0.1)));
    CHECK(right.x == doctest::Approx(std::sin(0.1)));
    CHECK(left.y == doctest::Approx(0.0));
    CHECK(eyes[kLeft].world_from_camera.position.x == doctest::Approx(-0.032));
    CHECK(eyes[kRight].world_from_camera.position.x == doctest::Approx(0.032));
    // The mid-eye sees from the left eye's outer edge to the right eye's.
    const Intrinsics middle = headsetMiddle(headset, Pose{}, {100, 100}).intrinsics;
    CHECK(degrees(std::atan(-middle.cx / middle.fx)) == doctest::Approx(degrees(-0.9)));
    CHECK(degrees(std::atan((100.0 - middle.cx) / middle.fx)) == doctest::Approx(degrees(0.9)));
}

TEST_CASE("badHeadsetsNameFileAndLine") {
    const Workplace work;
    const std::string top = "name = \"a\"\nsource = \"b\"\nsize = \"8x8\"\ncanting_deg = 0\neye_distance_m = 0.06\n";
    const std::string sides = "[left]\nleft = -50\nright = 40\nup = 45\ndown = -45\n";
    const auto message = [&](const std::string& text) {
        try {
            readHeadset(writeFile(work.path / "h.toml", text));
        } catch (const Error& error) { return std::string(error.what()); }
        return std::string("accepted");
    };
    CHECK(message(top + sides).find("[right] is missing") != std::string::npos);
    CHECK(message(top + "[left]\nleft = -50\n").find("left.right is missing") != std::string::npos);
    CHECK(message(top + "[left]\nleft = 95\nright = 40\nup = 45\ndown = -45\n").find("h.toml:7: left.left is 95") != std::string::npos);
    CHECK(message(top + "[left]\nleft = 45\nright = 40\nup = 45\ndown = -45\n").find("must be less than") != std::string::npos);
    CHECK(message("colour = 1\n").find("h.toml:1: colour is not a key") != std::string::npos);
}

TEST_CASE("numbersAreReadWhole") {
    CHECK(parseNumber("1.5") == 1.5);
    CHECK(parseNumber("+2e-3") == 2e-3);
    CHECK(parseNumber("-0.25") == -0.25);
    for (const char* text : {"", "1.5x", "x", "nan", "inf", "1,5", "0x10", "1e999", "--1", "+-1"}) {
        CHECK(!parseNumber(text).has_value());
    }
}

TEST_CASE("outputFilesAppearTogetherOrNotAtAll") {
    const Workplace work;
    {
        OutputFiles files(work.path / "a" / "b");
        writeText(files.staging() / "one", "1");
    }
    CHECK(work.isEmpty());
    {
        OutputFiles files(work.path / "a" / "b");
        writeText(files.staging() / "one", "1");
        writeText(files.staging() / "two", "2");
        files.publish();
    }
    CHECK(fs::exists(work.path / "a" / "b" / "one"));
    CHECK(std::distance(fs::directory_iterator(work.path / "a" / "b"), {}) == 2);
}

TEST_CASE("afailedRunKeepsWhatWasThere") {
    const Workplace work;
    fs::create_directories(work.path / "out");
    writeText(work.path / "out" / "one", "old");
    {
        OutputFiles files(work.path / "out");
        writeText(files.staging() / "one", "new");
    }
    CHECK(fs::file_size(work.path / "out" / "one") == 3);
    CHECK(std::distance(fs::directory_iterator(work.path / "out"), {}) == 1);
}

}  // namespace setup_test
