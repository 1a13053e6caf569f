// For fault_test: renders with the library and loads a second scene, for which there may not be enough
// memory. Says how that ended, whether the first scene, if it is still there, gives the same pictures, and
// whether half floats equal rounded floats. With SCENE: says how much of it is seen from the start view with
// the usual near plane, and where that view is.
#include <binosplat.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

namespace {

std::array<bsp::Picture, 2> picturesOf(bsp::Renderer& renderer, const bsp::Scene& scene,
                                       const bsp::Views& views, std::uint32_t flags = 0) {
    bsp_frame_info frame = bsp::frame();
    frame.mode = BSP_MODE_TWO_PASS;
    frame.flags = flags;
    renderer.render(scene, views, frame);
    return {renderer.colour(views[0], 0), renderer.colour(views[1], 1)};
}

// The greatest difference between two pictures.
float offBy(const bsp::Picture& a, const bsp::Picture& b) {
    float most = a.values.size() == b.values.size() ? 0.0f : 1.0f;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        most = std::max(most, std::abs(a.values[i] - b.values.at(i)));
    }
    return most;
}

}  // namespace

int main(int count, char** words) {
    try {
        const bsp::Device device;
        bsp::Renderer renderer(device);
        const bsp::Scene scene(device, count == 2 ? words[1] : "builtin:one-splat");
        scene.wait();
        const bsp::Views views = scene.startViews(count == 2 ? 0.0 : 0.063, 1.2, 64, 48);
        if (count == 2) {
            const bsp::Picture seen = picturesOf(renderer, scene, views)[0];
            double alpha = 0.0;
            for (std::size_t i = 3; i < seen.values.size(); i += 4) {
                alpha += static_cast<double>(seen.values[i]);
            }
            const auto& p = views[0].position;
            std::printf("%.6f %.6f %.6f %.6f\n", alpha / (64.0 * 48.0), p[0], p[1], p[2]);
            return 0;
        }
        const float rounding = offBy(picturesOf(renderer, scene, views, BSP_FRAME_HALF_FLOATS)[0],
                                     picturesOf(renderer, scene, views)[0]);
        if (!(rounding > 0.0f && rounding <= 1.0f / 2048.0f)) { return 2; }
        const auto before = picturesOf(renderer, scene, views);
        try {
            const bsp::Scene second(device, "builtin:fence");
            second.wait();
            picturesOf(renderer, second, views);
            std::puts("loaded");
            return 0;
        } catch (const bsp::Error& error) {
            std::printf("%s\n", error.code() == BSP_ERROR_OUT_OF_MEMORY ? error.what() : "another code");
        }
        const auto after = picturesOf(renderer, scene, views);
        const bool same = offBy(before[0], after[0]) == 0.0f && offBy(before[1], after[1]) == 0.0f;
        std::puts(same ? "the same pictures" : "other pictures");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
