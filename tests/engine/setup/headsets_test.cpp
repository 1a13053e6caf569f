// Facts about headsets: their files, with those of configs/headsets, and the eyes that look through them.
#include "engine/setup/headset.h"
#include "engine/setup/output_files.h"
#include "shaders/shared/constants.h"
#include "tests/run_program.h"

SUITE(headsets) {

TEST_CASE("every headset of the repository is one that a person could wear, and says who measured it") {
    std::set<std::string> names;
    int canted = 0;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(BINOSPLAT_SOURCE_DIR) / "configs" / "headsets")) {
        INFO(entry.path().string());
        CHECK(entry.path().extension() == ".toml");
        const Headset headset = readHeadset(entry.path());
        CHECK(names.insert(headset.name).second);
        CHECK(headset.source.starts_with("https://"));
        CHECK(headset.size_px.x <= gpu::kMostRowSteps * gpu::kArrivalsStep);  // a row fits into shared memory
        CHECK(headset.eye_distance_m == within(0.055, 0.075));
        CHECK(headset.canting_rad == within(0.0, 0.19));
        canted += headset.canting_rad > 0.0 ? 1 : 0;
        // Displays are mounted to within two degrees (the worst measured here is the HTC Vive Focus 3 with
        // 0.6).
        const ViewAngles &left = headset.angles[kLeft], &right = headset.angles[kRight];
        for (const double off_rad : {left.left_rad + right.right_rad, left.right_rad + right.left_rad,
                                     left.up_rad - right.up_rad, left.down_rad - right.down_rad}) {
            CHECK(std::abs(glm::degrees(off_rad)) < 2.0);
        }
        const auto eyes = headsetEyes(headset, Pose{}, headset.eye_distance_m, headset.size_px);
        for (const int side : {kLeft, kRight}) {
            const ViewAngles& angles = headset.angles[side];
            const double outwards = side == kLeft ? -angles.left_rad : angles.right_rad;
            const double inwards = side == kLeft ? angles.right_rad : -angles.left_rad;
            CHECK(outwards > inwards);
            // Starts straight ahead of the wearer: canting turns the eyes outwards.
            CHECK(glm::degrees(inwards - headset.canting_rad) > 30.0);
            CHECK(glm::degrees(outwards + headset.canting_rad) < 75.0);
            CHECK(glm::degrees(angles.up_rad) == between(35.0, 60.0));
            CHECK(glm::degrees(-angles.down_rad) == between(40.0, 60.0));
            // Pixels are nearly square: unequal angles and unequal sides belong together.
            const Eye& eye = eyes[side];
            CHECK(eye.intrinsics.fx / eye.intrinsics.fy == doctest::Approx(1.0).epsilon(0.25));
            CHECK(eye.intrinsics.cx == between(0.3 * eye.size_px.x, 0.7 * eye.size_px.x));
            // A point 2 m ahead of the wearer lies towards the nose, so on the right in the left picture;
            // with swapped eyes it would not.
            const glm::dvec3 point = transform(inverse(eye.world_from_camera), {0.0, 0.0, 2.0});
            const double share = (eye.intrinsics.fx * point.x / point.z + eye.intrinsics.cx) / eye.size_px.x;
            CHECK(share == between((side == kLeft ? 0.5 : 0.0), (side == kLeft ? 1.0 : 0.5)));
        }
    }
    CHECK(names.size() >= 8);
    CHECK(canted >= 2);
}

TEST_CASE("canted eyes turn outwards") {
    Headset headset;
    headset.angles = {ViewAngles{-0.8, 0.6, 0.7, -0.7}, ViewAngles{-0.6, 0.8, 0.7, -0.7}};
    headset.canting_rad = 0.1;
    const auto eyes = headsetEyes(headset, Pose{}, 0.064, {100, 100});
    for (const int side : {kLeft, kRight}) {
        const double outwards = side == kLeft ? -1.0 : 1.0;
        const glm::dvec3 ahead = eyes[side].world_from_camera.orientation * glm::dvec3(0, 0, 1);
        CHECK(these(ahead.x, ahead.y) ==
              these(doctest::Approx(outwards * std::sin(0.1)), doctest::Approx(0.0)));
        CHECK(eyes[side].world_from_camera.position.x == doctest::Approx(outwards * 0.032));
    }
    // The middle eye sees from the left eye's outer edge to the right eye's.
    const Intrinsics middle = headsetMiddle(headset, Pose{}, {100, 100}).intrinsics;
    CHECK(std::atan(-middle.cx / middle.fx) == doctest::Approx(-0.9));
    CHECK(std::atan((100.0 - middle.cx) / middle.fx) == doctest::Approx(0.9));
}

SCRIPT(headsets, "engine/setup/headsets") {
    const Workplace work;
    runScript({[&](const std::string& text, const std::string&) {
        work.write("h.toml", unescaped(text));
        return tried([&] { return (void)readHeadset(work.path / "h.toml"), ""; });
    }});
}

TEST_CASE_FIXTURE(AtWork, "a headset's file may name its lenses' centres") {
    const std::string top =
        "name = \"a\"\nsource = \"b\"\nsize = \"8x8\"\ncanting_deg = 0\neye_distance_m = 0.06\n";
    const std::string left = "[left]\nleft = -50\nright = 40\nup = 45\ndown = -45\n",
                      right = "[right]\nleft = -40\nright = 50\nup = 45\ndown = -45\n";
    const auto read = [&](const std::string& text) {
        writeText(work.path / "h.toml", text);
        return readHeadset(work.path / "h.toml");
    };
    CHECK(read(top + left + right).lens_centres[kLeft] == glm::dvec3(0.0, 0.0, 1.0));
    const Headset named = read(top + left + "lens_centre = [-3, 2.5]\n" + right);
    CHECK(these(named.lens_centres[kLeft].x, named.lens_centres[kLeft].y, named.lens_centres[kRight]) ==
          these(doctest::Approx(-std::tan(glm::radians(3.0))), doctest::Approx(-std::tan(glm::radians(2.5))),
                glm::dvec3(0.0, 0.0, 1.0)));
}

}  // SUITE(headsets)
