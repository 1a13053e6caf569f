// Facts about recorded head motion.
#include "engine/setup/head_motion.h"
#include "tests/script.h"
#include "tests/shared_data.h"

SUITE(motion) {

constexpr double kQuarter = std::numbers::pi / 2.0;
const std::string kHeader = "timestamp,x,y,z,qx,qy,qz,qw\n";

HeadMotion parse(const std::string& text, MotionAxes axes = MotionAxes::kOpenXr) {
    return parseHeadMotion(text, "m.csv", axes);
}

bool near(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

glm::dvec3 forwardOf(const Pose& pose) { return pose.orientation * glm::dvec3(0.0, 0.0, 1.0); }

void checkPose(const Pose& pose, const glm::dvec3& position, const glm::dvec3& forward,
               const glm::dvec3& down) {
    CHECK(near(pose.position, position));
    CHECK(near(forwardOf(pose), forward));
    CHECK(near(pose.orientation * glm::dvec3(0.0, 1.0, 0.0), down));
}

TEST_CASE("the axes of OpenXR and of Unity become the camera's") {
    const glm::dvec3 right(1.0, 0.0, 0.0), up(0.0, 1.0, 0.0), back(0.0, 0.0, 1.0);
    struct {
        MotionAxes axes;
        glm::dvec3 about;                    // a positive quarter turn about this axis of the recording
        glm::dvec3 forward, up_of_the_head;  // the directions that result, in the camera's axes
    } const turns[]{// Right-handed: a turn about y (up) looks left, about x up, about z tilts to the left.
                    {MotionAxes::kOpenXr, up, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}},
                    {MotionAxes::kOpenXr, right, {0.0, -1.0, 0.0}, {0.0, 0.0, -1.0}},
                    {MotionAxes::kOpenXr, back, {0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0}},
                    // Left-handed: they look right, look down, and tilt to the left.
                    {MotionAxes::kUnity, up, {1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}},
                    {MotionAxes::kUnity, right, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                    {MotionAxes::kUnity, back, {0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0}}};
    for (const auto& turn : turns) {
        const Pose pose = poseFromRecording({}, glm::angleAxis(kQuarter, turn.about), turn.axes);
        checkPose(pose, glm::dvec3(0.0), turn.forward, -turn.up_of_the_head);
    }
    // One metre to the right, two up and three ahead.
    for (const auto& [axes, ahead] : {std::pair(MotionAxes::kOpenXr, -3.0), {MotionAxes::kUnity, 3.0}}) {
        const Pose still = poseFromRecording({1.0, 2.0, ahead}, glm::dquat(1.0, 0.0, 0.0, 0.0), axes);
        checkPose(still, {1.0, -2.0, 3.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0});
    }
}

TEST_CASE("headers, blanks and comments are optional, and orientations are normalised") {
    for (const std::string& text :
         {kHeader + "0,1,2,3,0,0,0,1\n0.5,1,2,3,0,0,0,1\n",
          std::string("0,1,2,3,0,0,0,1.01\n0.5,1,2,3,0,0,0,1"),
          std::string(
              "\xef\xbb\xbf# a walk\r\n\r\n 0 ,\t1, 2,3 ,0,0,0,1 \r\n0.5,1,+2,3e0,0,0,0,1\r\n\r\n")}) {
        const HeadMotion motion = parse(text);
        const Pose start = motion.poseAt(0.0);
        CHECK(these(motion.samples().size(), motion.duration_s(), glm::length(start.orientation)) ==
              these(2, 0.5, doctest::Approx(1.0).epsilon(1e-15)));
        CHECK(near(start.position, {1.0, -2.0, -3.0}));
    }
    const double half = std::sqrt(0.5);
    const std::string values = fmt::format("0,0,0,0,{},{},0,0\n", half, half);
    // Here w comes first.
    CHECK(near(forwardOf(parse("time_s,x,y,z,qw,qx,qy,qz\n" + values).poseAt(0.0)), {0.0, -1.0, 0.0}));
    CHECK_FALSE(near(forwardOf(parse(kHeader + values).poseAt(0.0)), {0.0, -1.0, 0.0}));
}

SCRIPT(motion, "engine/setup/motion") {
    const auto read = [](const std::string& text) {
        const HeadMotion motion = parse(unescaped(text));
        CHECK(motion.startingAt(0.5 * motion.duration_s()).note() == motion.note());
        return fmt::format("{} s\n{}{}", motion.duration_s(), motion.note(),
                           motion.note().empty() ? "" : "\n");
    };
    runScript(
        {[&](const std::string& text, const std::string&) { return tried([&] { return read(text); }); }});
}

TEST_CASE("poses between samples lie on the way") {
    // A quarter turn to the left in two seconds. The second orientation is written with the opposite sign,
    // which is the same turn.
    const double half = std::sqrt(0.5);
    const HeadMotion motion = parse(fmt::format("10,0,0,0,0,0,0,1\n12,4,0,0,0,{},0,{}\n", -half, -half));
    CHECK(near(motion.poseAt(1.0).position, {2.0, 0.0, 0.0}));
    for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0}) {
        const double angle = share * kQuarter;
        CHECK(near(forwardOf(motion.poseAt(2.0 * share)), {-std::sin(angle), 0.0, std::cos(angle)}));
    }
    // The head keeps still outside of the recording.
    CHECK(near(motion.poseAt(-5.0).position, {0.0, 0.0, 0.0}));
    checkPose(motion.poseAt(99.0), {4.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
    CHECK(near(parse("3,1,0,0,0,0,0,1\n").poseAt(7.0).position, {1.0, 0.0, 0.0}));
}

TEST_CASE("a camera starts where it is put and moves in its own frame") {
    // The recorded wearer first looks left (a quarter turn about y), so ahead is the recording's -x; then
    // steps half a metre ahead and looks another quarter turn to the left.
    const double half = std::sqrt(0.5);
    const HeadMotion motion = parse(fmt::format("0,7,8,9,0,{},0,{}\n1,6.5,8,9,0,1,0,0\n", half, half));
    const Pose start = lookAt({1.0, 2.0, 3.0}, {1.0, 2.0, 13.0}, {1.0, 0.0, 0.0});
    checkPose(motion.cameraAt(0.0, start, 4.0), start.position, {0.0, 0.0, 1.0}, {-1.0, 0.0, 0.0});
    // Half a metre is two units here. Up is world x and ahead world z, so right is world y.
    checkPose(motion.cameraAt(1.0, start, 4.0), {1.0, 2.0, 5.0}, {0.0, -1.0, 0.0}, {-1.0, 0.0, 0.0});
    // The path is as long as recorded, times the scale.
    CHECK(glm::length(motion.cameraAt(0.5, start, 4.0).position - start.position) == doctest::Approx(1.0));
    CHECK(glm::length(motion.cameraAt(1.0, start).position - start.position) == doctest::Approx(0.5));
}

TEST_CASE("a segment's frames are its samples, or at a rate, and its end is not one of them") {
    const HeadMotion motion = parse("0,0,0,0,0,0,0,1\n0.5,1,0,0,0,0,0,1\n1,3,0,0,0,0,0,1\n2,3,0,0,0,0,0,1\n");
    using Times = std::vector<double>;
    CHECK(these(frameTimes(motion, {}, "m"), frameTimes(motion, {0.0, 1.0, {}}, "m"),
                frameTimes(motion, {0.0, {}, 2.0}, "m")) ==
          these(Times{0.0, 0.5, 1.0, 2.0}, Times{0.0, 0.5}, Times{0.0, 0.5, 1.0, 1.5, 2.0}));
    CHECK(these(frameTimes(motion, {0.0, 1.0, 2.0}, "m"), frameTimes(motion, {0.0, 2.0, 90.0}, "m").size()) ==
          these(Times{0.0, 0.5}, 180));
    CHECK(frameTimes(motion, {0.0, 100.0, 2.0}, "m").size() == 5);  // not beyond the end of the recording
    // From between two samples on, relative to the pose there.
    const HeadMotion rest = motion.startingAt(0.75);
    CHECK(frameTimes(rest, {}, "m") == Times{0.0, 0.25, 1.25});
    CHECK(these(rest.duration_s(), rest.poseAt(0.0).position.x, rest.cameraAt(0.25, {}).position.x) ==
          these(1.25, doctest::Approx(2.0), doctest::Approx(1.0)));
    CHECK_THROWS_AS(frameTimes(motion, {0.0, {}, 1e6}, "m"), Error);
}

TEST_CASE("the shared recording reads" * test::needsSharedData()) {
    const auto data = binosplat::test::sharedData();
    if (!data) { return; }
    const HeadMotion motion = readHeadMotion(*data / "headmotion" / "User3.csv", MotionAxes::kUnity);
    CHECK(these(motion.samples().size(), motion.duration_s(),
                motion.samples().front().world_from_head.position.z) ==
          these(4597, doctest::Approx(76.5515291).epsilon(1e-9), doctest::Approx(0.09279076)));
}

}  // SUITE(motion)
