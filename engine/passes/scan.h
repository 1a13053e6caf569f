// Exclusive prefix sums on the device: reduce, spine, apply (shaders/scan_*.comp).
#pragma once

#include "engine/gpu/commands.h"
#include "shaders/shared/passes.h"

namespace binosplat {

class Scan {
public:
    explicit Scan(const Context& context);

    // Bytes of `block_sums` for lists of up to `items`.
    static std::uint64_t blockSumBytes(std::uint64_t items);

    // Replaces the values (as many as the list at `list_bytes` of `lists` has) by the sums of those before them, and states
    // `result`: a list as long as their total, empty if that is more than `capacity`.
    void overList(Commands& commands, gpu::DeviceAddress<gpu::uint> values, gpu::DeviceAddress<gpu::uint> block_sums, const Buffer& lists,
                  std::uint64_t list_bytes, gpu::DeviceAddress<gpu::ListState> result, gpu::uint capacity) const;
    // The same for `count` values, known beforehand; one workgroup does it all.
    void overCount(Commands& commands, gpu::DeviceAddress<gpu::uint> values, gpu::uint count, gpu::DeviceAddress<gpu::ListState> result,
                   gpu::uint capacity) const;

private:
    Kernel reduce_, spine_, spine_over_count_, apply_;
};

}  // namespace binosplat
