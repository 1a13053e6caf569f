// From attributes as files store them to a Scene: activations, skipped splats, the dropped axis, the SH bands worth keeping.
// A format fills blocks column by column and hands them over; all formats share what happens next.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

// One column per stored attribute. The f_rest columns are channel-major: kRest0 + channel * (coefficients - 1) + (k - 1).
enum StoredAttribute : int {
    kStoredX,
    kStoredY,
    kStoredZ,
    kStoredDc0,
    kStoredDc1,
    kStoredDc2,
    kStoredOpacity,  // logit
    kStoredScale0,
    kStoredScale1,
    kStoredScale2,  // logarithms
    kStoredRot0,
    kStoredRot1,
    kStoredRot2,
    kStoredRot3,  // w, x, y, z of any length
    kStoredRest0,
    kStoredAttributeCount = kStoredRest0 + 45,
};

// Up to kRows splats as stored. 256 rows of 59 columns stay within a core's second-level cache beside their source.
class StoredBlock {
public:
    static constexpr std::size_t kRows = 256;
    StoredBlock() : values_(kRows * kStoredAttributeCount) {}
    [[nodiscard]] float* column(int attribute) { return values_.data() + static_cast<std::size_t>(attribute) * kRows; }
    [[nodiscard]] const float* column(int attribute) const { return values_.data() + static_cast<std::size_t>(attribute) * kRows; }
    std::size_t rows = 0;

private:
    std::vector<float> values_;
};

class SceneBuilder {
public:
    // `splats` must already be known to be plausible: room for all of them is reserved here.
    SceneBuilder(std::string name, std::uint64_t splats, int sh_degree, bool three_scales);

    void append(const StoredBlock& block);

    // The scene, with what was met on the way added to `notes`.
    [[nodiscard]] Scene finish(LoadNotes& notes);

private:
    void growShTo(int sh_degree);
    void appendSh(const StoredBlock& block, const std::array<bool, StoredBlock::kRows>& kept, std::size_t first_new);

    Scene scene_;
    LoadNotes notes_;
    std::vector<float> flatness_;  // shortest / second shortest axis of each kept splat, three scales only
};

}  // namespace binosplat
