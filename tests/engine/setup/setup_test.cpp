// Facts about cameras, numbers and output files.
#include "engine/setup/camera_file.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/output_files.h"
#include "engine/setup/settings.h"
#include "engine/setup/values.h"
#include "engine/temporary_folder.h"
#include "tests/run_program.h"

#include <climits>

SUITE(setup) {

TEST_CASE_FIXTURE(AtWork, "a camera file is world-from-camera, and resizing an eye keeps what it sees") {
    // The camera stands at (1, 2, 3) and looks along world x: its z axis is the third column, (1, 0, 0); its
    // x axis is (0, 0, -1).
    writeText(work.path / "c.json", R"([
        {"id": 0, "img_name": "a", "width": 640, "height": 480, "fx": 500, "fy": 510,
         "position": [1, 2, 3], "rotation": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]},
        {"id": 1, "width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 300, "cy": 200,
         "position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}])");
    const auto cameras = readCameraFile(work.path / "c.json", glm::dvec3(0.0));
    REQUIRE(cameras.size() == 2);
    const Eye& eye = cameras[0].eye;
    CHECK(these(cameras[0].name, cameras[1].name) == these("a", "1"));
    CHECK(glm::length(transform(eye.world_from_camera, {0, 0, 1}) - glm::dvec3(2, 2, 3)) < 1e-12);
    CHECK(glm::length(transform(eye.world_from_camera, {1, 0, 0}) - glm::dvec3(1, 2, 2)) < 1e-12);
    CHECK(these(eye.size_px, eye.intrinsics.cx, eye.intrinsics.cy) ==
          these(glm::uvec2(640, 480), 320.0, 240.0));
    const Eye half = resize(cameras[1].eye, {320, 240});
    CHECK(these(half.intrinsics.fx, half.intrinsics.fy, half.intrinsics.cx, half.intrinsics.cy,
                half.size_px) == these(250.0, 255.0, 150.0, 100.0, glm::uvec2(320, 240)));
}

TEST_CASE_FIXTURE(AtWork, "a Git LFS pointer is named as what it is") {
    const fs::path file = work.path / "pointer";
    writeText(file, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
    const doctest::Contains said(": is a Git LFS pointer");
    CHECK_THROWS_WITH_AS((void)readSettingsFile(file), said, Error);
    CHECK_THROWS_WITH_AS((void)readCameraFile(file, glm::dvec3(0.0)), said, Error);
    CHECK_THROWS_WITH_AS((void)readHeadset(file), said, Error);
    CHECK_THROWS_WITH_AS((void)readHeadMotion(file, MotionAxes::kOpenXr), said, Error);
}

TEST_CASE("numbers are read whole") {
    CHECK(these(parseNumber("1.5"), parseNumber("+2e-3"), parseNumber("-0.25")) == these(1.5, 2e-3, -0.25));
    for (const char* text : {"", "1.5x", "x", "nan", "inf", "1,5", "0x10", "1e999", "--1", "+-1"}) {
        CHECK(!parseNumber(text).has_value());
    }
}

TEST_CASE_FIXTURE(AtWork, "output files appear together, and a run that fails keeps what was there") {
    const fs::path folder = work.path / "a" / "b";
    const auto write = [&](const std::string& text, bool publishes) {
        OutputFiles files(folder);
        writeText(files.staging() / "one", text);
        writeText(files.staging() / "two", text);
        if (publishes) { files.publish(); }
    };
    write("1", false);
    CHECK(work.isEmpty());
    write("1", true);
    write("longer", false);
    CHECK(std::distance(fs::directory_iterator(folder), {}) == 2);
    CHECK(these(fs::file_size(folder / "one"), fs::file_size(folder / "two")) == these(1, 1));
}

TEST_CASE_FIXTURE(AtWork, "an output folder whose path is too long is refused, and nothing of it stays") {
    fs::path folder = work.path;
    constexpr std::size_t kLength = PATH_MAX - 50;  // its hidden folder fits, but 40 more letters do not
    while (folder.string().size() + 102 < kLength) { folder /= std::string(100, 'x'); }
    folder /= std::string(kLength - folder.string().size() - 1, 'y');
    CHECK_THROWS_WITH_AS(
        OutputFiles{folder},
        doctest::Contains("its path may be too long, with 4046 letters; must be a shorter one"), Error);
    CHECK(work.isEmpty());
}

TEST_CASE_FIXTURE(AtWork, "a folder is removed with all in it, and what its links lead to stays") {
    const fs::path kept = work.path / "kept", gone = work.path / "gone";
    for (const fs::path& file : {kept / "1", gone / "1", gone / "a" / "2", gone / "a" / "b" / "3"}) {
        fs::create_directories(file.parent_path());
        writeText(file, "x");
    }
    fs::create_directory_symlink(kept, gone / "a" / "link");
    fs::create_directory_symlink(gone, gone / "a" / "round");
    CHECK(entriesOf(gone).size() == 2);
    removeFolder(gone);
    CHECK_FALSE(fs::exists(gone));
    CHECK(fs::exists(kept / "1"));
    CHECK(entriesOf(gone).empty());
    removeFolder(gone);  // since there is nothing
}

}  // SUITE(setup)
