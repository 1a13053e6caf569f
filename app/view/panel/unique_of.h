// Owns a library's object, and releases it with the library's own function.
#pragma once

#include <memory>

namespace binosplat {

template <auto kDestroy>
struct Destroyer {
    template <typename Owned>
    void operator()(Owned* owned) const {
        kDestroy(owned);
    }
};
template <typename Owned, auto kDestroy>
using UniqueOf = std::unique_ptr<Owned, Destroyer<kDestroy>>;

}  // namespace binosplat
