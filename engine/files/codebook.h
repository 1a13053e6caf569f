// 256 values that stand for many numbers: SOG's representation of scales, colours and harmonics.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace binosplat {

class Codebook {
public:
    // The values nearest to `numbers` by squared distance, by Lloyd's algorithm along one axis. If there are
    // no more distinct numbers than values, they are kept as they are. `apart`, which must be less than all
    // numbers, is the first value.
    explicit Codebook(std::span<const float> numbers, std::optional<float> apart = {});

    // Ascending; the last one fills the rest.
    [[nodiscard]] const std::array<float, 256>& values() const { return values_; }
    [[nodiscard]] std::uint8_t nearest(float number) const;

private:
    std::array<float, 256> values_{};
    std::array<float, 255> borders_{};  // between each value and the next
};

}  // namespace binosplat
