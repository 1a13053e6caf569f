// Records the radix sort.
#include "engine/passes/sort.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <utility>

namespace binosplat {

namespace {

// A GPU has many subgroups in flight to hide the latency of memory: sixteen, or eight if shared memory, of
// which each takes 2 KiB for its digits, is less than 48 KiB. A CPU runs its subgroups one after the other:
// four.
gpu::uint threadsOf(const Context& context) {
    if (context.isSoftware()) {
        return std::clamp(gpu::kSortSubgroups * context.subgroupSize(), 32u,
                          std::min(8 * context.minSubgroupSize(), 128u));
    }
    const gpu::uint most_subgroups = context.sharedMemory() >= 49152 ? 16 : 8;
    return std::min(
        {512u, most_subgroups * context.minSubgroupSize(), std::bit_floor(context.maxGroupInvocations())});
}

gpu::uint comparedLanes(const Context& context, DigitMatch match) {
    assert(match != DigitMatch::kComparisons || Sort::hasNarrowSubgroups(context));
    return match != DigitMatch::kBallots && Sort::hasNarrowSubgroups(context) ? context.subgroupSize() : 0;
}

}  // namespace

bool Sort::hasNarrowSubgroups(const Context& context) {
    return context.maxSubgroupSize() <= 8 && context.minSubgroupSize() == context.maxSubgroupSize();
}

Sort::Sort(const Context& context, DigitMatch match)
    : count_{.threads = threadsOf(context)},
      scatter_{.threads = count_.threads,
               .max_subgroups = count_.threads / context.minSubgroupSize(),
               .compared_lanes = comparedLanes(context, match)} {}

std::uint64_t Sort::histogramBytes(std::uint64_t items) {
    const std::uint64_t blocks =
        std::min<std::uint64_t>((items + gpu::kSortBlock - 1) / gpu::kSortBlock, gpu::kMaxSortBlocks);
    return (1 + gpu::kMaxSortRuns + blocks) * gpu::kMaxDigits * sizeof(gpu::uint);
}

KeyValues Sort::record(KernelCache& kernels, Commands& commands, KeyValues in, KeyValues spare,
                       gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists,
                       std::uint64_t list_bytes, const KeyBits& key_bits) const {
    const auto run_sums = histograms.at(gpu::kMaxDigits),
               counts = run_sums.at(std::uint64_t{gpu::kMaxSortRuns} * gpu::kMaxDigits);
    const auto list = lists.address<gpu::ListState>(list_bytes);
    const std::uint64_t groups = list_bytes + offsetof(gpu::ListState, per_sort_block);
    // As few bits a round as possible.
    unsigned shift = key_bits.first;
    for (unsigned round = 0, left = key_bits.count; round < key_bits.rounds; ++round) {
        const unsigned rounds = key_bits.rounds - round, bits = (left + rounds - 1) / rounds;
        const gpu::uint digits = 1u << bits;
        commands.dispatchIndirect(
            kernels.get(count_),
            gpu::SortCountPass{in.keys, counts, run_sums, histograms, list, shift, digits}, lists, groups);
        commands.dispatchIndirect(kernels.get(scatter_),
                                  gpu::SortScatterPass{in.keys, in.values, spare.keys, spare.values, counts,
                                                       run_sums, histograms, list, shift, digits},
                                  lists, groups);
        std::swap(in, spare);
        shift += bits;
        left -= bits;
    }
    return in;
}

}  // namespace binosplat
