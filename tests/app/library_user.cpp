// For fault_test: a program that renders with the library and loads a second scene, for which there may be no memory. Says how that ended,
// and whether the first scene's pictures are what they were where it stays. Its half floats are its floats, rounded. With SCENE: says how
// much of that is seen from where one begins, with the usual near plane, and where that is.
#include "engine/library/binosplat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>

namespace engine = binosplat::engine;

namespace {

std::array<engine::Picture, 2> picturesOf(engine::Renderer& renderer, const engine::Views& views, bool half_floats = false) {
    engine::Settings settings;
    settings.method = engine::Method::kTwoPass;
    settings.width = 64;
    settings.height = 48;
    settings.half_floats = half_floats;
    renderer.render(views, settings);
    return {renderer.read(0), renderer.read(1)};
}

// The greatest difference between two pictures.
float offBy(const engine::Picture& a, const engine::Picture& b) {
    float most = a.values.size() == b.values.size() ? 0.0f : 1.0f;
    for (std::size_t i = 0; i < a.values.size(); ++i) { most = std::max(most, std::abs(a.values[i] - b.values.at(i))); }
    return most;
}

}  // namespace

int main(int count, char** words) {
    try {
        engine::Renderer renderer;
        if (count == 2) {
            renderer.load(words[1]);
            const engine::Views views = renderer.startViews(0.0, 1.2, 64, 48);
            const engine::Picture seen = picturesOf(renderer, views)[0];
            double alpha = 0.0;
            for (std::size_t i = 3; i < seen.values.size(); i += 4) { alpha += static_cast<double>(seen.values[i]); }
            const auto& [x, y, z] = views[0].position;
            std::printf("%.6f %.6f %.6f %.6f\n", alpha / (64.0 * 48.0), x, y, z);
            return 0;
        }
        renderer.load("builtin:one-splat");
        const engine::Views views = renderer.startViews(0.063, 1.2, 64, 48);
        const float rounding = offBy(picturesOf(renderer, views, true)[0], picturesOf(renderer, views)[0]);
        if (!(rounding > 0.0f && rounding <= 1.0f / 2048.0f)) { return 2; }
        const auto before = picturesOf(renderer, views);
        const std::size_t splats = renderer.splatCount();
        try {
            renderer.load("builtin:fence");
            std::puts("loaded");
            return 0;
        } catch (const std::exception& error) { std::puts(error.what()); }
        const auto after = picturesOf(renderer, views);
        const bool same = renderer.splatCount() == splats && offBy(before[0], after[0]) == 0.0f && offBy(before[1], after[1]) == 0.0f;
        std::puts(same ? "the same pictures" : "other pictures");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
