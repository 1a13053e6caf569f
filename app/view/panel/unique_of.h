// What a library hands out, given back by its own function.
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
