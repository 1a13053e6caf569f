// The kernels of all passes but those of display: made when they are first needed, so that no mode pays for another's.
#pragma once

#include "engine/passes/sort.h"

namespace binosplat {

class PassKernels {
public:
    // `threads_per_cell`: 8, 16, 32 or 64 invocations blend 8x8 pixels; 0: as wide as the device's
    // subgroups. Fewer if its workgroups are too small.
    explicit PassKernels(const Context& context, std::uint32_t threads_per_cell = 0);

    // All that will ever be asked for.
    [[nodiscard]] const KernelTable& table() const { return cache_.table(); }
    template <typename K>
    const Kernel& get(const K& kernel) {
        return cache_.get(kernel);
    }
    KeyValues recordSort(Commands& commands, KeyValues in, KeyValues spare, gpu::DeviceAddress<gpu::uint> histograms, const Buffer& lists,
                         std::uint64_t list_bytes, unsigned key_bits) {
        return sort_.record(cache_, commands, in, spare, histograms, lists, list_bytes, key_bits);
    }
    [[nodiscard]] std::uint32_t threadsPerCell() const { return threads_per_cell_; }
    // How pixels of a past are loaded (lib/past.glsl): by address on software devices.
    [[nodiscard]] bool byAddress() const { return by_address_; }

    [[nodiscard]] std::size_t count() const { return cache_.size(); }
    // See Context::replacedShaders. Throws Error if one cannot be made, and then keeps the old ones.
    void rebuild() { cache_.rebuild(); }
    // Takes over the kernels of others on the same device, with as many threads per cell, whose work is done, and keeps those of its own
    // that the others lack.
    void take(PassKernels& from);

private:
    std::uint32_t threads_per_cell_;
    bool by_address_;
    Sort sort_;
    KernelCache cache_;
};

}  // namespace binosplat
