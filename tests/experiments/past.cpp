// How far an eye's own last picture carries, before any kernel is written: float64 throughout.
//
//   past_experiment SCENE MOTION.csv FROM_S FRAMES WIDTH SHARE [x,y,z of the eye and of what it looks at]
//
// One eye at 90 Hz along MOTION (Unity's axes, as the recordings of walks have): its first frame is rendered, each later one is warped from
// the one shown before, and tiles that together have SHARE of the full picture's pairs are rendered again. Prints each tenth frame's PSNR
// against the full picture, the run's (of the mean squared error after ten frames), the worst frame's, and what share of pixels had no
// past.
#include "engine/reference/past.h"
#include "engine/reference/splat.h"
#include "engine/scene/procedural.h"
#include "engine/setup/head_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace binosplat;
using namespace binosplat::reference;

namespace {

struct Full {
    Picture picture;
    std::vector<std::uint64_t> costs;
    std::uint64_t pairs = 0;
};

Full renderFull(const Scene& scene, const Eye& eye, const Settings& settings) {
    const auto visible = cull(scene, std::array{eye}, settings);
    const auto order = sortDepth(compact(scene, visible, eye, settings), settings);
    const auto splats = project(scene, order, eye, settings);
    auto pairs = bin(splats, eye.size_px, settings);
    sortTiles(pairs, settings);
    const auto ranges = tileRanges(pairs, eye.size_px);
    Full full{rasterize(splats, pairs, ranges, eye, settings), {}, pairs.size()};
    for (const TileRange& range : ranges) { full.costs.push_back(range.end - range.begin); }
    return full;
}

double meanSquare(const std::vector<glm::dvec4>& a, const std::vector<glm::dvec4>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const glm::dvec3 difference = glm::clamp(glm::dvec3(a[i]), 0.0, 1.0) - glm::clamp(glm::dvec3(b[i]), 0.0, 1.0);
        sum += glm::dot(difference, difference) / 3.0;
    }
    return sum / static_cast<double>(a.size());
}

double psnr(double mean_square) { return -10.0 * std::log10(mean_square); }

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 7) {
        fmt::print(stderr, "past_experiment SCENE MOTION.csv FROM_S FRAMES WIDTH SHARE [x,y,z x,y,z fov]\n");
        return 2;
    }
    const std::string source = argv[1];
    const double from_s = std::atof(argv[3]), share = std::atof(argv[6]);
    const int frames = std::atoi(argv[4]);
    const auto width = static_cast<std::uint32_t>(std::atoi(argv[5]));
    const Scene scene = loadScene(source);
    const auto pointOf = [](const char* text) {
        glm::dvec3 point(0.0);
        if (std::sscanf(text, "%lf,%lf,%lf", &point.x, &point.y, &point.z) != 3) { std::abort(); }
        return point;
    };
    Eye start{};
    start.size_px = {width, width};
    start.intrinsics = intrinsicsFromFovX(glm::radians(argc > 9 ? std::atof(argv[9]) : 60.0), start.size_px);
    if (argc > 8) {
        start.world_from_camera = lookAt(pointOf(argv[7]), pointOf(argv[8]), {0.0, -1.0, 0.0});
    } else if (const auto view = builtinView(source)) {
        start.world_from_camera = lookAt(view->eye, view->look, view->up);
    }
    const HeadMotion motion = readHeadMotion(argv[2], MotionAxes::kUnity, {.from_s = from_s, .seconds = {}, .rate_hz = {}});
    Settings settings{.inverse_depth_moments = true};

    Past shown;
    double sum = 0.0, worst = 0.0;
    int counted = 0;
    for (int frame = 0; frame < frames; ++frame) {
        Eye eye = start;
        eye.world_from_camera = motion.cameraAt(frame / 90.0, start.world_from_camera, 1.0);
        const Full full = renderFull(scene, eye, settings);
        double unseen = 0.0;
        if (frame == 0) {
            shown = pastOf(eye, full.picture);
        } else {
            WarpedPast warped = warpPast(shown, eye);
            unseen = static_cast<double>(warped.unseen_pixels) / static_cast<double>(full.picture.rgba.size());
            const auto budget = static_cast<std::uint64_t>(share * static_cast<double>(full.pairs));
            renderChosen(warped.picture, full.picture, chooseTiles(warped.picture, full.costs, budget));
            shown = std::move(warped.picture);
        }
        const double error = meanSquare(shown.rgba, full.picture.rgba);
        if (frame >= 10) {
            sum += error;
            worst = std::max(worst, error);
            ++counted;
        }
        if (frame % 10 == 0) {
            fmt::print("frame {:3}: {:.2f} dB, {:.2f} % of pixels without a past\n", frame, psnr(error), 100.0 * unseen);
        }
        std::fflush(stdout);
    }
    fmt::print("{} from {} s, share {}: run {:.2f} dB, worst {:.2f} dB\n", source, from_s, share, psnr(sum / counted), psnr(worst));
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "past_experiment: {}\n", error.what());
    return 1;
}
