// Chooses by weight, widens, and fits by the sums of `contribute`.
#include "engine/levels/thin_out.h"

#include "engine/files/sog_pack.h"
#include "engine/places/standing_views.h"
#include "engine/scene/pick_splats.h"
#include "engine/scene/sh_basis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace binosplat {

namespace {

// Splats that stay become wider by their share to this power: where few of many stay, they cover more. Those
// that cover all that went would blur. No share counts as less than kLeastShare.
constexpr double kWidening = -1.0 / 3.0, kLeastShare = 0.02;
// Where a smaller share stays, splats are merged: few chosen ones leave gaps, or blur if they are wide
// enough.
constexpr double kFew = 0.3;
// What is added to each weight, in terms of their mean: who steps nearer sees what the eyes hardly see.
constexpr double kAnyWeight = 0.1;
// A step of the fit looks from every fourth eye: all eyes in four steps, each of which goes nearly as far as
// one from all of them.
constexpr std::size_t kParts = 4;
// How far to go towards the value with which a splat alone would supply what is missing under it. Colours go
// all the way: where splats overlap, weights add up to at most 1. Opacities and sizes share what is missing
// with colours and with each other.
constexpr double kOpacityRate = 0.6, kSizeRate = 0.4;
constexpr double kMostGrowth = 0.25;   // of a logarithm in a step
constexpr double kLeastWeight = 0.01;  // in pixels: of splats that show less, little is known
constexpr double kLeastHold = 1e-3;
// Mesa's software device ends the loops of a thread after 65,535 rounds of all of them, that is after some
// 54,000 pairs if each splat meets every cell of its tile. Pictures of more are taken larger.
constexpr gpu::uint kMostPairs = 48'000, kMostSidePx = 2048;

// The sums of one splat, in pixels.
struct SplatSums {
    std::span<const std::int64_t> steps;
    double operator[](std::size_t i) const {
        return static_cast<double>(steps[i]) / static_cast<double>(gpu::kContributionSteps);
    }

    // How far a logarithm moves.
    [[nodiscard]] double growth(std::size_t pull, std::size_t hold) const {
        return (*this)[pull] / ((*this)[hold] + kLeastHold * ((*this)[gpu::kSumWeight] + 1.0));
    }
};

// Moves each splat by its sums; those that no eye sees stay.
void takeStep(Scene& scene, std::span<const std::int64_t> sums) {
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
    const double constant_band = shBasis({0.0, 0.0, 1.0})[0];
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const SplatSums of{sums.subspan(i * gpu::kContributionSums, gpu::kContributionSums)};
        const double weight = of[gpu::kSumWeight];
        if (weight <= 0.0) { continue; }
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double missing = of[gpu::kSumMissing + channel] / (weight + kLeastWeight);
            scene.sh[i * width + channel] += static_cast<float>(missing / constant_band);
        }
        const auto growthOf = [&](std::size_t pull, std::size_t hold, double share) {
            return static_cast<float>(
                std::exp(std::clamp(share * of.growth(pull, hold), -kMostGrowth, kMostGrowth)));
        };
        const float denser = growthOf(gpu::kSumOpacityPull, gpu::kSumOpacityHold, kOpacityRate);
        scene.opacities[i] = std::clamp(scene.opacities[i] * denser, kFaintest, kDensest);
        const float wider = growthOf(gpu::kSumSizePull, gpu::kSumSizeHold, kSizeRate);
        scene.scales[i] *= wider;
        if (scene.isGaussian3d()) { scene.thicknesses[i] *= wider; }
    }
}

// The share of a splat that stays, 0 to 1. A splat that no eye sees has almost none.
double shareOf(std::int64_t weight, double factor) {
    return std::min(1.0, factor * (static_cast<double>(weight) + 1.0));
}

// The factor with which all shares add up to `count`, fewer than there are.
double factorFor(std::span<const std::int64_t> weights, std::uint64_t count) {
    double low = 1e-18, high = 1.0;  // at 1 all of each stays
    for (int i = 0; i < 100; ++i) {
        const double middle = std::sqrt(low * high);
        double sum = 0.0;
        for (const std::int64_t weight : weights) { sum += shareOf(weight, middle); }
        (sum < static_cast<double>(count) ? low : high) = middle;
    }
    return high;
}

std::vector<Eye> eyesOf(const std::vector<View>& views, gpu::uint side_px) {
    std::vector<Eye> eyes;
    for (const View& view : views) {
        const glm::uvec2 size_px(side_px);
        eyes.push_back({lookAt(view.eye, view.look, view.up),
                        intrinsicsFromFovX(glm::radians(view.fov_x_deg), size_px), size_px});
    }
    return eyes;
}

