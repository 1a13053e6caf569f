// sort_depth: front to back, ties by index: a radix sort of the depths' bits, stable over splats that come in
// ascending order.
#include "engine/parallel.h"
#include "engine/twin/reference.h"

#include <bit>

namespace binosplat::reference {
namespace {

constexpr int kDigitBits = 11;
constexpr std::uint64_t kDigitMask = (1u << kDigitBits) - 1;

struct Key {
    std::uint64_t bits;
    std::uint32_t splat;
};

// Unsigned integers in the order of the numbers: all bits of negative ones are flipped, and the sign bit of
// the others.
std::uint64_t orderedBits(double depth) {
    const auto bits = std::bit_cast<std::uint64_t>(depth + 0.0);  // -0 becomes +0
    const std::uint64_t sign = std::uint64_t{1} << 63;
    return (bits & sign) != 0 ? ~bits : bits | sign;
}

}  // namespace

std::vector<std::uint32_t> sortDepth(const Visible& visible, const Settings& settings) {
    std::vector<Key> keys(visible.splats.size()), sorted(keys.size());
    std::uint64_t ones = 0, zeros = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        keys[i] = {orderedBits(visible.depths[i]), visible.splats[i]};
        ones |= keys[i].bits;
        zeros |= ~keys[i].bits;
    }
    for (int shift = 0; shift < 64; shift += kDigitBits) {
        // A digit that all keys share needs no pass.
        if (((ones & zeros) >> shift & kDigitMask) == 0) { continue; }
        sortByBucket(
            std::span<const Key>(keys), std::span(sorted), kDigitMask + 1, settings.threads,
            [shift](const Key& key) { return static_cast<std::size_t>(key.bits >> shift & kDigitMask); });
        std::swap(keys, sorted);
    }
    std::vector<std::uint32_t> order(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) { order[i] = keys[i].splat; }
    return order;
}

}  // namespace binosplat::reference
