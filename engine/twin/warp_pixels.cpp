// Twin of warp_pixels: searches the history for pixels of an eye's picture, one by one.
#include "engine/twin/history_view.h"

namespace binosplat::reference {
namespace {

constexpr int kSteps = 3, kFrontReach = 2;
constexpr std::uint32_t kMixedCode = 21;
constexpr double kUnseenError = 1.0, kUncoveredError = 0.001;

struct Found {
    HistoryView::Seen seen;
    glm::dvec2 place_px;
    bool agrees = false;
};

// How wide a pixel of the history is at a place: more than one pixel if the view has turned towards it.
glm::dvec2 widthOfPixel(const HistoryView& view, const glm::dvec2& wanted_px) {
    const auto changeAlong = [&](const glm::dvec2& half) {
        return view.place(wanted_px + half, 0.0).place_px - view.place(wanted_px - half, 0.0).place_px;
    };
    const glm::dvec2 across = changeAlong({0.5, 0.0}), down = changeAlong({0.0, 0.5});
    return glm::dvec2(std::abs(down.x) + std::abs(down.y), std::abs(across.x) + std::abs(across.y)) /
           std::abs(across.x * down.y - across.y * down.x);
}

Found search(const HistoryView& view, const glm::dvec2& wanted_px, double guess,
             const glm::dvec2& agrees_px) {
    Found found{{std::nullopt, guess}, wanted_px};
    for (int step = 0; step < kSteps && !found.agrees; ++step) {
        const EyeChange::Moved place = view.place(wanted_px, found.seen.inverse_depth);
        found.place_px = place.place_px;
        if (!place.in_front || !view.isInside(place.place_px)) { return found; }
        found.seen = view.look(place.place_px);
        const glm::dvec2 off_px = glm::abs(found.seen.lands_px - wanted_px);
        found.agrees = found.seen.pixel && glm::all(glm::lessThanEqual(off_px, agrees_px));
    }
    if (found.agrees) {
        const glm::dvec2 exact_px = view.place(wanted_px, found.seen.inverse_depth).place_px;
        if (!view.isHidden(glm::ivec2(glm::floor(exact_px)))) { found.place_px = exact_px; }
    }
    return found;
}

// The inverse depth of the nearest content around a place.
double frontAround(const HistoryView& view, const glm::dvec2& place_px) {
    const glm::ivec2 middle(glm::floor(glm::clamp(place_px, glm::dvec2(0.0), glm::dvec2(view.last))));
    double nearest = 0.0;
    for (int y = -kFrontReach; y <= kFrontReach; ++y) {
        for (int x = -kFrontReach; x <= kFrontReach; ++x) {
            if (const auto pixel = view.own(middle + glm::ivec2(x, y))) {
                nearest = std::max(nearest, pixel->inverse_depth);
            }
        }
    }
    return view.now_from_history.move(glm::dvec2(middle) + 0.5, nearest).inverse_depth;
}

// Catmull and Rom's weights (1974) of the samples at -1, 0, 1, 2 for a place `t` after sample 0.
std::array<double, 4> cubicWeights(double t) {
    return {0.5 * (-t + 2 * t * t - t * t * t), 0.5 * (2 - 5 * t * t + 3 * t * t * t),
            0.5 * (t + 4 * t * t - 3 * t * t * t), 0.5 * (-t * t + t * t * t)};
}

struct Sample {
    glm::dvec4 colour{0.0};
    glm::dvec3 across{0.0}, down{0.0};  // how the picture changes from pixel to pixel
    double lost;                        // squared
};

// A signal that alternates in sign from pixel to pixel with an amplitude d has third differences of 8 d, and
// all of it is lost halfway between two.
Sample sampleAround(const HistoryView& view, const glm::dvec2& place_px) {
    const glm::dvec2 at = glm::clamp(place_px, glm::dvec2(0.5), glm::dvec2(view.last) + 0.5) - 0.5;
    const glm::ivec2 base(glm::floor(at)), nearest(glm::floor(at + 0.5));
    const glm::dvec2 t = at - glm::dvec2(base);
    const auto weights_x = cubicWeights(t.x), weights_y = cubicWeights(t.y);
    constexpr std::array<double, 4> kThirdDifference{-1, 3, -3, 1};
    Sample sample;
    glm::dvec3 lost_across(0.0), lost_down(0.0);
    for (int i = 0; i < 4; ++i) {
        const auto tap = static_cast<std::size_t>(i);
        lost_across += kThirdDifference[tap] * glm::dvec3(view.colour(base.x + i - 1, nearest.y));
        lost_down += kThirdDifference[tap] * glm::dvec3(view.colour(nearest.x, base.y + i - 1));
        for (int j = 0; j < 4; ++j) {
            sample.colour += weights_x[tap] * weights_y[static_cast<std::size_t>(j)] *
                             view.colour(base.x + i - 1, base.y + j - 1);
        }
    }
    lost_across *= 4.0 * t.x * (1.0 - t.x) / 8.0;
    lost_down *= 4.0 * t.y * (1.0 - t.y) / 8.0;
    sample.colour = glm::max(sample.colour, glm::dvec4(0.0));
    sample.across =
        0.5 * glm::dvec3(view.colour(nearest.x + 1, nearest.y) - view.colour(nearest.x - 1, nearest.y));
    sample.down =
        0.5 * glm::dvec3(view.colour(nearest.x, nearest.y + 1) - view.colour(nearest.x, nearest.y - 1));
    sample.lost = glm::dot(lost_across, lost_across) + glm::dot(lost_down, lost_down);
    return sample;
}

}  // namespace

PixelFromHistory makePixel(const HistoryView& view, const glm::dvec2& wanted_px, double near, double far) {
    const glm::dvec2 disparity = glm::abs(view.history_from_now.disparity(wanted_px));
    const bool is_flat = std::max(disparity.x, disparity.y) * (near - far) <= kSameDepthPx;
    const glm::dvec2 agrees_px = kAgreesPx * glm::max(glm::dvec2(1.0), widthOfPixel(view, wanted_px));
    const Found from_near = search(view, wanted_px, near, agrees_px),
                from_far = search(view, wanted_px, far, agrees_px);
    const bool takes_near =
        from_near.agrees && (!from_far.agrees || from_near.seen.inverse_depth >= from_far.seen.inverse_depth);
    Found found = takes_near ? from_near : from_far;
    // A pixel that blends two depths moves with what is in front of it.
    if (found.agrees && !is_flat) {
        const EyeChange::Moved place = view.place(wanted_px, frontAround(view, found.place_px));
        if (place.in_front && view.isInside(place.place_px)) {
            const HistoryView::Seen there = view.look(place.place_px);
            if (there.pixel && there.pixel->spread >= kMixedCode) { found = {there, place.place_px, true}; }
        }
    }
    const std::uint32_t code = found.seen.pixel ? found.seen.pixel->spread : 0;
    const double spread = kOwnSpread * spreadOf(code) * found.seen.inverse_depth + 0.5 * (near - far);
    glm::dvec2 off_px = view.uncertainMove(wanted_px, spread);
    const bool nothing = !found.seen.pixel || !view.isInside(found.place_px);
    const double unseen = found.agrees ? 0.0 : nothing ? kUnseenError : kUncoveredError;
    // Next to hidden pixels, a pixel is copied as it is.
    const glm::dvec2 middle_px = glm::floor(found.place_px) + 0.5;
    if (view.reachesHidden(glm::ivec2(middle_px), glm::ivec2(middle_px))) {
        off_px = glm::abs(off_px) + glm::abs(found.place_px - middle_px);
        found.place_px = middle_px;
    }
    if (is_flat) {
        const glm::dvec2 at = glm::clamp(found.place_px, glm::dvec2(0.5), glm::dvec2(view.last) + 0.5) - 0.5,
                         base = glm::floor(at);
        const Loss loss = lossAt(view, glm::ivec2(base), at - base, off_px);
        return {sampleSmoothly(view, at + 0.5),
                {found.seen.inverse_depth, code},
                found.agrees,
                {loss.error + unseen, loss.squared_gradient}};
    }
    const Sample sample = sampleAround(view, found.place_px);
    const double amplitude =
        std::sqrt(sample.lost) + glm::length(off_px.x * sample.across + off_px.y * sample.down);
    return {sample.colour,
            {found.seen.inverse_depth, code},
            found.agrees,
            {squareOf(amplitude) + unseen,
             glm::dot(sample.across, sample.across) + glm::dot(sample.down, sample.down)}};
}

}  // namespace binosplat::reference
