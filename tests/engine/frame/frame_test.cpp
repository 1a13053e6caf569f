// Facts about whole frames compared with the twin: pictures, depths and moments of real, built-in and
// analytic scenes.
#include "engine/files/load_scene.h"
#include "engine/picture/image_io.h"
#include "engine/srgb.h"
#include "engine/twin/reach.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/pass_stages.h"
#include "tests/shared_data.h"

SUITE(frame) {

FrameSettings makeSettings(const glm::dvec3& background = glm::dvec3(0.0), bool moments = false) {
    FrameSettings settings;
    settings.mode = Mode::kMono;
    settings.background = background;
    settings.keep_moments = moments;
    return settings;
}

reference::Settings twinSettings(const FrameSettings& settings) {
    reference::Settings twin;
    twin.near = settings.near;
    twin.background = settings.background;
    twin.inverse_depth_moments = settings.keep_moments;
    return twin;
}

reference::Picture renderTwin(const ViewedScene& view, const FrameSettings& settings) {
    return reference::render(view.scene, view.eye, twinSettings(settings));
}

// How close a pixel of the twin comes to a threshold of blending. Whatever the precision, rounding sometimes
// moves a value across a threshold, and then a hit counts in full or not at all: alpha at 1/255 (a weight of
// up to 4e-3), transmittance at 1e-4 (a weight of up to 1e-2, since alpha is at most 0.99), a hit at the near
// plane, or the disc's own depth instead of its centre's. A 3D Gaussian has only one depth, without a second
// one from the low-pass. Two hits also change places if the depths of their centres, by which they are
// sorted, agree within rounding; ten units in the last place take the part of the others' 1e-5 here.
struct Threshold {
    const char* name = "none";
    double distance = 1.0;  // relative
    void meet(const char* threshold, double relative_distance) {
        if (std::abs(relative_distance) < distance) { *this = {threshold, std::abs(relative_distance)}; }
    }
};

// The threshold to which pixel `i` of the twin comes closest.
Threshold nearestThreshold(const test::TwinStages& twin, const Eye& eye, const reference::Settings& settings,
                           std::size_t i) {
    const glm::uvec2 pixel(i % eye.size_px.x, i / eye.size_px.x);
    const glm::dvec2 pixel_px = glm::dvec2(pixel) + 0.5;
    const std::uint32_t columns = (eye.size_px.x + gpu::kTileSize - 1) / gpu::kTileSize;
    const reference::TileRange range =
        twin.ranges[std::size_t{pixel.y / gpu::kTileSize} * columns + pixel.x / gpu::kTileSize];
    Threshold nearest;
    double transmittance = 1.0, depth_before = 0.0;
    for (std::uint32_t at = range.begin; at < range.end; ++at) {
        const reference::ProjectedSplat& splat = twin.splats[twin.sorted_pairs[at].splat];
        reference::RayPlane plane = reference::rayPlane(splat, eye.size_px, settings.near);
        plane.cut += 0.1;  // includes hits slightly below 1/255
        reference::RayPlane disc = plane, low_pass = plane;
        disc.low_pass = low_pass.disc = false;
        reference::Hit hit, hit_disc, hit_low_pass;
        if (!reference::meet(plane, pixel_px, hit)) { continue; }
        if (reference::meet(disc, pixel_px, hit_disc)) {
            nearest.meet("near", hit_disc.depth / settings.near - 1.0);
            if (reference::meet(low_pass, pixel_px, hit_low_pass)) {
                nearest.meet("low-pass", hit_low_pass.rho / hit_disc.rho - 1.0);
            }
        }
        const double alpha = std::min(0.99, splat.opacity * std::exp(-0.5 * hit.rho));
        nearest.meet("alpha", alpha * 255.0 - 1.0);
        if (alpha < 1.0 / 255.0) { continue; }
        nearest.meet("order", 10.0 * (depth_before / splat.depth - 1.0));
        depth_before = splat.depth;
        const double after = transmittance * (1.0 - alpha);
        nearest.meet("transmittance", after / 1e-4 - 1.0);
        if (after < 1e-4) { break; }
        transmittance = after;
    }
    return nearest;
}

// How far the depths of opaque pixels are from the twin's: how many are wrong by more than 1e-3 of their
// value, and which of these is farthest from any threshold.
struct DepthErrors {
    std::uint64_t opaque = 0, off = 0;
    double greatest = 0.0, farthest_from_threshold = 0.0;
};
DepthErrors compareDepths(const Image& image, const reference::Picture& truth, const test::TwinStages& twin,
                          const Eye& eye, const reference::Settings& settings) {
    DepthErrors errors;
    for (std::size_t i = 0; i < truth.depth.size(); ++i) {
        if (truth.rgba[i].a <= 0.5) { continue; }
        const double difference = std::abs(static_cast<double>(image.values[i]) - truth.depth[i]);
        ++errors.opaque;
        errors.greatest = std::max(errors.greatest, std::isnan(difference) ? HUGE_VAL : difference);
        if (difference <= 1e-3 * truth.depth[i]) { continue; }
        ++errors.off;
        errors.farthest_from_threshold =
            std::max(errors.farthest_from_threshold, nearestThreshold(twin, eye, settings, i).distance);
    }
    return errors;
}

double farthestDepth(const ViewedScene& view) {
    double farthest = 0.0;
    const Pose camera_from_world = inverse(view.eye.world_from_camera);
    for (const glm::vec3& position : view.scene.positions) {
        farthest = std::max(farthest, transform(camera_from_world, glm::dvec3(position)).z);
    }
    return farthest;
}

// A frame must equal the twin's up to rounding, and its depths must agree within 1e-3 wherever no value of
// the twin lies within 1e-5 of a threshold, which holds for all but 1e-4 of the pixels. Measured: 1 of the
// atelier's 589,824 pixels is wrong, and none in the others; with Mesa 25 also 11 of 133,045, where two of
// playbot's 3D Gaussians change places. Returns the picture.
Image checkAgainstTwin(Gpu& gpu, const ViewedScene& view, const FrameSettings& settings, double least_db,
                       double most_off = 1e-5) {
    CAPTURE(view.name);
    const auto frame = renderMono(gpu.context(), view.scene, view.eye, settings);
    const reference::Settings twin_settings = twinSettings(settings);
    const test::TwinStages stages(view, twin_settings);
    const reference::Picture twin =
        reference::rasterize(stages.splats, stages.sorted_pairs, stages.ranges, view.eye, twin_settings);
    const Difference difference = compare(frame.picture, test::toImage(twin), 4);
    const DepthErrors depth = compareDepths(frame.depth, twin, stages, view.eye, twin_settings);
    CHECK(difference.not_finite == 0);
    CHECK(difference.psnrDb() >= least_db);
    CHECK(difference.shareOff() <= 0.0002);
    CHECK(compare(frame.depth, frame.depth, 1).not_finite == 0);
    CHECK(static_cast<double>(depth.off) <= 1.0 + most_off * static_cast<double>(depth.opaque));
    CHECK(depth.farthest_from_threshold <= 1e-5);
    CHECK(depth.greatest <= 0.0101 * farthestDepth(view));
    return frame.picture;
}

// Views of playbot, from the whole figure to its face.
const View kWhole{{0.0, -0.6, -1.6}, {0.0, -0.4, 0.0}, {0.0, -1.0, 0.0}, 60.0};
const View kNear{{0.3, -0.7, -0.8}, {0.0, -0.6, 0.0}, {0.0, -1.0, 0.0}, 90.0};

TEST_CASE_FIXTURE(Gpu, "real scenes are rendered as the twin renders them" * test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    const struct {
        const char* file;
        View view;
        double least_db;
    } cases[] = {
        // Measured: 90.9, 90.1 and 99.5 dB.
        {"playbot/playbot_lod2_2dgs_sh2.ply", kWhole, 87.0},
        {"playbot/playbot_lod3_2dgs_sh2.ply", kNear, 87.0},
        {"statues/angel_2dgs_sh0.ply", {{0.0, -2.0, -5.0}, {0.0, -2.0, 0.0}, {0.0, -1.0, 0.0}, 60.0}, 96.0},
    };
    for (const auto& [file, view, least_db] : cases) {
        checkAgainstTwin(*this, {file, loadScene((*data / file).string()), test::eyeOf(view, {384, 384})},
                         makeSettings(), least_db);
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "the atelier and clouds of discs and of 3D Gaussians, dimmed or not, are rendered as the "
                  "twin renders them") {
    const glm::dvec3 background(0.1, 0.2, 0.3);
    checkAgainstTwin(*this, test::viewBuiltin("builtin:atelier", {256, 256}, 20000), makeSettings(background),
                     80.0);
    checkAgainstTwin(*this, test::viewCloud({320, 240}), makeSettings(), 80.0);  // measured: 84.0
    for (const bool antialiased : {false, true}) {
        // measured: 81.7
        checkAgainstTwin(*this, test::viewGaussians({320, 240}, antialiased), makeSettings(background), 78.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "the atelier of many splats is rendered as the twin renders it, in large" *
                           test::nightly()) {
    // Measured: 86.5.
    checkAgainstTwin(*this, test::viewBuiltin("builtin:atelier", {768, 768}, 200000),
                     makeSettings({0.1, 0.2, 0.3}), 80.0);
}

TEST_CASE_FIXTURE(
    Gpu, "colours of light are blended as light, over the light of the background, and then encoded") {
    ViewedScene view = test::viewGaussians({320, 240}, false);
    const glm::dvec3 background(0.1, 0.4, 0.8);
    reference::Picture blended = renderTwin(view, makeSettings(lightOf(background)));
    const Image as_stored = test::toImage(blended);
    for (glm::dvec4& pixel : blended.rgba) { pixel = glm::dvec4(encodedOf(glm::dvec3(pixel)), pixel.a); }
    view.scene.is_linear = true;
    const FrameSettings settings = makeSettings(background);
    const Image picture = renderMono(context(), view.scene, view.eye, settings).picture;
    const double to_sum_db = compare(picture, test::toImage(blended), 4).psnrDb(),
                 to_twin_db = compare(picture, test::toImage(renderTwin(view, settings)), 4).psnrDb();
    CHECK(to_sum_db >= 75.0);
    CHECK(to_twin_db >= 75.0);
    CHECK(compare(picture, as_stored, 4).psnrDb() < 30.0);  // the difference matters
    // Without splats the picture is the background, and both eyes are encoded, reprojected or not.
    Scene nothing;
    nothing.is_linear = true;
    const Image bare = renderMono(context(), nothing, view.eye, settings).picture;
    for (int channel = 0; channel < 3; ++channel) {
        CHECK(bare.values[static_cast<std::size_t>(channel)] ==
              doctest::Approx(background[channel]).epsilon(1e-5));
    }
    const std::array<Eye, 2> eyes = stereoPair(view.eye, 0.02);
    FrameSettings stereo = settings;
    stereo.mode = Mode::kTwoPass;
    const Image full = test::renderPair(context(), view.scene, eyes, stereo).pictures[kRight];
    for (const Mode mode : {Mode::kShared, Mode::kPredicted}) {
        stereo.mode = mode;
        const double db =
            compare(test::renderPair(context(), view.scene, eyes, stereo).pictures[kRight], full, 3).psnrDb();
        CHECK(db > (mode == Mode::kShared ? 80.0 : 25.0));
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "colours above 1 are blended as they are, light or not: whoever shows them clamps them") {
    ViewedScene view = test::viewGaussians({64, 48}, false);
    const std::size_t stride = 3 * static_cast<std::size_t>(shCoefficientCount(view.scene.sh_degree));
    for (std::size_t i = 0; i < view.scene.size(); ++i) { view.scene.sh[i * stride] += 8.0f; }
    for (const bool is_linear : {false, true}) {
        view.scene.is_linear = is_linear;
        const Image picture = renderMono(context(), view.scene, view.eye, makeSettings()).picture;
        CHECK(*std::ranges::max_element(picture.values) > 1.2f);
        CHECK(compare(picture, test::toImage(renderTwin(view, makeSettings())), 4).psnrDb() >= 65.0);
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "a flat 3D Gaussian that faces the eye is its disc with the low-pass's variance added") {
    const glm::uvec2 size_px(160, 120);
    const Eye eye = test::makeEye(size_px);
    std::vector<test::Splat> narrow, wide;
    for (int i = 0; i < 60; ++i) {
        test::Splat splat;
        const float depth = 1.0f + 0.05f * static_cast<float>(i);
        splat.position = {0.6f * std::sin(2.1f * static_cast<float>(i)) * depth,
                          0.45f * std::cos(1.3f * static_cast<float>(i)) * depth, depth};
        splat.rotation = glm::angleAxis(0.4f * static_cast<float>(i), glm::vec3(0, 0, 1));
        splat.scale = glm::vec2(0.012f + 0.001f * static_cast<float>(i % 7), 0.05f) * depth;
        splat.colour = {0.5f + 0.4f * std::sin(static_cast<float>(i)), 0.3f,
                        0.9f - 0.01f * static_cast<float>(i)};
        narrow.push_back(splat);
        const glm::vec2 sigma_px = 100.0f / depth * splat.scale;
        splat.scale = glm::sqrt(sigma_px * sigma_px + gpu::kScreenVariance) * depth / 100.0f;
        wide.push_back(splat);
    }
    const auto pictureOf = [&](const Scene& scene) {
        return renderMono(context(), scene, eye, makeSettings({0.2, 0.4, 0.6})).picture;
    };
    Scene flat = test::makeScene(narrow);
    flat.thicknesses.assign(flat.size(), 1e-6f);
    const Image picture = pictureOf(flat);
    CHECK(compare(picture, pictureOf(test::makeScene(wide)), 4).psnrDb() >= 120.0);  // measured: 151
    CHECK(compare(picture, pictureOf(test::makeScene(narrow)), 4).psnrDb() < 50.0);
}

#ifdef BINOSPLAT_SOG  // which reads SOG
TEST_CASE_FIXTURE(
    Gpu, "a real scene of 3D Gaussians is rendered as twin and another renderer render it, dimmed or not" *
             test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    Scene scene = loadScene((*data / "playbot/playbot_lod3_sog").string());
    REQUIRE(scene.isGaussian3d());
    // Measured: 91.1, 90.6 and 91.9 dB.
    for (const auto& [theirs, view, most_off] :
         {std::tuple(std::string("playbot_lod3_3dgs.pfm"), kWhole, 1e-5),
          std::tuple(std::string("playbot_lod3_3dgs_near.pfm"), kNear, 1e-4),
          std::tuple(std::string("playbot_lod3_3dgs_antialiased.pfm"), kWhole, 1e-5)}) {
        CAPTURE(theirs);
        scene.antialiased = theirs.ends_with("_antialiased.pfm");
        const Image picture = checkAgainstTwin(*this, {theirs, scene, test::eyeOf(view, {400, 400})},
                                               makeSettings(), 86.0, most_off);
        CHECK(compare(picture, readPicture(*data / "reference" / theirs), 3).psnrDb() > 60.0);
    }
}
#endif

TEST_CASE_FIXTURE(Gpu, "moments of inverse depth are the twin's, on a background that shows") {
    const ViewedScene view = test::viewBuiltin("builtin:atelier", {320, 200}, 20000);
    const FrameSettings settings = makeSettings({1.0, 0.5, 0.25}, true);
    checkAgainstTwin(*this, view, settings, 83.0);  // measured: 87.0
    const reference::Picture twin = renderTwin(view, settings);
    const Difference difference =
        compare(renderMono(context(), view.scene, view.eye, settings).moments,
                test::toImage(twin.size_px, twin.inverse_depth, twin.inverse_depth_squared), 2);
    CHECK(difference.not_finite == 0);
    CHECK(difference.psnrDb() >= 80.0);
}

TEST_CASE_FIXTURE(Gpu, "one splat is the Gaussian that its parameters say, at every pixel") {
    // A disc at z = 2 facing the eye, with scales 0.2 and 0.1 and opacity 0.8: with f in pixels, u = 2 dx /
    // (0.2 f) and v = 2 dy / (0.1 f). It is far wider than the low-pass.
    const ViewedScene view = test::viewBuiltin("builtin:one-splat", {255, 255});
    const glm::dvec3 background(0.25, 0.5, 0.75), colour(0.9, 0.6, 0.3);
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings(background));
    double worst_colour = 0.0, worst_depth = 0.0;
    for (int i = 0; i < 255 * 255; ++i) {
        const glm::dvec2 d(i % 255 - 127, i / 255 - 127);
        const glm::dvec2 uv = 2.0 * d / (glm::dvec2(0.2, 0.1) * view.eye.intrinsics.fx);
        double alpha = 0.8 * std::exp(-0.5 * glm::dot(uv, uv));
        if (std::abs(alpha * 255.0 - 1.0) < 1e-3) { continue; }  // too close to the cut to call
        if (alpha < 1.0 / 255.0) { alpha = 0.0; }
        const float* rgba = &frame.picture.values[static_cast<std::size_t>(4 * i)];
        for (int channel = 0; channel < 3; ++channel) {
            worst_colour =
                std::max(worst_colour, std::abs(static_cast<double>(rgba[channel]) - alpha * colour[channel] -
                                                (1.0 - alpha) * background[channel]));
        }
        worst_colour = std::max(worst_colour, std::abs(static_cast<double>(rgba[3]) - alpha));
        worst_depth = std::max(
            worst_depth,
            std::abs(static_cast<double>(frame.depth.values[static_cast<std::size_t>(i)]) - 2.0 * alpha));
    }
    CHECK(worst_colour <= 3e-4);  // colours are half floats
    CHECK(worst_depth <= 5e-6);
}

TEST_CASE_FIXTURE(Gpu, "two layers blend front to back, in colour, depth and its inverse moments") {
    // Opacities of 0.5 at z = 2 and 0.9 at z = 4, with the same u and v at every pixel.
    const ViewedScene view = test::viewBuiltin("builtin:two-layers", {255, 255});
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings(glm::dvec3(0.0), true));
    for (const glm::ivec2 d :
         {glm::ivec2(0, 0), glm::ivec2(20, 0), glm::ivec2(-30, 41), glm::ivec2(7, -60)}) {
        const double f = view.eye.intrinsics.fx,
                     rho = glm::dot(glm::dvec2(d), glm::dvec2(d)) * 16.0 / (f * f);
        const double near = 0.5 * std::exp(-0.5 * rho), far = (1.0 - near) * 0.9 * std::exp(-0.5 * rho);
        const auto pixel = static_cast<std::size_t>((127 + d.y) * 255 + 127 + d.x);
        const glm::dvec3 colour = near * glm::dvec3(0.8) + far * glm::dvec3(0.1, 0.2, 0.6);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            CHECK(static_cast<double>(frame.picture.values[4 * pixel + channel]) ==
                  doctest::Approx(colour[static_cast<int>(channel)]).epsilon(5e-4));
        }
        CHECK(static_cast<double>(frame.depth.values[pixel]) ==
              doctest::Approx(2.0 * near + 4.0 * far).epsilon(5e-5));
        CHECK(static_cast<double>(frame.moments.values[2 * pixel]) ==
              doctest::Approx(near / 2.0 + far / 4.0).epsilon(5e-5));
        CHECK(static_cast<double>(frame.moments.values[2 * pixel + 1]) ==
              doctest::Approx(near / 4.0 + far / 16.0).epsilon(5e-5));
    }
}

TEST_CASE_FIXTURE(Gpu, "D/A is the depth of a plane that all splats lie in, slanted too") {
    // The plane z = 4 + x meets the ray (x, y, 1) z at z = 4 / (1 - x). Each splat is hit there, not at its
    // centre's depth.
    const ViewedScene view = test::viewBuiltin("builtin:slanted-wall", {256, 256});
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings());
    double worst = 0.0;
    int opaque = 0;
    for (std::size_t i = 0; i < frame.depth.values.size(); ++i) {
        const double alpha = static_cast<double>(frame.picture.values[4 * i + 3]);
        if (alpha < 0.5) { continue; }
        const double x =
            (static_cast<double>(i % 256) + 0.5 - view.eye.intrinsics.cx) / view.eye.intrinsics.fx;
        worst = std::max(
            worst, std::abs(static_cast<double>(frame.depth.values[i]) / alpha * (1.0 - x) / 4.0 - 1.0));
        ++opaque;
    }
    CHECK(opaque > 20000);
    CHECK(worst <= 1e-5);
}

TEST_CASE_FIXTURE(Gpu, "walls stand at their depths behind bars and edges") {
    for (const auto& [name, place] : {std::pair("builtin:fence", std::pair(0.1, 3.0)),
                                      std::pair("builtin:step-edge", std::pair(0.4, 4.0))}) {
        CAPTURE(name);
        const ViewedScene view = test::viewBuiltin(name, {256, 256});
        const auto frame = renderMono(context(), view.scene, view.eye, makeSettings());
        // A column between two bars, and one to the right of the edge, by x on the plane z = 1, and the wall
        // that it meets.
        const auto column =
            static_cast<std::size_t>(view.eye.intrinsics.cx + view.eye.intrinsics.fx * place.first);
        for (std::size_t row = 32; row < 224; ++row) {
            const std::size_t pixel = row * 256 + column;
            CHECK(static_cast<double>(frame.depth.values[pixel] / frame.picture.values[4 * pixel + 3]) ==
                  doctest::Approx(place.second).epsilon(1e-5));
        }
    }
}

}  // SUITE(frame)
