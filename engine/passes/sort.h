// A stable radix sort of 32-bit keys with 32-bit values (shaders/sort/sort_*.comp): reduce then scan, 9 bits
// and two commands per round.
#pragma once

#include "engine/gpu/commands.h"
#include "shaders/shared/passes.h"

namespace binosplat {

// Keys and their values, as two arrays.
struct KeyValues {
    gpu::DeviceAddress<gpu::uint> keys, values;
};

// How lanes find equal digits. Ballots work for any subgroup width; comparing with each lane in turn is
// cheaper if there are at most eight.
enum class DigitMatch { kAuto, kBallots, kComparisons };

class Sort {
public:
    // kComparisons only where hasNarrowSubgroups.
    explicit Sort(const Context& context, DigitMatch match = DigitMatch::kAuto);
    // Its two kernels.
    [[nodiscard]] KernelTable kernels() const { return {variantOf(count_), variantOf(scatter_)}; }

    static bool hasNarrowSubgroups(const Context& context);

    // Bytes of `histograms` for lists of up to `items`: a byte per key and 34 KiB, 546 KiB at most.
    static std::uint64_t histogramBytes(std::uint64_t items);

    // True if the result of `record` lies in `spare`.
    static constexpr bool endsInSpare(unsigned key_bits) { return roundsOf(key_bits) % 2 == 1; }

    // Sorts `in` by the lowest `key_bits` bits of its keys; `spare` is as large and is overwritten. Returns
    // whichever of the two holds the result. The length is that of the list at `list_bytes` of `lists`, whose
    // number of workgroups is used.
    KeyValues record(KernelCache& kernels, Commands& commands, KeyValues in, KeyValues spare,
                     gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists, std::uint64_t list_bytes,
                     unsigned key_bits) const;

private:
    static constexpr unsigned roundsOf(unsigned key_bits) {
        return (key_bits + gpu::kMaxDigitBits - 1) / gpu::kMaxDigitBits;
    }

    SortCountKernel count_;
    SortScatterKernel scatter_;
};

}  // namespace binosplat
