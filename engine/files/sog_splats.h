// The splats of one SOG directory or bundle, in steps, so that many can be checked before the first is
// decoded.
#pragma once

#include "engine/files/scene_builder.h"
#include "engine/files/sog_files.h"
#include "engine/files/sog_meta.h"
#include "engine/picture/webp.h"

#include <memory>
#include <string>
#include <vector>

namespace binosplat {

// Throws Error in a build that cannot decode WebP.
void requireSogDecoder(const std::string& source);

// All pictures decoded: 20 to 24 bytes per splat, and the palette.
struct SogPictures {
    Pixels means_low, means_high, scales, quats, sh0, centroids, labels;
};

class SogSplats {
public:
    // Reads meta.json, and for a version 1 with SH also its palette, whose width alone tells their degree.
    explicit SogSplats(std::unique_ptr<SogFiles> files);

    [[nodiscard]] std::uint64_t count() const { return meta_.count; }
    [[nodiscard]] bool antialiased() const { return meta_.antialiased; }
    [[nodiscard]] bool discs() const { return meta_.discs; }
    [[nodiscard]] int shDegree() const { return meta_.palette ? meta_.palette->sh_degree : 0; }
    // Its pictures will be needed soon.
    void expect() const;
    // Throws Error if a picture is missing or all are too small for so many splats; memory for the splats can
    // then be reserved.
    void requirePlausibleCount() const;

    // Several pictures at a time, on that many threads.
    [[nodiscard]] SogPictures decode(int threads = 1);
    // The splats in `range`, which lies below count(). `sh_degree` is the builder's, at least shDegree().
    void append(const SogPictures& pictures, SplatRange range, int sh_degree, SceneBuilder& builder,
                const Progress& progress) const;

private:
    [[nodiscard]] std::vector<std::string> pictures() const;

    std::unique_ptr<SogFiles> files_;
    SogMeta meta_;
};

}  // namespace binosplat
