// `binosplat bench --orders`: how close the picture of each order of splats is to one in which every pixel
// has its own order, and popping while the head turns. In float64 on the CPU, so that nothing but the order
// differs.
#include "app/bench/bench.h"
#include "app/bench/order_results.h"
#include "app/load.h"
#include "app/options/camera_options.h"
#include "app/scores/metrics.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/builtin/procedural.h"
#include "engine/setup/output_files.h"
#include "engine/twin/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

namespace {

// How pixels are blended: splats in one order, in which each pixel may reorder a few.
struct OrderMethod {
    const char* name;
    bool by_distance;
    std::size_t window;  // 1: none; SIZE_MAX: all
};
constexpr OrderMethod kOwnOrder{"each pixel's own", false, SIZE_MAX};
constexpr std::array kOrderMethods{OrderMethod{"depth", false, 1},
                                   OrderMethod{"distance", true, 1},
                                   OrderMethod{"depth, window 8", false, 8},
                                   OrderMethod{"distance, window 8", true, 8},
                                   OrderMethod{"depth, window 16", false, 16},
                                   OrderMethod{"distance, window 16", true, 16}};

// An eye on a head.
struct HeadEye {
    Eye eye;
    glm::dvec3 middle;  // between this eye and the other
};

// The eye after the head turned right about a point `behind` the midpoint between the eyes.
HeadEye turnHead(const Cameras& cameras, Side side, double angle_rad, double behind) {
    const Pose& world_from_middle = cameras.middle.world_from_camera;
    const glm::dvec3 neck(0.0, 0.0, -behind);
    const glm::dquat turn = glm::angleAxis(angle_rad, glm::dvec3(0.0, 1.0, 0.0));
    const Pose world_from_turned = compose(world_from_middle, {turn, neck - turn * neck});
    HeadEye head{cameras.eyes[static_cast<std::size_t>(side)], world_from_turned.position};
    head.eye.world_from_camera =
        compose(world_from_turned, compose(inverse(world_from_middle), head.eye.world_from_camera));
    return head;
}

OrderChange changeBetween(const reference::Picture& a, const reference::Picture& b) {
    OrderChange change;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const glm::dvec3 difference = glm::abs(glm::dvec3(a.rgba[i]) - glm::dvec3(b.rgba[i]));
        change.mean_square += glm::dot(difference, difference) / 3.0;
        change.share_off +=
            std::max({difference.x, difference.y, difference.z}) > kTwoDisplaySteps ? 1.0 : 0.0;
    }
    const auto pixels = static_cast<double>(std::max<std::size_t>(a.rgba.size(), 1));
    return {change.mean_square / pixels, change.share_off / pixels};
}

// One scene and view.
class OrderPoint {
public:
    OrderPoint(const Scene& scene, const RunOptions& run, const Cameras& cameras)
        : scene_(scene), run_(run), cameras_(cameras) {
        settings_.near = cameras.near;
        settings_.background = run.camera.background;
        settings_.is_light = scene_.is_linear;
    }

    std::vector<OrderResult> measure(const std::string& name) const {
        ProgressLine progress(name);
        const HeadEye start = turned(0, 0.0);
        const reference::Picture own = render(kOwnOrder, start.eye, orderOf(kOwnOrder, start.eye, start));
        std::vector<OrderResult> results;
        reference::Picture by_depth;
        for (std::size_t i = 0; i < kOrderMethods.size(); ++i) {
            const OrderMethod& method = kOrderMethods[i];
            OrderResult& result =
                results.emplace_back(OrderResult{name, method.name, start.eye.size_px, {}, {}});
            const reference::Picture picture = render(method, start.eye, orderOf(method, start.eye, start));
            if (i == 0) { by_depth = picture; }
            result.from_own = changeBetween(picture, own);
            result.from_depth = changeBetween(picture, by_depth);
            for (int k = 1; k <= kTurns; ++k) {
                countPopped(method, k, 0.0, result.popped_eyes, result.most_eyes);
                countPopped(method, k, kNeckMetres / run_.metres_per_unit, result.popped_neck,
                            result.most_neck);
                progress.show((static_cast<double>(i) + static_cast<double>(k) / kTurns) /
                              static_cast<double>(kOrderMethods.size()));
            }
        }
        return results;
    }

private:
    [[nodiscard]] HeadEye turned(int k, double behind) const {
        return turnHead(cameras_, run_.stereo.dominant, glm::radians(kTurnDegrees * k), behind);
    }

    // The splats that `eye` sees, ordered as for `head`.
    [[nodiscard]] std::vector<std::uint32_t> orderOf(const OrderMethod& method, const Eye& eye,
                                                     const HeadEye& head) const {
        stopIfInterrupted();
        reference::Settings settings = settings_;
        if (method.by_distance) { settings.order_from = head.middle; }
        const auto visible = reference::cull(scene_, {&eye, 1}, settings);
        return reference::sortDepth(reference::compact(scene_, visible, head.eye, settings), settings);
    }

    [[nodiscard]] reference::Picture render(const OrderMethod& method, const Eye& eye,
                                            std::span<const std::uint32_t> order) const {
        stopIfInterrupted();
        const auto splats = reference::project(scene_, order, eye, settings_);
        auto pairs = reference::bin(splats, eye.size_px, settings_);
        reference::sortTiles(pairs, settings_);
        const auto ranges = reference::tileRanges(pairs, eye.size_px);
        return method.window == 1 ? reference::rasterize(splats, pairs, ranges, eye, settings_)
                                  : reference::rasterizeByPixel(scene_, order, splats, pairs, ranges, eye,
                                                                settings_, method.window);
    }

    void countPopped(const OrderMethod& method, int k, double behind, double& mean, double& most) const {
        const HeadEye before = turned(k - 1, behind), now = turned(k, behind);
        const auto order = orderOf(method, now.eye, now), old_order = orderOf(method, now.eye, before);
        if (order == old_order) { return; }
        const double share =
            changeBetween(render(method, now.eye, order), render(method, now.eye, old_order)).share_off;
        mean += share / kTurns;
        most = std::max(most, share);
    }

    const Scene& scene_;
    const RunOptions& run_;
    const Cameras& cameras_;
    reference::Settings settings_;
};

}  // namespace

void benchOrders(const BenchOptions& options, const BenchPlan& plan) {
    requireScenes(plan);
    OutputFiles files(options.out);
    const BenchSeries& series = plan.series.front();
    std::vector<OrderResult> results;
    for (const std::string& source : plan.scenes) {
        for (const DrawnViews& drawn : viewsOf(plan, source, options.run)) {
            const Scene scene = loadAs(drawn.run, source, isBuiltin(source) ? series.splats.front() : 0);
            for (const BenchView& view : drawn.views) {
                RunOptions run = view.run;
                if (series.sizes_px.front().x > 0) { run.camera.size_px = series.sizes_px.front(); }
                const Cameras cameras = makeCameras(run, readCameraFiles(run.camera), scene);
                const std::string name = nameIn(plan, source) + (view.name.empty() ? "" : ", " + view.name);
                std::ranges::move(OrderPoint(scene, run, cameras).measure(name), std::back_inserter(results));
            }
        }
    }
    writeText(files.staging() / "orders.csv", ordersCsv(results));
    stopIfInterrupted();
    files.publish();
    fmt::print("{}", ordersTable(results));
}

}  // namespace binosplat
