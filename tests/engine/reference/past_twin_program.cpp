// The float64 experiment of reuse over time: an eye that follows a recorded walk, made by the twins from its own last picture alone, a
// share of its work rendered again in each frame. Prints the PSNR of the run and of the worst frame after the tenth, and how much had no
// past.
//
//   past_twin SCENE EX,EY,EZ LX,LY,LZ FOV_X SIZE MOTION.csv FROM SECONDS SHARE...
#include "engine/geometry.h"
#include "engine/reference/past.h"
#include "engine/reference/reference.h"
#include "engine/scene/procedural.h"
#include "engine/scene/scene.h"
#include "engine/setup/head_motion.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace binosplat;

namespace {

glm::dvec3 vectorOf(const char* text) {
    glm::dvec3 v{0.0};
    std::sscanf(text, "%lf,%lf,%lf", &v.x, &v.y, &v.z);
    return v;
}

struct Full {
    reference::Picture picture;
    std::vector<std::uint64_t> costs;
};

Full renderFull(const Scene& scene, const Eye& eye) {
    const reference::Settings settings{.inverse_depth_moments = true};
    const auto visible = reference::cull(scene, {&eye, 1}, settings);
    const auto order = reference::sortDepth(reference::compact(scene, visible, eye, settings), settings);
    const auto splats = reference::project(scene, order, eye, settings);
    auto pairs = reference::bin(splats, eye.size_px, settings);
    reference::sortTiles(pairs, settings);
    const auto ranges = reference::tileRanges(pairs, eye.size_px);
    Full full{reference::rasterize(splats, pairs, ranges, eye, settings), {}};
    for (const reference::TileRange& range : ranges) { full.costs.push_back(range.end - range.begin); }
    return full;
}

struct Run {
    double share;
    reference::Past past;
    double squares = 0.0, worst = 0.0, unseen = 0.0;
    int frames = 0;
};

void step(Run& run, const Eye& eye, const Full& full, int frame) {
    if (frame == 0) {
        run.past = reference::pastOf(eye, full.picture, full.costs);
        return;
    }
    reference::WarpedPast warped = reference::warpPast(run.past, eye);
    double unseen = 0.0;
    for (const std::uint8_t pixel : warped.unseen) { unseen += pixel; }
    reference::Past& past = warped.picture;
    reference::growErrors(past.tiles);
    std::vector<double> errors;
    std::vector<std::uint64_t> costs;
    std::uint64_t picture_cost = 0;
    for (const reference::PastTile& tile : past.tiles) {
        errors.push_back(reference::worthOf(tile));
        costs.push_back(reference::costOf(tile));
        picture_cost += costs.back();
    }
    std::vector<reference::TileKind> kinds(errors.size(), reference::TileKind::kNone);
    const auto prices = reference::price(kinds, errors, costs);
    reference::selectTogether(std::vector<reference::PricedTiles>{{kinds, prices, costs}},
                              static_cast<std::uint64_t>(run.share * static_cast<double>(picture_cost)));
    reference::renderTiles(past, full.picture, full.costs, kinds);
    run.past = std::move(past);
    if (frame < 10) { return; }
    double squares = 0.0;
    for (std::size_t i = 0; i < full.picture.rgba.size(); ++i) {
        const glm::dvec3 off(full.picture.rgba[i] - run.past.rgba[i]);
        squares += glm::dot(off, off);
    }
    squares /= 3.0 * static_cast<double>(full.picture.rgba.size());
    run.squares += squares;
    run.worst = std::max(run.worst, squares);
    run.unseen += unseen / static_cast<double>(full.picture.rgba.size());
    ++run.frames;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 10) { return std::puts("past_twin SCENE EYE LOOK FOV_X SIZE MOTION FROM SECONDS SHARE..."), 2; }
    const std::string source = arguments[1];
    const Scene scene = isBuiltin(source) ? makeBuiltin(source, 0) : loadScene(source);
    const auto size = static_cast<unsigned>(std::stoul(arguments[5]));
    const Eye start{lookAt(vectorOf(arguments[2]), vectorOf(arguments[3]), glm::dvec3(0, -1, 0)),
                    intrinsicsFromFovX(glm::radians(std::stod(arguments[4])), {size, size}),
                    {size, size}};
    const MotionSegment segment{.from_s = std::stod(arguments[7]), .seconds = std::stod(arguments[8]), .rate_hz = 90.0};
    const HeadMotion motion = readHeadMotion(arguments[6], MotionAxes::kUnity, segment);
    std::vector<Run> runs;
    for (int i = 9; i < count; ++i) { runs.push_back({std::stod(arguments[i]), {}}); }
    int frame = 0;
    for (const double time_s : frameTimes(motion, segment, arguments[6])) {
        Eye eye = start;
        eye.world_from_camera = motion.cameraAt(time_s, start.world_from_camera);
        const Full full = renderFull(scene, eye);
        for (Run& run : runs) { step(run, eye, full, frame); }
        ++frame;
    }
    for (const Run& run : runs) {
        std::printf("%s from %s: share %.2f, run %.1f dB, worst %.1f dB, without a past %.2f %%\n", source.c_str(), arguments[7], run.share,
                    -10.0 * std::log10(run.squares / run.frames), -10.0 * std::log10(run.worst), 100.0 * run.unseen / run.frames);
        std::fflush(stdout);
    }
    return 0;
}
