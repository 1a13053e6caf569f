// The kernels of all passes except those for display, made when they are first needed, so that no mode pays
// for another's.
#pragma once

#include "engine/passes/sort.h"

namespace binosplat {

class PassKernels : public KernelCache {
public:
    // `threads_per_cell`: 8, 16, 32 or 64 invocations blend 8x8 pixels; 0: as wide as the device's
    // subgroups. Fewer if its workgroups are too small.
    explicit PassKernels(const Context& context, std::uint32_t threads_per_cell = 0);

    KeyValues recordSort(Commands& commands, KeyValues in, KeyValues spare,
                         gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists,
                         std::uint64_t list_bytes, const KeyBits& bits) {
        return sort_.record(*this, commands, in, spare, histograms, lists, list_bytes, bits);
    }
    [[nodiscard]] std::uint32_t threadsPerCell() const { return threads_per_cell_; }
    // The threads of a cell are a subgroup of eight lanes.
    [[nodiscard]] bool cellsAreNarrow() const { return cells_are_narrow_; }
    // How pixels of a history are loaded (lib/history.glsl): by address on software devices.
    [[nodiscard]] bool byAddress() const { return by_address_; }

private:
    PassKernels(const Context& context, const Sort& sort, std::uint32_t threads_per_cell);

    std::uint32_t threads_per_cell_;
    bool cells_are_narrow_;
    bool by_address_;
    Sort sort_;
};

}  // namespace binosplat
