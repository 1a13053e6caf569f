// Facts about whole frames: pictures, depths and moments of real, built-in and analytic scenes.
#include "engine/files/load_scene.h"
#include "engine/picture/image_io.h"
#include "engine/srgb.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/shared_data.h"

SUITE(frame) {

FrameSettings makeSettings(const glm::dvec3& background = glm::dvec3(0.0), bool moments = false) {
    FrameSettings settings = test::makeSettings(Mode::kMono);
    settings.background = background;
    settings.keep_moments = moments;
    return settings;
}

reference::Picture renderTwin(const ViewedScene& view, const FrameSettings& settings) {
    return reference::render(view.scene, view.eye,
                             {.near = settings.near,
                              .background = settings.background,
                              .inverse_depth_moments = settings.keep_moments});
}

// A frame must equal the twin's up to rounding, and its depths must agree within 1e-3 in all but 1e-5 of the
// pixels. Whatever the precision, rounding sometimes moves a value across a threshold of blending, and then a
// hit counts in full or not at all: alpha at 1/255, transmittance at 1e-4, a hit at the near plane, or the
// disc's own depth instead of its centre's; and two hits change places if the depths of their centres agree
// within rounding. Measured: 1 of the atelier's 589,824 pixels is wrong, and none in the others; with Mesa 25
// also 11 of 133,045, where two of playbot's 3D Gaussians change places. Returns the picture.
Image checkAgainstTwin(Gpu& gpu, const ViewedScene& view, const FrameSettings& settings, double least_db,
                       double most_off = 1e-5) {
    CAPTURE(view.name);
    const auto frame = renderMono(gpu.context(), view.scene, view.eye, settings);
    const reference::Picture twin = renderTwin(view, settings);
    const Difference difference = compare(frame.picture, toImage(twin), 4);
    CHECK(difference.psnrDb() >= least_db);
    CHECK(difference.shareOff() <= 0.0002);
    CHECK(compare(frame.depth, frame.depth, 1).not_finite == 0);
    double opaque = 0.0, off = 0.0, greatest = 0.0, farthest = 0.0;
    for (std::size_t i = 0; i < twin.depth.size(); ++i) {
        if (twin.rgba[i].a <= 0.5) { continue; }
        const double error = std::abs(double{frame.depth.values[i]} - twin.depth[i]);
        ++opaque;
        off += error > 1e-3 * twin.depth[i] ? 1.0 : 0.0;
        greatest = std::max(greatest, error);
    }
    CHECK(off <= 1.0 + most_off * opaque);
    for (const glm::vec3& position : view.scene.positions) {
        farthest = std::max(farthest, transform(inverse(view.eye.world_from_camera), glm::dvec3(position)).z);
    }
    CHECK(greatest <= 0.0101 * farthest);
    if (settings.keep_moments) {
        const Image moments = toImage(twin.size_px, twin.inverse_depth, twin.inverse_depth_squared);
        CHECK(compare(frame.moments, moments, 2).psnrDb() >= 80.0);
    }
    return frame.picture;
}

// Views of playbot, from the whole figure to its face.
const View kWhole{{0.0, -0.6, -1.6}, {0.0, -0.4, 0.0}, {0.0, -1.0, 0.0}, 60.0};
const View kNear{{0.3, -0.7, -0.8}, {0.0, -0.6, 0.0}, {0.0, -1.0, 0.0}, 90.0};

struct RealScene {
    const char* file;
    View view;
    double least_db;
    std::string theirs = "";  // another renderer's picture
    double most_off = 1e-5;
};

TEST_CASE_FIXTURE(Gpu, "real scenes are the twin's, Gaussians also another renderer's" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const RealScene scenes[] = {
        // Measured: 90.9, 90.1 and 99.5 dB.
        {"playbot/playbot_lod2_2dgs_sh2.ply", kWhole, 87.0},
        {"playbot/playbot_lod3_2dgs_sh2.ply", kNear, 87.0},
        {"statues/angel_2dgs_sh0.ply", {{0, -2, -5}, {0, -2, 0}, {0, -1, 0}, 60.0}, 96.0},
#ifdef BINOSPLAT_SOG  // which reads SOG; measured: 91.1, 90.6 and 91.9 dB
        {"playbot/playbot_lod3_sog", kWhole, 86.0, "playbot_lod3_3dgs.pfm"},
        {"playbot/playbot_lod3_sog", kNear, 86.0, "playbot_lod3_3dgs_near.pfm", 1e-4},
        {"playbot/playbot_lod3_sog", kWhole, 86.0, "playbot_lod3_3dgs_antialiased.pfm"},
#endif
    };
    for (const auto& [file, view, least_db, theirs, most_off] : scenes) {
        CAPTURE(theirs);
        const glm::uvec2 size_px(theirs.empty() ? 384 : 400);
        ViewedScene real{file, loadScene((*data / file).string()), eyeOf(view, size_px)};
        REQUIRE(real.scene.isGaussian3d() == !theirs.empty());
        real.scene.antialiased = theirs.ends_with("_antialiased.pfm");
        const Image picture = checkAgainstTwin(*this, real, makeSettings(), least_db, most_off);
        if (theirs.empty()) { continue; }
        CHECK(compare(picture, readPicture(*data / "reference" / theirs), 3).psnrDb() > 60.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "the atelier and clouds of discs and 3D Gaussians are rendered as by the twin") {
    const glm::dvec3 background(0.1, 0.2, 0.3);
    checkAgainstTwin(*this, viewAtelier({256, 256}), makeSettings(background), 80.0);
    // Measured: 87.0 with moments of inverse depth, 84.0 and 81.7.
    checkAgainstTwin(*this, viewAtelier({320, 200}), makeSettings({1.0, 0.5, 0.25}, true), 83.0);
    checkAgainstTwin(*this, viewCloud({320, 240}), makeSettings(), 80.0);
    for (const bool antialiased : {false, true}) {
        checkAgainstTwin(*this, viewGaussians({320, 240}, antialiased), makeSettings(background), 78.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "the large atelier of many splats is rendered as by the twin" * nightly()) {
    // Measured: 86.5.
    checkAgainstTwin(*this, viewBuiltin("builtin:atelier", {768, 768}, 200000), makeSettings({0.1, 0.2, 0.3}),
                     80.0);
}

TEST_CASE_FIXTURE(Gpu, "colours of light are blended as light, over that of the background, then encoded") {
    ViewedScene view = viewGaussians({320, 240}, false);
    const glm::dvec3 background(0.1, 0.4, 0.8);
    reference::Picture blended = renderTwin(view, makeSettings(lightOf(background)));
    const Image as_stored = toImage(blended);
    for (glm::dvec4& pixel : blended.rgba) { pixel = glm::dvec4(encodedOf(glm::dvec3(pixel)), pixel.a); }
    view.scene.is_linear = true;
    FrameSettings settings = makeSettings(background);
    KeptFrame frame(context(), view.scene);
    const Image picture = renderEye(frame, view.eye, settings);
    CHECK(compare(picture, toImage(blended), 4).psnrDb() >= 75.0);
    CHECK(compare(picture, toImage(renderTwin(view, settings)), 4).psnrDb() >= 75.0);
    CHECK(compare(picture, as_stored, 4).psnrDb() < 30.0);  // the difference matters
    // Without splats the picture is the background, and both eyes are encoded, reprojected or not.
    Scene nothing;
    nothing.is_linear = true;
    const Image bare = renderMono(context(), nothing, view.eye, settings).picture;
    const std::vector<glm::dvec4> expected(bare.pixelCount(), glm::dvec4(background, 0.0));
    CHECK(compare(bare, toImage(bare.size_px, expected), 3).largest <= 1e-5);
    const auto rightIn = [&](Mode mode) {
        settings.mode = mode;
        frame.render(stereoPair(view.eye, 0.02), settings);
        return frame.readPicture(kRight);
    };
    const Image full = rightIn(Mode::kTwoPass);
    CHECK(compare(rightIn(Mode::kShared), full, 3).psnrDb() > 80.0);
    CHECK(compare(rightIn(Mode::kPredicted), full, 3).psnrDb() > 25.0);
}

TEST_CASE_FIXTURE(Gpu, "colours above 1 are blended as they are: whoever shows them clamps them") {
    ViewedScene view = viewGaussians({64, 48}, false);
    const std::size_t stride = 3 * static_cast<std::size_t>(shCoefficientCount(view.scene.sh_degree));
    for (std::size_t i = 0; i < view.scene.size(); ++i) { view.scene.sh[i * stride] += 8.0f; }
    for (const bool is_linear : {false, true}) {
        view.scene.is_linear = is_linear;
        const Image picture = renderMono(context(), view.scene, view.eye, makeSettings()).picture;
        CHECK(*std::ranges::max_element(picture.values) > 1.2f);
        CHECK(compare(picture, toImage(renderTwin(view, makeSettings())), 4).psnrDb() >= 65.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "a flat 3D Gaussian that faces the eye is its disc with the low-pass's variance") {
    std::vector<Splat> narrow, wide;
    for (float i = 0.0f; i < 60.0f; ++i) {
        const float depth = 1.0f + 0.05f * i;
        Splat splat{
            .position = glm::vec3(0.6f * std::sin(2.1f * i), 0.45f * std::cos(1.3f * i), 1.0f) * depth,
            .rotation = glm::angleAxis(0.4f * i, glm::vec3(0, 0, 1)),
            .scale = glm::vec2(0.012f + 0.001f * std::fmod(i, 7.0f), 0.05f) * depth,
            .colour = {0.5f + 0.4f * std::sin(i), 0.3f, 0.9f - 0.01f * i}};
        narrow.push_back(splat);
        const glm::vec2 sigma_px = 100.0f / depth * splat.scale;
        splat.scale = glm::sqrt(sigma_px * sigma_px + gpu::kScreenVariance) * depth / 100.0f;
        wide.push_back(splat);
    }
    const auto pictureOf = [&](const Scene& scene) {
        return renderMono(context(), scene, makeEye({160, 120}), makeSettings({0.2, 0.4, 0.6})).picture;
    };
    Scene flat = makeScene(narrow);
    flat.thicknesses.assign(flat.size(), 1e-6f);
    const Image picture = pictureOf(flat);
    CHECK(compare(picture, pictureOf(makeScene(wide)), 4).psnrDb() >= 120.0);  // measured: 151
    CHECK(compare(picture, pictureOf(makeScene(narrow)), 4).psnrDb() < 50.0);
}

TEST_CASE_FIXTURE(Gpu, "one splat is the Gaussian that its parameters say, at every pixel") {
    // A disc at z = 2 facing the eye, with scales 0.2 and 0.1 and opacity 0.8: with f in pixels, u = 2 dx /
    // (0.2 f) and v = 2 dy / (0.1 f). It is far wider than the low-pass.
    const ViewedScene view = viewBuiltin("builtin:one-splat", {255, 255});
    const glm::dvec3 background(0.25, 0.5, 0.75), colour(0.9, 0.6, 0.3);
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings(background));
    std::vector<glm::dvec4> colours;
    std::vector<double> depths;
    for (int i = 0; i < 255 * 255; ++i) {
        const glm::dvec2 d(i % 255 - 127, i / 255 - 127);
        const glm::dvec2 uv = 2.0 * d / (glm::dvec2(0.2, 0.1) * view.eye.intrinsics.fx);
        double alpha = 0.8 * std::exp(-0.5 * glm::dot(uv, uv));
        if (std::abs(alpha * 255.0 - 1.0) < 1e-3) {  // too close to the cut to call
            alpha = double{frame.picture.values[static_cast<std::size_t>(4 * i + 3)]};
        } else if (alpha < 1.0 / 255.0) {
            alpha = 0.0;
        }
        colours.emplace_back(glm::mix(background, colour, alpha), alpha);
        depths.push_back(2.0 * alpha);
    }
    // Colours are half floats.
    CHECK(compare(frame.picture, toImage({255, 255}, colours), 4).largest <= 3e-4);
    CHECK(compare(frame.depth, toImage({255, 255}, depths), 1).largest <= 5e-6);
}

TEST_CASE_FIXTURE(Gpu, "two layers blend front to back, in colour, depth and its inverse moments") {
    // Opacities of 0.5 at z = 2 and 0.9 at z = 4, with the same u and v at every pixel.
    const ViewedScene view = viewBuiltin("builtin:two-layers", {255, 255});
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings(glm::dvec3(0.0), true));
    for (const glm::ivec2 d :
         {glm::ivec2(0, 0), glm::ivec2(20, 0), glm::ivec2(-30, 41), glm::ivec2(7, -60)}) {
        const double f = view.eye.intrinsics.fx,
                     rho = glm::dot(glm::dvec2(d), glm::dvec2(d)) * 16.0 / (f * f);
        const double near = 0.5 * std::exp(-0.5 * rho), far = (1.0 - near) * 0.9 * std::exp(-0.5 * rho);
        const auto pixel = static_cast<std::size_t>((127 + d.y) * 255 + 127 + d.x);
        const auto check = [](float value, double expected, double epsilon) {
            CHECK(double{value} == doctest::Approx(expected).epsilon(epsilon));
        };
        check(frame.picture.values[4 * pixel], 0.8 * near + 0.1 * far, 5e-4);
        check(frame.picture.values[4 * pixel + 1], 0.8 * near + 0.2 * far, 5e-4);
        check(frame.picture.values[4 * pixel + 2], 0.8 * near + 0.6 * far, 5e-4);
        check(frame.depth.values[pixel], 2.0 * near + 4.0 * far, 5e-5);
        check(frame.moments.values[2 * pixel], near / 2.0 + far / 4.0, 5e-5);
        check(frame.moments.values[2 * pixel + 1], near / 4.0 + far / 16.0, 5e-5);
    }
}

TEST_CASE_FIXTURE(Gpu, "D/A is the depth of a plane that all splats lie in, slanted too") {
    // The plane z = 4 + x meets the ray (x, y, 1) z at z = 4 / (1 - x). Each splat is hit there, not at its
    // centre's depth.
    const ViewedScene view = viewBuiltin("builtin:slanted-wall", {256, 256});
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings());
    double worst = 0.0;
    int opaque = 0;
    for (std::size_t i = 0; i < frame.depth.values.size(); ++i) {
        const double alpha = double{frame.picture.values[4 * i + 3]};
        if (alpha < 0.5) { continue; }
        const double x =
            (static_cast<double>(i % 256) + 0.5 - view.eye.intrinsics.cx) / view.eye.intrinsics.fx;
        worst = std::max(worst, std::abs(frame.depth.values[i] / alpha * (1.0 - x) / 4.0 - 1.0));
        ++opaque;
    }
    CHECK(opaque > 20000);
    CHECK(worst <= 1e-5);
}

}  // SUITE(frame)
