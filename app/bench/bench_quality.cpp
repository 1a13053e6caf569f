// How far the affiliated eye's picture is from its own full render.
#include "app/bench/bench_quality.h"

#include "app/scores/flip.h"
#include "app/scores/metrics.h"
#include "app/scores/ssim.h"
#include "engine/passes/frame_buffers.h"
#include "engine/picture/roi_picture.h"

#include <algorithm>
#include <array>

namespace binosplat {

namespace {

// The three groups of origins, as classes for PixelScores::meanWhere.
constexpr std::array<const char*, 3> kGroups{"reprojected", "interpolated", "patched"};

std::uint8_t groupOf(PixelOrigin origin) {
    return origin == PixelOrigin::kReprojected                           ? 0
           : origin == PixelOrigin::kGap || origin == PixelOrigin::kHole ? 1
                                                                         : 2;
}

// Empty if it is not wanted, or if the network needs more pixels.
std::optional<double> lpipsOf(const Image& a, const Image& b, const Lpips* lpips) {
    const bool fits = std::min(a.size_px.x, a.size_px.y) >= kLpipsLeastSide_px;
    return lpips != nullptr && fits ? std::optional(lpips->measure(a, b)) : std::nullopt;
}

// Mean squared error of R, G and B of one pixel.
double squareOf(const Image& a, const Image& b, std::size_t pixel) {
    double sum = 0.0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double difference =
            static_cast<double>(a.values[pixel * static_cast<std::size_t>(a.channels) + channel]) -
            static_cast<double>(b.values[pixel * static_cast<std::size_t>(b.channels) + channel]);
        sum += difference * difference;
    }
    return sum / 3.0;
}

}  // namespace

double psnrOf(double mean_square) { return Difference{.mean_square = mean_square}.psnrDb(); }

double OriginScores::psnrDb() const { return psnrOf(mean_square); }

double SeenScores::psnrDb() const { return psnrOf(mean_square); }

SeenScores measureSeen(const Image& full, const Image& picture, std::span<const double> shares) {
    const glm::uvec2 tiles = tilesOf(full.size_px);
    std::vector<double> errors(shares.size(), 0.0);
    for (std::size_t pixel = 0; pixel < full.pixelCount(); ++pixel) {
        const std::size_t x = pixel % full.size_px.x / gpu::kTileSize,
                          y = pixel / full.size_px.x / gpu::kTileSize;
        errors[y * tiles.x + x] += 3.0 * squareOf(full, picture, pixel);
    }
    SeenScores seen;
    std::size_t off = 0, noticed = 0;
    for (std::size_t t = 0; t < errors.size(); ++t) {
        const double error = shares[t] * errors[t];
        seen.mean_square += error / (3.0 * static_cast<double>(full.pixelCount()));
        off += error > 0.0 ? 1 : 0;
        noticed += error >= static_cast<double>(gpu::kLeastSeenError) ? 1 : 0;
    }
    if (off > 0) { seen.noticed = static_cast<double>(noticed) / static_cast<double>(off); }
    return seen;
}

PhotoScores compareWithPhoto(const Image& picture, const Image& photo, const Lpips* lpips) {
    Image shown = picture;
    for (float& value : shown.values) { value = std::clamp(value, 0.0f, 1.0f); }
    return {compare(shown, photo).psnrDb(), ssim(shown, photo, Border::kZero).mean().value_or(1.0),
            lpipsOf(shown, photo, lpips)};
}

std::vector<OriginScores> measureQuality(const Image& full, const Image& picture,
                                         std::span<const std::uint32_t> tile_kinds,
                                         std::span<const std::uint8_t> pixel_classes,
                                         const QualityOptions& options) {
    std::optional<PixelScores> ssim_scores, flip_scores;
    if (options.ssim) { ssim_scores = ssim(full, picture); }
    // FLIP is not defined for pictures whose pixels are wider than a degree.
    const double pixels_per_degree = pixelsPerDegree(options.focal_px);
    if (options.flip && pixels_per_degree >= kFlipLeastPixelsPerDegree &&
        pixels_per_degree <= kFlipMostPixelsPerDegree) {
        flip_scores = flip(full, picture, pixels_per_degree);
    }

    std::vector<OriginScores> scores{{"all",
                                      full.pixelCount(),
                                      compare(full, picture).mean_square,
                                      {},
                                      {},
                                      lpipsOf(full, picture, options.lpips)}};
    if (ssim_scores) { scores[0].ssim = ssim_scores->mean(); }
    if (flip_scores) { scores[0].flip = flip_scores->mean(); }

    std::vector<std::uint8_t> groups = pixelOrigins(full.size_px, tile_kinds, pixel_classes);
    std::array<double, kGroups.size()> sums{};
    std::array<std::uint64_t, kGroups.size()> counts{};
    for (std::size_t pixel = 0; pixel < groups.size(); ++pixel) {
        groups[pixel] = groupOf(PixelOrigin{groups[pixel]});
        sums[groups[pixel]] += squareOf(full, picture, pixel);
        ++counts[groups[pixel]];
    }
    for (std::uint8_t group = 0; group < kGroups.size(); ++group) {
        if (counts[group] == 0) { continue; }
        OriginScores& one = scores.emplace_back(OriginScores{
            kGroups[group], counts[group], sums[group] / static_cast<double>(counts[group]), {}, {}, {}});
        if (ssim_scores) { one.ssim = ssim_scores->meanWhere(groups, group); }
        if (flip_scores) { one.flip = flip_scores->meanWhere(groups, group); }
    }
    return scores;
}

}  // namespace binosplat