Eye scaleTo(const Eye& eye, const glm::uvec2& size_px) {
    const Intrinsics& k = eye.intrinsics;
    const glm::dvec2 by = glm::dvec2(size_px) / glm::dvec2(eye.size_px);
    return {eye.world_from_camera, {by.x * k.fx, by.y * k.fy, by.x * k.cx, by.y * k.cy}, size_px};
}

std::vector<std::uint32_t> wholeOf(std::size_t splats) {
    std::vector<std::uint32_t> all(splats);
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

}  // namespace

std::vector<Eye> standingEyes(const Scene& scene, std::size_t count, std::size_t first, gpu::uint side_px) {
    return eyesOf(standingViews(scene, count, first), side_px);
}

std::vector<Eye> eyesOnto(const Scene& part, std::span<const Eye> from, std::size_t count,
                          gpu::uint side_px) {
    std::vector<View> views;
    for (const Eye& eye : from) {
        const Pose& pose = eye.world_from_camera;
        views.push_back({pose.position, transform(pose, {0.0, 0.0, 1.0}),
                         pose.orientation * glm::dvec3(0.0, -1.0, 0.0), 0.0});
    }
    glm::dvec3 low(part.positions.at(0)), high = low;
    for (const glm::vec3& position : part.positions) {
        low = glm::min(low, glm::dvec3(position));
        high = glm::max(high, glm::dvec3(position));
    }
    return eyesOf(viewsOnto(low, high, views, count), side_px);
}

ThinOut::ThinOut(const Context& context, const Scene& scene, std::vector<Eye> eyes, double near,
                 const Progress& progress, int steps, gpu::uint side_of_few_px)
    : context_(context),
      scene_(scene),
      wanted_{std::move(eyes), {}},
      near_(near),
      steps_(steps),
      side_of_few_px_(side_of_few_px),
      meter_(context) {
    weights_.resize(scene_.size());
    look(wanted_, &weights_, progress);
    const std::int64_t all = std::accumulate(weights_.begin(), weights_.end(), std::int64_t{0});
    const auto any =
        static_cast<std::int64_t>(kAnyWeight * static_cast<double>(all) / static_cast<double>(scene_.size()));
    for (std::int64_t& weight : weights_) { weight += any; }
}

// Pictures with too full tiles wait for the next round, with twice the pixels a side, where a splat's weight
// counts a quarter.
void ThinOut::look(Wanted& wanted, std::vector<std::int64_t>* weights, const Progress& progress) {
    const GpuScene whole(context_, scene_);
    wanted.pictures.resize(wanted.eyes.size());
    std::vector<std::size_t> left(wanted.eyes.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (std::int64_t area = 1; !left.empty(); area *= 4) {
        meter_.show(whole, false);
        std::vector<std::size_t> too_full;
        for (const std::size_t i : left) {
            meter_.render(wanted.eyes[i], near_, wanted.pictures[i]);
            const Eye larger = scaleTo(wanted.eyes[i], 2u * wanted.eyes[i].size_px);
            const bool may_grow =
                context_.isSoftware() && std::max(larger.size_px.x, larger.size_px.y) <= kMostSidePx;
            if (may_grow && meter_.fullestTile() > kMostPairs) {
                wanted.eyes[i] = larger;
                too_full.push_back(i);
                continue;
            }
            if (weights != nullptr) { meter_.addSums(wanted.pictures[i]); }
            if (progress) { progress(static_cast<double>(i + 1) / static_cast<double>(wanted.eyes.size())); }
        }
        left = std::move(too_full);
        if (weights == nullptr) { continue; }
        const std::vector<std::int64_t> sums = meter_.sums();
        for (std::size_t i = 0; i < weights->size(); ++i) {
            (*weights)[i] += sums[i * gpu::kErrorSums + gpu::kSumWeight] / area;
        }
    }
}

// Along a curve through the scene each splat adds its share, and one stays wherever these add up to another
// whole: among splats that are alike an even selection stays, and of those that show far more than others all
// do.
std::vector<std::uint32_t> ThinOut::choose(std::uint64_t count) const {
    const std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(scene_));
    if (count >= order.size()) { return wholeOf(order.size()); }
    const double factor = factorFor(weights_, count);
    std::vector<std::uint32_t> kept;
    double sum = 0.5;
    for (std::size_t i = 0; i < order.size() && kept.size() < count; ++i) {
        sum += shareOf(weights_[order[i]], factor);
        const bool needs_all = order.size() - i <= count - kept.size();  // rounding may leave one too few
        if (sum >= 1.0 || needs_all) { kept.push_back(order[i]), sum -= 1.0; }
    }
    std::ranges::sort(kept);
    return kept;
}

