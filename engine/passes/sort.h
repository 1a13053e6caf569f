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

// The bits of the keys by which a list is sorted.
struct KeyBits {
    unsigned count, first, rounds;

    KeyBits(unsigned count_of_bits, unsigned first_bit = 0)
        : count(count_of_bits), first(first_bit), rounds(roundsOf(count_of_bits)) {}
    // As few rounds as possible.
    static constexpr unsigned roundsOf(unsigned key_bits) {
        return (key_bits + gpu::kMaxDigitBits - 1) / gpu::kMaxDigitBits;
    }
    [[nodiscard]] bool endInSpare() const { return rounds % 2 == 1; }
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

    // Sorts `in`; `spare` is as large and is overwritten. Without values (both null) it sorts keys alone.
    // Returns whichever of the two holds the result: KeyBits::endInSpare. The length is that of the list at
    // `list_bytes` of `lists`, whose count of workgroups is used.
    KeyValues record(KernelCache& kernels, Commands& commands, KeyValues in, KeyValues spare,
                     gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists, std::uint64_t list_bytes,
                     const KeyBits& bits) const;

private:
    SortCountKernel count_;
    SortScatterKernel scatter_;
};

}  // namespace binosplat
