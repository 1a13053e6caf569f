// Facts about thinning out a scene.
#include "engine/levels/thin_out.h"
#include "engine/files/load_scene.h"
#include "engine/files/lod_meta.h"
#include "engine/levels/scene_levels.h"
#include "engine/levels/surroundings.h"

#include "engine/builtin/procedural.h"
#include "engine/places/standpoint.h"
#include "engine/scene/pick_splats.h"
#include "engine/temporary_folder.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/shared_data.h"

SUITE(thin_out) {

using test::Gpu;

// How alike the whole scene and `other` are to the eyes of `seen`.
double decibels(ThinOut& seen, const Scene& other) { return -10.0 * std::log10(seen.errorOf(other)); }

// As many splats, chosen blindly, that cover the same area.
Scene widenSome(const Scene& scene, std::size_t count) {
    std::vector<std::uint32_t> some = numbersUpTo(scene.size());
    std::mt19937 random(1);
    std::ranges::shuffle(some, random);
    some.resize(count);
    Scene wider = pickSplats(scene, some);
    for (glm::vec2& scale : wider.scales) {
        scale *= std::sqrt(static_cast<float>(scene.size()) / static_cast<float>(count));
    }
    return wider;
}

// How alike the whole scene and the thin one are; at least 5 dB more than a random one.
double decibelsOverRandom(ThinOut& seen, const Scene& scene, const Scene& thin) {
    const double of_thin = decibels(seen, thin), of_random = decibels(seen, widenSome(scene, thin.size()));
    MESSAGE(of_thin << " dB, random and wider " << of_random << " dB");
    CHECK(of_thin >= of_random + 5.0);
    return of_thin;
}

// Before a vase, seen larger than from anywhere in the room.
Eye eyeBeforeVase() {
    const glm::uvec2 size_px(160);
    return {lookAt({0.1, -1.45, 0.35}, {0.02, -1.06, 5.0}, {0.0, -1.0, 0.0}),
            intrinsicsFromFovX(glm::radians(70.0), size_px), size_px};
}

TEST_CASE_FIXTURE(Gpu,
                  "a scene thinned out by what it shows is 5 dB nearer to the whole than a random one, and "
                  "always the same") {
    const Scene scene = makeBuiltin("builtin:atelier", 12000);
    const std::size_t kept = scene.size() / 2;
    const double near = usualNear(scene);
    ThinOut thin_out(context(), scene, standingEyes(scene, 24, 0, 96), near);
    const Scene thin = thin_out.keep(kept);
    REQUIRE(thin.size() == kept);
    const Scene again = thin_out.keep(kept);
    CHECK(these(again.positions, again.scales, again.opacities, again.sh) ==
          these(thin.positions, thin.scales, thin.opacities, thin.sh));
    ThinOut elsewhere(context(), scene, standingEyes(scene, 6, 30, 96), near);
    decibelsOverRandom(elsewhere, scene, thin);
    // There were holes in it.
    ThinOut nearby(context(), scene, {eyeBeforeVase()}, near);
    CHECK(decibels(nearby, thin) >= 26.0);
}

TEST_CASE_FIXTURE(Gpu,
                  "a tenth of a scene's splats has no holes close by, and is better where it was fitted") {
    const Scene scene = makeBuiltin("builtin:atelier", 12000);
    const double near = usualNear(scene);
    const std::size_t kept = scene.size() / 10;
    const auto keep = [&](gpu::uint side_of_few_px) {
        ThinOut thin_out(context(), scene, standingEyes(scene, 12, 0, 96), near, {}, 4, side_of_few_px);
        return thin_out.keep(kept);
    };
    const Scene thin = keep(0), fitted_small = keep(32);
    REQUIRE(these(thin.size(), fitted_small.size()) == these(kept, kept));
    ThinOut small(context(), scene, standingEyes(scene, 6, 30, 32), near);
    CHECK(decibels(small, fitted_small) >= decibels(small, thin) + 0.3);
    ThinOut nearby(context(), scene, {eyeBeforeVase()}, near);
    CHECK(decibels(nearby, thin) >= 20.0);
}

TEST_CASE_FIXTURE(Gpu, "what each splat is off by adds up to what the pictures are") {
    const Scene scene = makeBuiltin("builtin:atelier", 4000);
    ThinOut thin_out(context(), scene, standingEyes(scene, 6, 0, 64), usualNear(scene));
    const Scene some = widenSome(scene, 500);
    double weight = 0.0, square = 0.0;
    for (const SplatError& error : thin_out.splatErrorsOf(some)) {
        CHECK(error.square <= error.weight);
        weight += error.weight, square += error.square;
    }
    // The walls let hardly any light through.
    CHECK(square / weight == doctest::Approx(thin_out.errorOf(some)).epsilon(0.05));
    double nothing = 0.0;
    for (const SplatError& error : thin_out.splatErrorsOf(scene)) { nothing += error.square; }
    CHECK(nothing == 0.0);
}

TEST_CASE_FIXTURE(Gpu, "what lies behind very many splats in a single tile is judged as well") {
    // Dots that let some light through, in front of a disc in the middle.
    constexpr int kDotsPerSide = 550;
    Scene scene = makeBuiltin("builtin:one-splat");
    scene = pickSplats(scene, std::vector<std::uint32_t>(kDotsPerSide * kDotsPerSide + 1, 0));
    for (std::size_t i = 0; i + 1 < scene.size(); ++i) {
        const auto at = [](std::size_t place) {
            return 1.9f * (static_cast<float>(place) + 0.5f) / kDotsPerSide - 0.95f;
        };
        scene.positions[i] = {at(i % kDotsPerSide), at(i / kDotsPerSide), 2.0f};
        scene.scales[i] = glm::vec2(1e-3f);
        scene.opacities[i] = 1.3f / 255.0f;
    }
    scene.positions.back() = {0.0f, 0.0f, 4.0f};
    const glm::uvec2 size_px(gpu::kTileSize);
    const Eye eye{Pose{}, intrinsicsFromFovX(glm::radians(53.13), size_px), size_px};
    ThinOut thin_out(context(), scene, {eye}, 0.2);
    CHECK(thin_out.splatErrorsOf(scene).back().weight > 0.05);
    const std::vector<std::uint32_t> most = thin_out.choose(scene.size() - 1);
    CHECK(most.back() == scene.size() - 1);
}

TEST_CASE("what lies far outside is found if it is neither a few strays nor too much to be always shown") {
    std::vector<glm::vec3> centres;
    for (const glm::vec3& position : makeBuiltin("builtin:slanted-wall").positions) {
        centres.insert(centres.end(), 4, position);
    }
    const std::size_t inside = centres.size();
    CHECK(!findSurroundings(centres));
    const auto withDome = [&](std::size_t count) {
        centres.resize(inside);
        for (std::size_t i = 0; i < count; ++i) {
            const auto angle = static_cast<float>(i);
            centres.push_back({200.0f * std::cos(angle), -30.0f, 200.0f * std::sin(angle)});
        }
        return findSurroundings(centres);
    };
    const auto found = withDome(1000);
    REQUIRE(found);
    for (std::size_t i = 0; i < centres.size(); ++i) { CHECK(found->has(centres[i]) == (i >= inside)); }
    CHECK(!withDome(100));
    CHECK(!withDome(inside / 2));
}

TEST_CASE_FIXTURE(
    Gpu,
    "a scene of several blocks gets as many levels as one of a single block, the same bytes every time") {
    const Scene scene = makeBuiltin("builtin:atelier", 3000);
    const TemporaryFolder folder("binosplat-levels", "for a test");
    LevelSettings settings{
        .levels = 4, .eyes = standingEyes(scene, 12, 0, 48), .near = usualNear(scene), .block_splats = 1000};
    settings.block_eyes = 2, settings.block_side_px = 64, settings.block_steps = 2;
    const auto write = [&](const std::string& name, const Progress& progress = {}) {
        StreamedWriter writer((folder.path() / name / "lod-meta.json").string(), {.leaf_splats = 300});
        writer.cutLeaves(scene.positions);
        const auto parts = [&](const std::function<void(Scene)>& take) {
            const std::vector<std::uint32_t> all = numbersUpTo(scene.size());
            take(pickSplats(scene, std::span(all).first(700)));
            take(pickSplats(scene, std::span(all).subspan(700)));
        };
        writeSceneLevels(context(), parts, settings, writer, progress);
        writer.finish();
        return textIn(folder.path() / name / "lod-meta.json");
    };
    double done = 0.0;
    const std::string text = write("a", [&](double share) { done = std::max(done, share); });
    CHECK(these(done > 0.9, done <= 1.0) == these(true, true));
    CHECK(write("b") == text);
    const LodMeta meta = parseLodMeta(std::as_bytes(std::span(text)), "lod-meta.json");
    REQUIRE(these(meta.has_errors, meta.levels.size()) == these(true, 4u));
    for (std::size_t level = 0; level < 4; ++level) {
        const auto expected = static_cast<double>(scene.size() >> level);
        CHECK(static_cast<double>(meta.levels[level].splats) == doctest::Approx(expected).epsilon(0.01));
    }
    for (const LodLeaf& leaf : meta.tree) { CHECK(std::ranges::is_sorted(leaf.errors)); }
    CHECK_THROWS(write("c", [](double share) { check(share < 0.5, "cancelled"); }));
    CHECK(entriesOf(folder.path()).size() == 2);
}

// Takes minutes, so only the nightly tests run it.
TEST_CASE_FIXTURE(Gpu, "half of playbot's splats show it from elsewhere within 33.5 dB, a fifth within 27.5" *
                           test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    const Scene scene = loadScene((*data / "playbot/playbot_lod2_2dgs_sh2.ply").string());
    const double near = usualNear(scene);
    ThinOut thin_out(context(), scene, standingEyes(scene), near);
    ThinOut elsewhere(context(), scene, standingEyes(scene, 8, 54), near);
    for (const auto& [part, least] : {std::pair(2u, 33.5), std::pair(5u, 27.5)}) {
        CHECK(decibelsOverRandom(elsewhere, scene, thin_out.keep(scene.size() / part)) >= least);
    }
}

TEST_CASE_FIXTURE(Gpu, "half of each shared scene's splats are 5 dB nearer to it than a random half" *
                           test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    for (const char* name :
         {"statues/angel.sog", "guitar/guitar.compressed.ply", "playbot/playbot_lod3_2dgs_sh2.ply"}) {
        const Scene scene = loadScene((*data / name).string());
        ThinOut thin_out(context(), scene, standingEyes(scene, 24, 0, 128), usualNear(scene));
        ThinOut elsewhere(context(), scene, standingEyes(scene, 8, 30, 128), usualNear(scene));
        CAPTURE(name);
        decibelsOverRandom(elsewhere, scene, thin_out.keep(scene.size() / 2));
    }
}

}  // SUITE(thin_out)
