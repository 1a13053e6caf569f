// Recording prefix sums.
#include "engine/passes/scan.h"

#include <cstddef>

namespace binosplat {

Scan::Scan(const Context& context)
    : reduce_(context, "scan_reduce", sizeof(gpu::ScanReducePass)),
      spine_(context, "scan_spine", sizeof(gpu::ScanSpinePass), {/*over_list=*/1}),
      spine_over_count_(context, "scan_spine", sizeof(gpu::ScanSpinePass), {/*over_list=*/0}),
      apply_(context, "scan_apply", sizeof(gpu::ScanApplyPass)) {}

std::uint64_t Scan::blockSumBytes(std::uint64_t items) { return (items + gpu::kScanBlock - 1) / gpu::kScanBlock * sizeof(gpu::uint); }

void Scan::overList(Commands& commands, gpu::DeviceAddress<gpu::uint> values, gpu::DeviceAddress<gpu::uint> block_sums, const Buffer& lists,
                    std::uint64_t list_bytes, gpu::DeviceAddress<gpu::ListState> result, gpu::uint capacity) const {
    const auto list = lists.address<gpu::ListState>(list_bytes);
    const std::uint64_t groups = list_bytes + offsetof(gpu::ListState, per_scan_block);
    commands.dispatchIndirect(reduce_, gpu::ScanReducePass{values, block_sums, list}, lists, groups);
    commands.dispatch(spine_, gpu::ScanSpinePass{block_sums, list, result, 0, capacity}, 1);
    commands.dispatchIndirect(apply_, gpu::ScanApplyPass{values, block_sums, list}, lists, groups);
}

void Scan::overCount(Commands& commands, gpu::DeviceAddress<gpu::uint> values, gpu::uint count, gpu::DeviceAddress<gpu::ListState> result,
                     gpu::uint capacity) const {
    commands.dispatch(spine_over_count_, gpu::ScanSpinePass{values, {}, result, count, capacity}, 1);
}

}  // namespace binosplat
