// How much the affiliated eye's picture differs from its own full render: over all pixels, and by their
// origin.
#pragma once

#include "app/scores/lpips.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// Pixels of one origin: "all", "reprojected", "interpolated" (gaps and holes) or "patched" (rendered tiles).
struct OriginScores {
    std::string origin;
    std::uint64_t pixels = 0;
    double mean_square = 0.0;  // of R, G and B, as encoded, 0 to 1
    std::optional<double> ssim, flip;
    std::optional<double> lpips;  // only over all pixels: the network sees the whole picture

    // Infinity if the pictures are equal.
    [[nodiscard]] double psnrDb() const;
};

struct QualityOptions {
    bool ssim = true, flip = true;
    double focal_px = 3840.0;      // the eye's distance for FLIP: as a headset shows the picture
    const Lpips* lpips = nullptr;  // null: not wanted
};

// "all" first; then every origin that occurs. The lists are those of StereoFrame and may be empty. Scores
// that are not defined for pictures of this size or angle (FLIP, LPIPS) are omitted.
std::vector<OriginScores> measureQuality(const Image& full, const Image& picture,
                                         std::span<const std::uint32_t> tile_kinds,
                                         std::span<const std::uint8_t> pixel_classes,
                                         const QualityOptions& options);

// The part of the error that is visible to an eye with this gaze.
struct SeenScores {
    double mean_square = 0.0;
    double noticed =
        0.0;  // among tiles with an error, the share in which its visible part is at least kLeastSeenError

    [[nodiscard]] double psnrDb() const;
};

// `shares`: for each tile, how much of its squared error the eye sees; see reference::findSharesThere.
SeenScores measureSeen(const Image& full, const Image& picture, std::span<const double> shares);

// Against a photograph, as evaluations of 3DGS and 2DGS do: the picture clamped to 0 to 1, zeros beyond the
// border for SSIM.
struct PhotoScores {
    double psnr_db, ssim;
    std::optional<double> lpips;
};
PhotoScores compareWithPhoto(const Image& picture, const Image& photo, const Lpips* lpips);

// PSNR against a peak of 1.
double psnrOf(double mean_square);

}  // namespace binosplat
