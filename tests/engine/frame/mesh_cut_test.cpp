// Facts about meshes that cut through splats: in every pixel, a splat shows where it is nearer.
#include "tests/engine/frame/frame_runs.h"

SUITE(mesh_cut) {

constexpr float kScale = 0.1f, kOffset = 0.25f;

// The depth of a slanted plane in each pixel, along z.
std::vector<double> planeAt(const Eye& eye, const glm::dvec3& normal, double distance) {
    std::vector<double> depths;
    for (std::uint32_t y = 0; y < eye.size_px.y; ++y) {
        for (std::uint32_t x = 0; x < eye.size_px.x; ++x) {
            const glm::dvec3 ray((x + 0.5 - eye.intrinsics.cx) / eye.intrinsics.fx,
                                 (y + 0.5 - eye.intrinsics.cy) / eye.intrinsics.fy, 1.0);
            depths.push_back(distance / glm::dot(normal, ray));
        }
    }
    return depths;
}

// A cloud in front of the eye.
Scene makeMist(std::size_t splats, bool gaussians) {
    std::mt19937 random(7);
    const auto draw = [&](double low, double high) {
        return static_cast<float>(drawBetween(random, low, high));
    };
    std::vector<Splat> made;
    std::vector<float> thicknesses;
    for (std::size_t i = 0; i < splats; ++i) {
        made.push_back({{draw(-1.5, 1.5), draw(-1.2, 1.2), draw(1.5, 4.5)},
                        glm::normalize(glm::quat(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1))),
                        {draw(0.05, 0.3), draw(0.05, 0.3)},
                        draw(0.1, 0.7),
                        {draw(0.2, 0.9), draw(0.2, 0.9), draw(0.2, 0.9)}});
        thicknesses.push_back(draw(0.01, 0.05));
    }
    Scene scene = makeScene(made);
    if (gaussians) { scene.thicknesses = thicknesses; }
    return scene;
}

TEST_CASE_FIXTURE(Gpu, "a slanted plane through a cloud hides at every pixel what its twin hides") {
    const Eye eye{{}, intrinsicsFromFovX(1.0, {100, 84}), {100, 84}};
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5, 0.3, 1.0));
    for (const bool gaussians : {false, true}) {
        const Scene mist = makeMist(400, gaussians);
        KeptFrame frame(context(), mist);
        for (const Mode mode : {Mode::kMono, Mode::kTwoPass, Mode::kShared}) {
            const std::array<Eye, 2> pair = stereoPair(eye, 0.063);
            const std::span<const Eye> eyes = mode == Mode::kMono ? std::span(&eye, 1) : std::span(pair);
            FrameSettings settings = makeSettings(mode);
            settings.background = glm::dvec3(0.1, 0.2, 0.3);
            std::array<std::vector<double>, 2> planes;
            std::array<Buffer, 2> meshes;
            for (std::size_t e = 0; e < eyes.size(); ++e) {
                planes[e] = planeAt(eyes[e], normal, 2.5 + 0.1 * static_cast<double>(e));
                std::vector<float> stored;
                for (const double z : planes[e]) {
                    stored.push_back(static_cast<float>(kScale / z + kOffset));
                }
                meshes[e] = upload("mesh depths", stored);
                settings.mesh_depths[e] = MeshDepths{meshes[e].address<float>(), kScale, kOffset};
            }
            frame.render(eyes, settings);
            for (std::size_t e = 0; e < eyes.size(); ++e) {
                INFO("mode ", nameOf(mode), ", gaussians ", gaussians, ", eye ", e);
                reference::Settings twin{.near = settings.near, .background = settings.background};
                const Image seen = frame.readPicture(static_cast<int>(e)),
                            whole = toImage(reference::render(mist, eyes[e], twin));
                twin.mesh_depths = planes[e];
                const Image cut = toImage(reference::render(mist, eyes[e], twin));
                // By rounding, a splat that crosses the plane in the middle of a pixel is on either side.
                CHECK(compare(seen, cut, 4, 2e-3).off <= 2);
                CHECK(compare(seen, whole, 4, 2e-2).off > 9000);
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a mesh behind everything hides nothing, to the last bit, and one before it all") {
    KeptFrame frame(context(), makeMist(300, false));
    const Eye eye{{}, intrinsicsFromFovX(1.0, {40, 30}), {40, 30}};
    const auto seenAt = [&](float stored) {
        const Buffer mesh = upload("mesh depths", std::vector<float>(1200, stored));
        FrameSettings settings = makeSettings(Mode::kMono);
        settings.mesh_depths[0] = MeshDepths{mesh.address<float>(), kScale, kOffset};
        return renderEye(frame, eye, settings).values;
    };
    const std::vector<float> whole = renderEye(frame, eye).values;
    CHECK(std::ranges::max(whole) > 0.1f);
    CHECK(seenAt(kOffset) == whole);                                   // infinitely far away
    CHECK(std::ranges::max(seenAt(kOffset + 4.0f * kScale)) == 0.0f);  // at 0.25
}

}  // SUITE(mesh_cut)