Scene ThinOut::chosen(std::uint64_t count) const {
    const std::vector<std::uint32_t> chosen = choose(count);
    Scene scene = pickSplats(scene_, chosen);
    const double factor = factorFor(weights_, count);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const double share = std::max(shareOf(weights_[chosen[i]], factor), kLeastShare);
        const auto wider = static_cast<float>(std::pow(share, kWidening));
        scene.scales[i] *= wider;
        if (scene.isGaussian3d()) { scene.thicknesses[i] *= wider; }
    }
    return scene;
}

Scene ThinOut::merged(std::uint64_t count) {
    if (!merger_ || merger_->scene().size() < count) {
        merger_ = std::make_unique<SplatMerger>(scene_, weights_);
    }
    merger_->reduceTo(count);
    return merger_->scene();
}

const ThinOut::Wanted& ThinOut::wantedOfFew() {
    if (side_of_few_px_ == 0) { return wanted_; }
    if (wanted_of_few_.eyes.empty()) {
        for (const Eye& eye : wanted_.eyes) {
            wanted_of_few_.eyes.push_back(scaleTo(eye, glm::min(eye.size_px, glm::uvec2(side_of_few_px_))));
        }
        look(wanted_of_few_, nullptr, {});
    }
    return wanted_of_few_;
}

Scene ThinOut::keep(std::uint64_t count, const Progress& progress) {
    if (count >= scene_.size()) { return scene_; }
    const auto all = static_cast<double>(scene_.size());
    const bool are_few = static_cast<double>(count) < kFew * all;
    Scene scene = are_few ? merged(count) : chosen(count);
    fit(scene, are_few ? wantedOfFew() : wanted_, progress);
    return scene;
}

void ThinOut::fit(Scene& scene, const Wanted& wanted, const Progress& progress) {
    Picture picture;
    for (int step = 0; step < steps_; ++step) {
        const GpuScene shown(context_, scene);
        meter_.show(shown, true);
        for (std::size_t i = static_cast<std::size_t>(step) % kParts; i < wanted.eyes.size(); i += kParts) {
            meter_.render(wanted.eyes[i], near_, picture);
            meter_.addSums(picture, &wanted.pictures[i]);
            if (progress) {
                progress((step + static_cast<double>(i) / static_cast<double>(wanted.eyes.size())) / steps_);
            }
        }
        takeStep(scene, meter_.sums());
    }
}

double ThinOut::errorOf(const Scene& scene) {
    const GpuScene shown(context_, scene);
    meter_.show(shown, false);
    Picture picture;
    double sum = 0.0;
    std::size_t values = 0;
    for (std::size_t i = 0; i < wanted_.eyes.size(); ++i) {
        meter_.render(wanted_.eyes[i], near_, picture);
        const std::vector<float> is = meter_.pixels(picture), should = meter_.pixels(wanted_.pictures[i]);
        for (std::size_t at = 0; at < is.size(); ++at) {
            if (at % 4 == 3) { continue; }
            const double off = static_cast<double>(is[at]) - static_cast<double>(should[at]);
            sum += off * off, ++values;
        }
    }
    return values > 0 ? sum / static_cast<double>(values) : 0.0;
}

std::vector<SplatError> ThinOut::splatErrorsOf(const Scene& scene, const Progress& progress,
                                               std::size_t every) {
    const GpuScene shown(context_, scene);
    meter_.show(shown, false);
    Picture picture;
    for (std::size_t i = 0; i < wanted_.eyes.size(); i += every) {
        meter_.render(wanted_.eyes[i], near_, picture);
        meter_.addSums(picture, &wanted_.pictures[i]);
        if (progress) { progress(static_cast<double>(i + 1) / static_cast<double>(wanted_.eyes.size())); }
    }
    std::vector<SplatError> errors(scene.size());
    const std::vector<std::int64_t> sums = meter_.sums();
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const SplatSums of{std::span(sums).subspan(i * gpu::kErrorSums, gpu::kErrorSums)};
        errors[i] = {of[gpu::kSumWeight], of[gpu::kSumMissing] / gpu::kSquareScale};
    }
    return errors;
}

}  // namespace binosplat
