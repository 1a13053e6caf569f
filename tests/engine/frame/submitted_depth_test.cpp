// Facts about the depth of whole frames that a headset gets.
#include "engine/passes/present.h"
#include "engine/twin/reference.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(submitted_depth) {

constexpr float kNear = 0.25f;

// 0 where nothing is.
std::vector<float> presentDepths(Gpu& gpu, StereoFrame& frame, int eye) {
    const Picture& picture = frame.picture(eye);
    const std::size_t count = std::size_t{picture.size_px.x} * picture.size_px.y;
    const Buffer pixels = gpu.allocate<std::uint32_t>("pixels", count),
                 depths = gpu.allocate<float>("depths", count);
    gpu::PresentPass pass{};
    pass.colours = picture.colours.address<gpu::vec4>();
    pass.half_colours = picture.colours.address<gpu::uvec2>();
    pass.depths = picture.depths.address<float>();
    pass.words = picture.words.address<gpu::uint>();
    pass.of_surface = picture.of_surface ? 1 : 0;
    pass.pixels = pixels.address<gpu::uint>();
    pass.device_depths = depths.address<float>();
    pass.size_px = picture.size_px;
    pass.depth_scale = kNear;
    const Kernel& kernel = gpu.kernel(PresentKernel{.half_colours = picture.half_floats});
    gpu.run([&](Commands& commands) {
        commands.dispatch(kernel, pass, (picture.size_px.x + 15) / 16, (picture.size_px.y + 7) / 8);
    });
    std::vector<float> found = gpu.readBack<float>(depths, count);
    for (float& depth : found) { depth = depth > 0.0f ? kNear / depth : 0.0f; }
    return found;
}

// builtin:step-edge has walls at z 2 and 4: how many pixels have neither's depth, submitted and as the mean
// of what they blend.
struct BetweenWalls {
    std::size_t submitted = 0, mean = 0;
};

BetweenWalls countBetween(Gpu& gpu, StereoFrame& frame, const Eye& eye, int side) {
    const std::vector<float> depths = presentDepths(gpu, frame, side);
    const Image colours = frame.readPicture(side), sums = frame.readDepth(side);
    BetweenWalls between;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const float alpha = colours.values[4 * i + 3];
        if (alpha < 0.5f) {
            CHECK(depths[i] == 0.0f);
            continue;
        }
        const glm::dvec2 at = glm::dvec2(i % eye.size_px.x, i / eye.size_px.x) + 0.5;
        const glm::dvec3 ray((at.x - eye.intrinsics.cx) / eye.intrinsics.fx,
                             (at.y - eye.intrinsics.cy) / eye.intrinsics.fy, 1.0);
        const double along = (eye.world_from_camera.orientation * ray).z;
        const auto isOff = [&](double depth) {
            const auto isAt = [&](double wall) {
                return std::abs(depth * along + eye.world_from_camera.position.z - wall) < 0.03 * wall;
            };
            return !isAt(2.0) && !isAt(4.0);
        };
        between.submitted += isOff(static_cast<double>(depths[i]));
        between.mean += isOff(static_cast<double>(sums.values[i] / alpha));
    }
    return between;
}

TEST_CASE_FIXTURE(Gpu, "a pixel at a wall's edge has the depth of that wall or of the one behind") {
    const ViewedScene view = viewBuiltin("builtin:step-edge", {192, 192});
    const GpuScene scene(context(), view.scene);
    for (const Mode mode : {Mode::kShared, Mode::kPredicted, Mode::kTemporal}) {
        CAPTURE(nameOf(mode));
        KeptFrame frame(context(), scene);
        FrameSettings settings = makeSettings(mode);
        settings.keep_depth = settings.keep_both_depths = true;
        settings.half_floats = true;
        std::array<Eye, 2> eyes{};
        for (int step = 0; step < 6; ++step) {
            Eye eye = turned(view.eye, 0.01 * step);
            eye.world_from_camera.position.x += 0.004 * step;
            eyes = stereoPair(eye, 0.063);
            frame.render(eyes, settings);
        }
        for (const int side : {kLeft, kRight}) {
            CAPTURE(side);
            const BetweenWalls between =
                countBetween(*this, frame, eyes[static_cast<std::size_t>(side)], side);
            CAPTURE(between.submitted);
            CHECK(between.mean > 100);
            CHECK(between.submitted * 20 <= between.mean);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "depth for display is that of the surface at which blending passes a half") {
    const ViewedScene view = viewBuiltin("builtin:atelier", {96, 96});
    const GpuScene scene(context(), view.scene);
    reference::Settings exact{.near = static_cast<double>(kNear), .surface_depths = true}, mean = exact;
    mean.surface_depths = false;
    const reference::Picture surface = reference::render(view.scene, view.eye, exact),
                             usual = reference::render(view.scene, view.eye, mean);
    FrameSettings settings = makeSettings(Mode::kMono);
    settings.near = kNear;
    settings.half_floats = settings.surface_depths = true;
    KeptFrame frame(context(), scene);
    frame.render(std::array{view.eye}, settings);
    const std::vector<float> submitted = presentDepths(*this, frame, kLeft);
    const Image sums = frame.readDepth(kLeft);
    std::size_t seen = 0, kept_off = 0, submitted_off = 0, mean_off = 0;
    for (std::size_t i = 0; i < submitted.size(); ++i) {
        const double alpha = surface.rgba[i].a, depth = surface.depth[i] / alpha;
        if (alpha < 0.51) { continue; }
        const auto isOff = [&](double other) { return std::abs(other / depth - 1.0) > 0.01; };
        ++seen;
        kept_off += isOff(static_cast<double>(sums.values[i]) / alpha);
        submitted_off += isOff(static_cast<double>(submitted[i]));
        mean_off += isOff(usual.depth[i] / alpha);
    }
    CAPTURE(seen);
    CHECK(kept_off * 200 <= seen);
    CHECK(submitted_off * 50 <= seen);
    CHECK(mean_off * 5 > seen);
}

}  // SUITE(submitted_depth)
