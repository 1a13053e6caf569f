// Recording the radix sort.
#include "engine/passes/sort.h"

#include <cstddef>
#include <utility>

namespace binosplat {

Sort::Sort(const Context& context)
    : count_(context, "sort_count", sizeof(gpu::SortCountPass)),
      spine_(context, "sort_spine", sizeof(gpu::SortSpinePass)),
      scatter_(context, "sort_scatter", sizeof(gpu::SortScatterPass), {/*max_subgroups=*/gpu::kSortGroupSize / std::min(context.minSubgroupSize(), gpu::kSortGroupSize)}) {}

std::uint64_t Sort::histogramBytes(std::uint64_t items) {
    return ((items + gpu::kSortBlock - 1) / gpu::kSortBlock + 1) * gpu::kDigits * sizeof(gpu::uint);
}

KeyValues Sort::record(Commands& commands, KeyValues in, KeyValues spare, gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists,
                       std::uint64_t list_bytes, unsigned key_bits) const {
    const auto list = lists.address<gpu::ListState>(list_bytes);
    const std::uint64_t groups = list_bytes + offsetof(gpu::ListState, per_sort_block);
    const auto totals = histograms;
    const auto counts = histograms.at(gpu::kDigits);
    for (gpu::uint shift = 0; shift < key_bits; shift += 8) {
        commands.dispatchIndirect(count_, gpu::SortCountPass{in.keys, counts, list, shift}, lists, groups);
        commands.dispatch(spine_, gpu::SortSpinePass{counts, totals, list}, gpu::kDigits);
        commands.dispatchIndirect(scatter_, gpu::SortScatterPass{in.keys, in.values, spare.keys, spare.values, counts, totals, list, shift}, lists, groups);
        std::swap(in, spare);
    }
    return in;
}

}  // namespace binosplat
