// The scene that moves, against the truth that procedural.h states.
#include "engine/scene/procedural.h"
#include "tests/engine/scene/ply_files.h"

SUITE(clockwork) {

constexpr std::uint64_t kSplats = 10'000;
constexpr double kTurn = 2.0 * std::numbers::pi;

Scene sceneAt(std::uint64_t frame, std::uint64_t splats = kSplats) { return makeBuiltin("builtin:clockwork", splats, {}, frame); }

std::size_t stillCount(const Scene& scene) { return scene.size() * 3 / 5; }

// From `from` to `to`, where t runs from 0 to 1, as procedural.h has it.
double rise(double frame, double from, double to) {
    const double t = std::clamp((frame - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

const glm::dvec3 kPin(0.62, -0.46, 2.44), kPivot(0.62, -0.10, 2.48), kHinge(0.495, -0.985, 2.545), kGlobe(0.94, 0.38, 2.0);

// What moves, and how: by an angle about an axis through a pivot, and along z.
struct Motion {
    std::string thing;
    glm::dvec3 pivot{0.0}, axis{0, 0, 1};
    double angle = 0.0, shift_z = 0.0;
};

// Until a frame, of what is at `p` at frame 0.
Motion motionOf(const glm::dvec3& p, double frame) {
    const double turn = kTurn * frame / 120.0;
    if (p.z < 1.7) {
        for (const auto& [teeth, middle, turns] :
             {std::tuple(18, glm::dvec3(-0.39, 0.24, 1.6), 2.0), std::tuple(9, glm::dvec3(0.015, -0.30, 1.6), -4.0),
              std::tuple(6, glm::dvec3(-0.285, -0.525, 1.6), 6.0)}) {
            // Within the roots of its teeth there is nothing of its neighbours.
            if (glm::length(glm::dvec2(p - middle)) < 0.025 * teeth - 0.05) {
                return {.thing = fmt::format("{} teeth", teeth), .pivot = middle, .angle = turns * turn};
            }
        }
        return {"teeth"};
    }
    if (std::abs(p.z - kHinge.z) < 1e-5) {
        const double open = rise(frame, 20.0, 32.0) - rise(frame, 76.0, 88.0);
        return {.thing = "door", .pivot = kHinge, .axis = {0, 1, 0}, .angle = glm::radians(115.0) * open};
    }
    if (p.z > 2.58) { return {.thing = "cuckoo", .shift_z = -0.35 * (rise(frame, 32.0, 44.0) - rise(frame, 64.0, 76.0))}; }
    if (std::abs(glm::distance(p, kGlobe) - 0.15) < 1e-4) { return {"lamp"}; }
    if (glm::distance(p, kPin) < 0.33 && p.z < 2.445) { return {.thing = "hand", .pivot = kPin, .angle = 2.0 * turn}; }
    const bool is_pendulum = p.y > -0.13 && std::abs(p.z - kPivot.z) < 0.021;
    return {.thing = is_pendulum ? "pendulum" : "unknown", .pivot = kPivot, .angle = glm::radians(20.0) * std::sin(2.0 * turn)};
}

TEST_CASE("clockwork has the same splats in every frame, repeats after 120, and three fifths of it are still to the last bit") {
    CHECK(kClockworkFrames == 120);
    CHECK(builtinFrameCount("clockwork") == 120);
    CHECK(builtinFrameCount("builtin:clockwork") == 120);
    const Scene rest = sceneAt(0);
    const auto still = static_cast<std::ptrdiff_t>(stillCount(rest));
    std::vector<bool> has_changed(rest.size(), false);
    for (const std::uint64_t frame : {1u, 15u, 38u, 60u, 77u, 119u}) {
        CAPTURE(frame);
        const Scene scene = sceneAt(frame);
        REQUIRE(scene.size() == kSplats);
        CHECK(scene.scales == rest.scales);
        CHECK(scene.sh == rest.sh);
        CHECK(scene.sh_degree == 0);
        CHECK_FALSE(scene.isGaussian3d());
        CHECK(std::equal(rest.positions.begin(), rest.positions.begin() + still, scene.positions.begin()));
        CHECK(std::equal(rest.rotations.begin(), rest.rotations.begin() + still, scene.rotations.begin()));
        CHECK(std::equal(rest.opacities.begin(), rest.opacities.begin() + still, scene.opacities.begin()));
        for (std::size_t i = 0; i < scene.size(); ++i) {
            has_changed[i] = has_changed[i] || scene.positions[i] != rest.positions[i] || scene.opacities[i] != rest.opacities[i];
        }
    }
    // The very middle of a wheel turns where it is.
    CHECK(std::count(has_changed.begin() + still, has_changed.end(), false) < 5);
    checkSameScene(sceneAt(120), rest);
    checkSameScene(sceneAt(120 * 7 + 38), sceneAt(38));
}

TEST_CASE("wheels and hand turn, the pendulum swings, the cuckoo comes out of its door and the lamp goes out") {
    const Scene rest = sceneAt(0);
    for (const std::uint64_t frame : {0u, 1u, 9u, 26u, 37u, 41u, 46u, 52u, 60u, 70u, 80u, 88u, 95u, 119u}) {
        CAPTURE(frame);
        const Scene scene = sceneAt(frame);
        const auto at = static_cast<double>(frame);
        const double lamp = 0.95 * (1.0 - rise(at, 40.0, 52.0) + rise(at, 88.0, 100.0));
        std::map<std::string, std::size_t> splats;
        double farthest = 0.0, skewest = 0.0, highest = 0.0;
        for (std::size_t i = stillCount(rest); i < rest.size(); ++i) {
            const glm::dvec3 before(rest.positions[i]);
            const Motion motion = motionOf(before, at);
            ++splats[motion.thing];
            if (motion.thing == "hand") { highest = std::min(highest, before.y - kPin.y); }
            if (motion.thing == "lamp") {
                REQUIRE(scene.opacities[i] == doctest::Approx(lamp));
                REQUIRE((scene.opacities[i] == 0.0f) == (frame >= 52 && frame <= 88));
                REQUIRE(scene.positions[i] == rest.positions[i]);
            }
            if (motion.thing == "teeth") { continue; }
            const glm::dquat turn = glm::angleAxis(motion.angle, motion.axis);
            const glm::dvec3 expected = motion.pivot + turn * (before - motion.pivot) + glm::dvec3(0.0, 0.0, motion.shift_z);
            farthest = std::max(farthest, glm::distance(expected, glm::dvec3(scene.positions[i])));
            for (const glm::vec3& axis : {glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)}) {
                skewest =
                    std::max(skewest, glm::distance(turn * glm::dvec3(rest.rotations[i] * axis), glm::dvec3(scene.rotations[i] * axis)));
            }
        }
        CHECK(farthest < 1e-6);
        CHECK(skewest < 2e-6);
        CHECK(std::abs(highest + 0.31) < 0.03);
        CHECK(splats.size() == 9);
        CHECK_FALSE(splats.contains("unknown"));
        for (const auto& [thing, count] : splats) { CHECK_MESSAGE(count > 20, thing); }
    }
}

TEST_CASE("quaternions of clockwork are unit and never change their sign, from the last frame to the first, too") {
    const auto kept = keepBuiltin("builtin:clockwork", 2000);
    Scene before = sceneAt(119, 2000);
    double longest = 0.0, least_cosine = 1.0;
    for (std::uint64_t frame = 0; frame < 120; ++frame) {
        const Scene scene = sceneAt(frame, 2000);
        for (std::size_t i = 0; i < scene.size(); ++i) {
            longest = std::max(longest, std::abs(glm::length(glm::dquat(scene.rotations[i])) - 1.0));
            least_cosine = std::min(least_cosine, glm::dot(glm::dquat(before.rotations[i]), glm::dquat(scene.rotations[i])));
        }
        before = scene;
    }
    CHECK(longest < 1e-6);
    // Nothing turns faster than the smallest wheel, 18 degrees a frame.
    CHECK(least_cosine == doctest::Approx(std::cos(glm::radians(9.0))).epsilon(1e-5));
}

TEST_CASE("clockwork has exactly the splats asked for, finer ones if there are more") {
    const auto meanArea = [](const Scene& scene) {
        double sum = 0.0;
        for (const glm::vec2& scale : scene.scales) { sum += static_cast<double>(scale.x) * scale.y; }
        return sum / static_cast<double>(scene.size());
    };
    const double area = meanArea(sceneAt(25, 20'000));
    for (const std::uint64_t splats : {2000u, 2001u, 9999u, 60'000u}) {
        CAPTURE(splats);
        const Scene scene = sceneAt(25, splats);
        REQUIRE(scene.size() == splats);
        CHECK(scene.sh.size() == 3 * splats);
        CHECK(meanArea(scene) * static_cast<double>(splats) == doctest::Approx(20'000.0 * area).epsilon(splats < 9000 ? 0.2 : 0.05));
        for (const float opacity : scene.opacities) { REQUIRE(opacity == doctest::Approx(0.95f)); }
    }
    CHECK(makeBuiltin("clockwork").size() == 20'000);
    CHECK(contains(loadError("builtin:clockwork", 1999), "1999 splats asked for, expected 2000 to 1000000"));
    // The others do not move.
    for (const BuiltinInfo& info : listBuiltins()) {
        if (info.name == "clockwork") { continue; }
        CAPTURE(info.name);
        CHECK(builtinFrameCount(info.name) == 1);
        CHECK(errorOf([&] { (void)makeBuiltin(info.name, 0, {}, 1); }) ==
              info.name + ": frame 1 asked for, expected 0: this scene does not move");
    }
    CHECK_NOTHROW((void)makeBuiltin("builtin:one-splat", 1, {}, 0));
    CHECK(builtinFrameCount("castle") == 1);
}

}  // SUITE(clockwork)
