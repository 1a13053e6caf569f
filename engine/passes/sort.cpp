// Recording the radix sort.
#include "engine/passes/sort.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace binosplat {

namespace {

gpu::uint threadsOf(const Context& context) { return std::clamp(gpu::kSortSubgroups * context.subgroupSize(), 32u, 256u); }

}  // namespace

Sort::Sort(const Context& context)
    : count_(context, "sort_count", sizeof(gpu::SortCountPass), {threadsOf(context)}),
      spine_(context, "sort_spine", sizeof(gpu::SortSpinePass)),
      scatter_(context, "sort_scatter", sizeof(gpu::SortScatterPass),
               {threadsOf(context), /*max_subgroups=*/std::max(threadsOf(context) / context.minSubgroupSize(), 1u),
                /*narrow_subgroups=*/context.maxSubgroupSize() <= 8 && context.hasDynamicBroadcast()}),
      digits_per_spine_group_(std::max(gpu::kSortSpineSize / context.subgroupSize(), 1u)) {}

std::uint64_t Sort::histogramBytes(std::uint64_t items) {
    return ((items + gpu::kSortBlock - 1) / gpu::kSortBlock + 1) * gpu::kMaxDigits * sizeof(gpu::uint);
}

KeyValues Sort::record(Commands& commands, KeyValues in, KeyValues spare, gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists,
                       std::uint64_t list_bytes, unsigned key_bits) const {
    const auto list = lists.address<gpu::ListState>(list_bytes);
    const std::uint64_t groups = list_bytes + offsetof(gpu::ListState, per_sort_block);
    const auto totals = histograms;
    const auto counts = histograms.at(gpu::kMaxDigits);
    // As few bits a round as will do.
    const unsigned rounds = roundsOf(key_bits);
    for (unsigned round = 0, shift = 0; round < rounds; ++round) {
        const unsigned bits = (key_bits - shift + rounds - round - 1) / (rounds - round);
        const gpu::uint digits = 1u << bits;
        commands.dispatchIndirect(count_, gpu::SortCountPass{in.keys, counts, list, shift, digits}, lists, groups);
        commands.dispatch(spine_, gpu::SortSpinePass{counts, totals, list, digits},
                          (digits + digits_per_spine_group_ - 1) / digits_per_spine_group_);
        commands.dispatchIndirect(scatter_,
                                  gpu::SortScatterPass{in.keys, in.values, spare.keys, spare.values, counts, totals, list, shift, digits},
                                  lists, groups);
        std::swap(in, spare);
        shift += bits;
    }
    return in;
}

}  // namespace binosplat
