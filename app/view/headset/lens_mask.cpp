// From the runtime's meshes to tiles.
#include "app/view/headset/lens_mask.h"

#include "engine/passes/frame_buffers.h"
#include "engine/ready.h"
#include "xr/convert.h"
#include "xr/hidden_tiles.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

// More than a governor steps through: those of a slider that is dragged are forgotten.
constexpr std::size_t kMostSizes = 40;

// Angles, and with them the corners of meshes, may jitter by float32 rounding; a tenth of a milliradian is
// less than a pixel of any headset.
bool areNear(float a, float b) { return std::abs(a - b) <= 1e-4f; }

bool areSameAngles(const XrFovf& a, const XrFovf& b) {
    return areNear(a.angleLeft, b.angleLeft) && areNear(a.angleRight, b.angleRight) &&
           areNear(a.angleUp, b.angleUp) && areNear(a.angleDown, b.angleDown);
}

bool areSameMeshes(const xr::HiddenMesh& a, const xr::HiddenMesh& b) {
    const auto same = [](const XrVector2f& p, const XrVector2f& q) {
        return areNear(p.x, q.x) && areNear(p.y, q.y);
    };
    return a.indices == b.indices && std::ranges::equal(a.vertices, b.vertices, same);
}

// The tiles of a picture that lie within hidden ones of another picture of the same view.
std::vector<std::uint8_t> hiddenAsIn(std::span<const std::uint8_t> known, glm::uvec2 known_px,
                                     glm::uvec2 size_px) {
    std::vector<std::uint8_t> hidden;
    if (known.empty()) { return hidden; }
    const glm::uvec2 tiles = tilesOf(size_px), known_tiles = tilesOf(known_px);
    const glm::dvec2 scale = glm::dvec2(known_px) / glm::dvec2(size_px) / double{gpu::kTileSize};
    for (glm::uvec2 tile(0); tile.y < tiles.y; ++tile.y) {
        for (tile.x = 0; tile.x < tiles.x; ++tile.x) {
            const glm::dvec2 end_px(glm::min((tile + 1u) * gpu::kTileSize, size_px));
            const glm::uvec2 from(scale * glm::dvec2(tile * gpu::kTileSize)),
                end = glm::min(glm::uvec2(glm::ceil(scale * end_px)), known_tiles);
            bool is_hidden = true;
            for (glm::uint y = from.y; y < end.y; ++y) {
                for (glm::uint x = from.x; x < end.x; ++x) { is_hidden &= known[y * known_tiles.x + x] != 0; }
            }
            hidden.push_back(is_hidden ? 1 : 0);
        }
    }
    return hidden;
}

}  // namespace

HiddenTiles findHidden(const LensShape& lens, glm::uvec2 size_px) {
    HiddenTiles hidden;
    for (std::size_t e = 0; e < 2; ++e) {
        if (lens.meshes[e].indices.empty()) { continue; }
        const Intrinsics intrinsics = intrinsicsFromAngles(xr::fromXr(lens.fovs[e]), size_px);
        hidden[e] = xr::findHiddenTiles(lens.meshes[e], intrinsics, size_px, xr::hiddenMarginPx(intrinsics));
    }
    return hidden;
}

void LensMask::land() {
    if (!isReady(coming_)) { return; }
    Found found = coming_.get();
    if (!std::exchange(is_outdated_, false)) { found_.merge(found); }
}

std::array<std::span<const std::uint8_t>, 2> LensMask::update(const std::array<xr::HiddenMesh, 2>& meshes,
                                                              int version,
                                                              const std::array<xr::EyeView, 2>& views,
                                                              glm::uvec2 size_px,
                                                              std::span<const glm::uvec2> others) {
    land();
    const std::array<XrFovf, 2> fovs{views[0].fov, views[1].fov};
    const bool has_same_meshes = std::exchange(version_, version) == version ||
                                 std::ranges::equal(lens_.meshes, meshes, areSameMeshes);
    if (!has_same_meshes || !std::ranges::equal(lens_.fovs, fovs, areSameAngles)) {
        lens_ = {meshes, fovs};
        found_.clear();
        is_outdated_ = coming_.valid();
    }
    if (!lens_.hasMesh()) { return {}; }
    const Size size(size_px.x, size_px.y);
    std::vector<glm::uvec2> wanted(others.begin(), others.end());
    wanted.insert(wanted.begin(), size_px);
    std::erase_if(wanted, [&](glm::uvec2 px) { return found_.contains({px.x, px.y}); });
    if (!wanted.empty() && !coming_.valid()) {
        if (found_.size() > kMostSizes) {
            const Size kept = found_.contains(size) ? size : found_.rbegin()->first;
            std::erase_if(found_, [&](const auto& one) { return one.first != kept; });
        }
        coming_ = std::async(std::launch::async, [find = find_, lens = lens_, wanted = std::move(wanted)] {
            Found found;
            for (const glm::uvec2 px : wanted) {
                const auto [at, is_new] = found.try_emplace({px.x, px.y});
                if (is_new) { at->second = find(lens, px); }
            }
            return found;
        });
    }
    const auto known = found_.find(size);
    if (known != found_.end()) { return {known->second[0], known->second[1]}; }
    const glm::uvec2 tiles = tilesOf(size_px);
    for (std::size_t e = 0; e < 2; ++e) {
        if (found_.empty()) {
            meanwhile_[e].assign(meshes[e].indices.empty() ? 0 : std::size_t{tiles.x} * tiles.y, 0);
            continue;
        }
        const auto& [from, hidden] = *found_.rbegin();
        meanwhile_[e] = hiddenAsIn(hidden[e], {from.first, from.second}, size_px);
    }
    return {meanwhile_[0], meanwhile_[1]};
}

}  // namespace binosplat
