// Twin of reproject: each pixel of the source goes to where the target sees it; the nearest one wins.
#include "engine/twin/eye_change.h"
#include "engine/twin/splat.h"

#include <algorithm>
#include <tuple>

namespace binosplat::reference {
namespace {

// The arrivals at each pixel of the target.
struct Arrivals {
    glm::ivec2 size_px;
    std::vector<Arrival> pixels;

    void put(const glm::ivec2& at, const Arrival& arrival) {
        if (at.x < 0 || at.y < 0 || at.x >= size_px.x || at.y >= size_px.y) { return; }
        Arrival& there = pixels[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size_px.x) +
                                static_cast<std::size_t>(at.x)];
        const auto rank = [](const Arrival& a) {
            return std::tuple(roundedDepth(a.inverse_depth), a.way, a.spread);
        };
        if (there.way == Arrival::kNone || rank(arrival) > rank(there)) { there = arrival; }
    }
};

// A pixel of the source as the target sees it.
struct Moved : EyeChange::Moved {
    std::uint32_t spread;
};
glm::ivec2 pixelOf(const glm::dvec2& place_px) { return glm::ivec2(glm::floor(place_px)); }

// The pixels of a row whose centres lie between two pixels that have separated by at most gap_px, and that
// neither of the two covers.
void putBetween(Arrivals& arrivals, const Moved& here, const Moved& right, int row, int gap_px) {
    const double reach = right.place_px.x - here.place_px.x;
    if (!(reach > 1.0 && reach <= gap_px + 1.0)) { return; }
    for (int x = pixelOf(here.place_px).x + 1; x < pixelOf(right.place_px).x; ++x) {
        const double share = (x + 0.5 - here.place_px.x) / reach;
        const double inverse_depth = (1.0 - share) * here.inverse_depth + share * right.inverse_depth;
        arrivals.put({x, row}, {Arrival::kBetween, inverse_depth, std::max(here.spread, right.spread)});
    }
}

// The pixels whose centres lie in the parallelogram of three neighbours that did not separate much and kept
// their orientation.
void putWithin(Arrivals& arrivals, const Moved& here, const Moved& right, const Moved& below, int gap_px) {
    const glm::dmat2 sides(right.place_px - here.place_px, below.place_px - here.place_px);
    const glm::dvec2 low = glm::min(glm::dvec2(0.0), sides[0]) + glm::min(glm::dvec2(0.0), sides[1]);
    const glm::dvec2 high = glm::max(glm::dvec2(0.0), sides[0]) + glm::max(glm::dvec2(0.0), sides[1]);
    const double most = gap_px + 2.0;
    if (!(glm::determinant(sides) > 0.0 && high.x - low.x <= most && high.y - low.y <= most)) { return; }
    const glm::dmat2 shares_from_offset = glm::inverse(sides);
    const glm::ivec2 first = pixelOf(here.place_px + low), last = pixelOf(here.place_px + high);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const glm::ivec2 at(x, y);
            if (at == pixelOf(here.place_px) || at == pixelOf(right.place_px) ||
                at == pixelOf(below.place_px)) {
                continue;
            }
            const glm::dvec2 share = shares_from_offset * (glm::dvec2(at) + 0.5 - here.place_px);
            if (share.x < 0.0 || share.y < 0.0 || share.x > 1.0 || share.y > 1.0) { continue; }
            const double across = right.inverse_depth - here.inverse_depth,
                         down = below.inverse_depth - here.inverse_depth;
            const double inverse_depth = here.inverse_depth + share.x * across + share.y * down;
            arrivals.put(
                at, {Arrival::kBetween, inverse_depth, std::max({here.spread, right.spread, below.spread})});
        }
    }
}

// A pixel with at least this spread blends what is in front with what is behind.
constexpr std::uint32_t kMixedCode = 21;

// The greatest inverse depth of a pixel and its two neighbours in the row.
double frontBeside(const Picture& dominant, int x, int y, const StereoSettings& settings) {
    double nearest = 0.0;
    const int width = static_cast<int>(dominant.size_px.x);
    for (int beside = std::max(x - 1, 0); beside <= std::min(x + 1, width - 1); ++beside) {
        const auto pixel = movingPixel(dominant, static_cast<std::size_t>(y * width + beside), settings);
        if (pixel) { nearest = std::max(nearest, pixel->inverse_depth); }
    }
    return nearest;
}

// Margin around a sampled pixel: the cubic kernel reads two pixels to each side, and its place is wrong by up
// to one.
constexpr int kHiddenMarginPx = 3;

// True if everything around a pixel of the source was rendered.
bool isWellInside(const std::vector<std::uint8_t>& hidden, const glm::ivec2& pixel, const glm::ivec2& size) {
    if (hidden.empty()) { return true; }
    const int columns = (size.x + kTileSize - 1) / kTileSize;
    for (int y = std::max(pixel.y - kHiddenMarginPx, 0); y <= std::min(pixel.y + kHiddenMarginPx, size.y - 1);
         ++y) {
        for (int x = std::max(pixel.x - kHiddenMarginPx, 0);
             x <= std::min(pixel.x + kHiddenMarginPx, size.x - 1); ++x) {
            if (hidden[static_cast<std::size_t>(y / kTileSize * columns + x / kTileSize)] != 0) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

std::vector<Arrival> reproject(const Picture& dominant, const EyePair& eyes, const StereoSettings& settings) {
    const EyeChange change(eyes.target, eyes.source);
    const glm::ivec2 size(dominant.size_px);
    const bool keeps_rows = change.keepsRows();
    Arrivals arrivals{size, std::vector<Arrival>(dominant.rgba.size())};
    // Where a pixel goes; nowhere if its depth is invalid or it ends up behind the target.
    const auto moved = [&](int x, int y) -> std::optional<Moved> {
        if (x >= size.x || y >= size.y || !isWellInside(settings.source_hidden, {x, y}, size)) {
            return std::nullopt;
        }
        const auto pixel = movingPixel(dominant, static_cast<std::size_t>(y * size.x + x), settings);
        if (!pixel) { return std::nullopt; }
        const bool mixed = !settings.forward && pixel->spread >= kMixedCode;
        const EyeChange::Moved there = change.move(
            {x + 0.5, y + 0.5}, mixed ? frontBeside(dominant, x, y, settings) : pixel->inverse_depth);
        return there.in_front ? std::optional(Moved{there, pixel->spread}) : std::nullopt;
    };
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const auto here = moved(x, y);
            if (!here) { continue; }
            if (settings.forward) {  // only pixels move, and their sources are stored
                const auto source = static_cast<std::size_t>(y * size.x + x);
                const std::uint32_t parity = (x % 2 == 1 ? 1u : 0u) + (y % 2 == 1 ? 2u : 0u);
                arrivals.put(pixelOf(here->place_px),
                             {Arrival::kLanded, here->inverse_depth, parity, source});
                continue;
            }
            arrivals.put(pixelOf(here->place_px), {Arrival::kLanded, here->inverse_depth, here->spread});
            const auto right = moved(x + 1, y);
            if (settings.gap_px == 0 || !right) { continue; }
            if (keeps_rows) {
                putBetween(arrivals, *here, *right, y, settings.gap_px);
            } else if (const auto below = moved(x, y + 1)) {
                putWithin(arrivals, *here, *right, *below, settings.gap_px);
            }
        }
    }
    return std::move(arrivals.pixels);
}

}  // namespace binosplat::reference
