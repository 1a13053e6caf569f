// The tiles of both eyes' pictures that the headset's lenses hide.
#pragma once

#include "xr/session.h"

#include <array>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace binosplat {

using HiddenTiles = std::array<std::vector<std::uint8_t>, 2>;  // by eye; empty: its lens has no mesh

// What a headset's lenses hide of pictures of any size.
struct LensShape {
    std::array<xr::HiddenMesh, 2> meshes;
    std::array<XrFovf, 2> fovs{};

    [[nodiscard]] bool hasMesh() const { return !meshes[0].indices.empty() || !meshes[1].indices.empty(); }
};
// May take milliseconds.
[[nodiscard]] HiddenTiles findHidden(const LensShape& lens, glm::uvec2 size_px);

class LensMask {
public:
    using Find = std::function<HiddenTiles(const LensShape& lens, glm::uvec2 size_px)>;

    LensMask() : LensMask(findHidden) {}
    explicit LensMask(Find find) : find_(std::move(find)) {}

    // The hidden tiles for each eye, as FrameSettings expects them, valid until the next call; empty where
    // there is no mesh. They are found on a thread, those for `others`, which may come next, too: until then
    // only what is known from another size is hidden, and nothing after a mesh or the angles have changed.
    // Meshes with the same `version` as in the last call are the same meshes.
    std::array<std::span<const std::uint8_t>, 2> update(const std::array<xr::HiddenMesh, 2>& meshes,
                                                        int version, const std::array<xr::EyeView, 2>& views,
                                                        glm::uvec2 size_px,
                                                        std::span<const glm::uvec2> others = {});
    // True if that is known, or if there is no mesh.
    [[nodiscard]] bool knows(glm::uvec2 size_px) const {
        return !lens_.hasMesh() || found_.contains({size_px.x, size_px.y});
    }
    // Waits until all is known that was asked for.
    void finish() {
        if (coming_.valid()) { coming_.wait(); }
    }

private:
    using Size = std::pair<std::uint32_t, std::uint32_t>;
    using Found = std::map<Size, HiddenTiles>;
    void land();

    Find find_;
    int version_ = -1;
    LensShape lens_;
    Found found_;
    HiddenTiles meanwhile_;
    bool is_outdated_ = false;   // what comes is of an earlier lens
    std::future<Found> coming_;  // last: its thread ends first
};

}  // namespace binosplat
