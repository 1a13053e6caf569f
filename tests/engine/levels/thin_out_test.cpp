// Facts about thinning a scene out.
#include "engine/levels/thin_out.h"
#include "engine/files/load_scene.h"

#include "engine/builtin/procedural.h"
#include "engine/places/standpoint.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/shared_data.h"

SUITE(thin_out) {

using test::Gpu;

double decibels(double mean_square) { return -10.0 * std::log10(mean_square); }

// As many splats, chosen blindly, that cover as much.
Scene widenSome(const Scene& scene, std::size_t count) {
    std::vector<std::uint32_t> some(scene.size());
    std::iota(some.begin(), some.end(), 0u);
    std::mt19937 random(1);
    std::ranges::shuffle(some, random);
    some.resize(count);
    Scene wider = pickSplats(scene, some);
    for (glm::vec2& scale : wider.scales) {
        scale *= static_cast<float>(std::sqrt(static_cast<double>(scene.size()) / static_cast<double>(count)));
    }
    return wider;
}

TEST_CASE_FIXTURE(Gpu, "a scene thinned out by what it shows is 5 dB nearer to the whole than a random one, and always the same") {
    const Scene scene = makeBuiltin("builtin:atelier", 12000);
    const std::size_t kept = scene.size() / 2;
    const double near = usualNear(scene);
    ThinOut thin_out(context(), scene, standingEyes(scene, 24, 0, 96), near);
    const Scene thin = thin_out.keep(kept);
    REQUIRE(thin.size() == kept);
    const Scene again = thin_out.keep(kept);
    CHECK(these(again.positions, again.scales, again.opacities, again.sh) == these(thin.positions, thin.scales, thin.opacities, thin.sh));
    ThinOut elsewhere(context(), scene, standingEyes(scene, 6, 30, 96), near);
    const double of_thin = decibels(elsewhere.errorOf(thin)), of_random = decibels(elsewhere.errorOf(widenSome(scene, kept)));
    MESSAGE(of_thin << " dB, random and wider " << of_random << " dB");
    CHECK(of_thin >= of_random + 5.0);
}

// Takes minutes: a line of the nightly tests.
TEST_CASE_FIXTURE(Gpu, "a fifth of playbot's splats show it from elsewhere within 27.5 dB" * test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    const Scene scene = loadScene((*data / "playbot/playbot_lod2_2dgs_sh2.ply").string());
    const double near = usualNear(scene);
    ThinOut thin_out(context(), scene, standingEyes(scene), near);
    ThinOut elsewhere(context(), scene, standingEyes(scene, 8, 54), near);
    const std::size_t kept = scene.size() / 5;
    const double of_thin = decibels(elsewhere.errorOf(thin_out.keep(kept))),
                 of_random = decibels(elsewhere.errorOf(widenSome(scene, kept)));
    MESSAGE(of_thin << " dB, random and wider " << of_random << " dB");
    CHECK(of_thin >= 27.5);
    CHECK(of_thin >= of_random + 3.0);
}

}  // SUITE(thin_out)
