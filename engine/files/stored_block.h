// Splats as files store them, in blocks, and the same splats after their training's activations.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace binosplat {

// The stored attributes of a splat. The f_rest values are channel-major: kRest0 + channel * (coefficients -
// 1) + (k - 1).
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

// Up to kRows splats as stored: a column for each attribute except f_rest, whose values lie together for each
// splat, as in most files. 256 rows of 62 values stay within a core's second-level cache, along with their
// source.
class StoredBlock {
public:
    static constexpr std::size_t kRows = 256;
    static constexpr std::size_t kRestStride = 48;  // at most 45, and zeros
    StoredBlock() : columns_(kRows * kStoredRest0), rest_(kRows * kRestStride) {}
    // For an attribute before kStoredRest0.
    [[nodiscard]] float* column(int attribute) {
        return columns_.data() + static_cast<std::size_t>(attribute) * kRows;
    }
    [[nodiscard]] const float* column(int attribute) const {
        return columns_.data() + static_cast<std::size_t>(attribute) * kRows;
    }
    // The f_rest values of a row; those that the file lacks stay 0.
    [[nodiscard]] float* rest(std::size_t row) { return rest_.data() + row * kRestStride; }
    [[nodiscard]] const float* rest(std::size_t row) const { return rest_.data() + row * kRestStride; }
    void put(int attribute, std::size_t row, float value) {
        if (attribute < kStoredRest0) {
            column(attribute)[row] = value;
        } else {
            rest(row)[attribute - kStoredRest0] = value;
        }
    }
    [[nodiscard]] float get(int attribute, std::size_t row) const {
        return attribute < kStoredRest0 ? column(attribute)[row] : rest(row)[attribute - kStoredRest0];
    }
    std::size_t rows = 0;

private:
    std::vector<float> columns_, rest_;
};

// Over an attribute's finite values; 0 if there are none.
float medianOf(const StoredBlock& block, int attribute);

// The splats of a block that are kept, one after the other.
struct ActiveBlock {
    std::size_t count = 0;
    std::array<std::uint16_t, StoredBlock::kRows> source{};  // row in the stored block
    std::array<glm::vec3, StoredBlock::kRows> positions;
    std::array<glm::quat, StoredBlock::kRows> rotations;
    std::array<glm::vec2, StoredBlock::kRows> scales;
    std::array<float, StoredBlock::kRows> opacities{};
    std::array<float, StoredBlock::kRows> thicknesses{};  // the shortest axis; three scales only
    int sh_degree = 0;                                    // the highest band that a kept splat uses
    std::size_t skipped_not_finite = 0, skipped_zero_rotation = 0;
};

// `sh_degree` and `three_scales` describe the file.
void activate(const StoredBlock& block, int sh_degree, bool three_scales, ActiveBlock& active);

}  // namespace binosplat
