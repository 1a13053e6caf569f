// Facts about the headsets in configs/headsets: every file reads, and what it describes is something a person could wear.
#include "engine/error.h"
#include "engine/setup/headset.h"
#include "shaders/shared/constants.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

TEST_SUITE_BEGIN("headsets");

namespace headsets_test {

namespace fs = std::filesystem;
using namespace binosplat;

namespace {

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

std::vector<fs::path> headsetFiles() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(BINOSPLAT_SOURCE_DIR) / "configs" / "headsets")) {
        files.push_back(entry.path());
    }
    return files;
}

// The angles of an eye from straight ahead of the wearer: canting turns them outwards.
ViewAngles fromHead(const Headset& headset, int side) {
    ViewAngles angles = headset.angles[static_cast<std::size_t>(side)];
    const double turn = side == kLeft ? -headset.canting_rad : headset.canting_rad;
    angles.left_rad += turn;
    angles.right_rad += turn;
    return angles;
}

}  // namespace

TEST_CASE("headsetsAreManyAndNamedApart") {
    std::set<std::string> names;
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        CHECK(file.extension() == ".toml");
        CHECK(names.insert(readHeadset(file).name).second);
    }
    CHECK(names.size() >= 8);
}

TEST_CASE("everyHeadsetSaysWhoMeasuredIt") {
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        CHECK(readHeadset(file).source.starts_with("https://"));
    }
}

TEST_CASE("everyHeadsetHasRowsThatFitIntoSharedMemory") {
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        CHECK(readHeadset(file).size_px.x <= gpu::kMostRowSteps * gpu::kArrivalsStep);
    }
}

TEST_CASE("everyHeadsetHasEyesAPersonCouldUse") {
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        const Headset headset = readHeadset(file);
        CHECK(headset.eye_distance_m >= 0.055);
        CHECK(headset.eye_distance_m <= 0.075);
        CHECK(headset.canting_rad < 0.2);
        for (int side : {kLeft, kRight}) {
            const ViewAngles angles = fromHead(headset, side);
            const double outwards = side == kLeft ? -angles.left_rad : angles.right_rad;
            const double inwards = side == kLeft ? angles.right_rad : -angles.left_rad;
            CHECK(outwards > inwards);
            CHECK(degrees(inwards) > 30.0);
            CHECK(degrees(outwards) < 75.0);
            CHECK(degrees(angles.up_rad) > 35.0);
            CHECK(degrees(-angles.down_rad) > 40.0);
            CHECK(degrees(angles.up_rad) < 60.0);
            CHECK(degrees(-angles.down_rad) < 60.0);
        }
    }
}

TEST_CASE("leftAndRightEyesAreNearlyMirrored") {
    // Displays are mounted to within two degrees (the HTC Vive Focus 3 measured here is the worst, 0.6).
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        const Headset headset = readHeadset(file);
        const ViewAngles &left = headset.angles[kLeft], &right = headset.angles[kRight];
        CHECK(std::abs(degrees(left.left_rad + right.right_rad)) < 2.0);
        CHECK(std::abs(degrees(left.right_rad + right.left_rad)) < 2.0);
        CHECK(std::abs(degrees(left.up_rad - right.up_rad)) < 2.0);
        CHECK(std::abs(degrees(left.down_rad - right.down_rad)) < 2.0);
    }
}

TEST_CASE("pixelsOfEveryHeadsetAreNearlySquare") {
    // Unequal angles and unequal sides belong together: the focal lengths of both axes agree to 25 % in the middle of the picture.
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        const Headset headset = readHeadset(file);
        for (const Eye& eye : headsetEyes(headset, Pose{}, headset.eye_distance_m, headset.size_px)) {
            CHECK(eye.intrinsics.fx / eye.intrinsics.fy == doctest::Approx(1.0).epsilon(0.25));
            CHECK(eye.intrinsics.cx > 0.3 * eye.size_px.x);
            CHECK(eye.intrinsics.cx < 0.7 * eye.size_px.x);
        }
    }
}

TEST_CASE("bothEyesOfEveryHeadsetSeeWhatIsAhead") {
    // A point 2 m ahead of the wearer; were the eyes swapped, it would lie on the wrong side of both middles.
    for (const fs::path& file : headsetFiles()) {
        INFO(file.string());
        const Headset headset = readHeadset(file);
        const auto eyes = headsetEyes(headset, Pose{}, headset.eye_distance_m, headset.size_px);
        double x_px[2];
        for (int side : {kLeft, kRight}) {
            const Eye& eye = eyes[static_cast<std::size_t>(side)];
            const glm::dvec3 point = transform(inverse(eye.world_from_camera), {0.0, 0.0, 2.0});
            x_px[side] = eye.intrinsics.fx * point.x / point.z + eye.intrinsics.cx;
            CHECK(x_px[side] > 0.0);
            CHECK(x_px[side] < eye.size_px.x);
        }
        // Each eye looks farther outwards: what is ahead lies towards the nose, right in the left picture.
        CHECK(x_px[kLeft] > 0.5 * headset.size_px.x);
        CHECK(x_px[kRight] < 0.5 * headset.size_px.x);
    }
}

TEST_CASE("cantedHeadsetsAreAmongThem") {
    int canted = 0;
    for (const fs::path& file : headsetFiles()) { canted += readHeadset(file).canting_rad > 0.0 ? 1 : 0; }
    CHECK(canted >= 2);
}

}  // namespace headsets_test
