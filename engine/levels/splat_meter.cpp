// Frames of one eye whose lists stay for a second look.
#include "engine/levels/splat_meter.h"

#include "engine/error.h"
#include "engine/passes/eye_view.h"

#include <algorithm>

namespace binosplat {

namespace {

constexpr double kCapacityMade = 1.25;
constexpr std::uint32_t kFirstPairs = 1u << 18;

std::uint32_t capacityAbove(std::uint32_t needed) {
    return static_cast<std::uint32_t>(std::min<double>(kCapacityMade * needed, gpu::kMaxItems));
}

}  // namespace

SplatMeter::SplatMeter(const Context& context)
    : context_(context),
      kernels_(context),
      readback_(context, "frame state read-back", sizeof(FrameState), MemoryKind::kReadback),
      commands_(context) {}

void SplatMeter::show(const GpuScene& scene, bool fits) {
    scene_ = &scene;
    fits_ = fits;
    const FrameCapacity before = buffers_.capacity();
    buffers_ = makeFrameBuffers(context_, scene.splatCount());
    growFrameBuffers(context_, buffers_,
                     {std::max(scene.splatCount(), 1u), std::max(before.pairs, kFirstPairs)});
    sums_ = {};
    sums_ =
        Buffer(context_, "contributions",
               std::max<std::uint64_t>(scene.splatCount(), 1) * sumsPerSplat(fits) * sizeof(std::int64_t));
    commands_.begin();
    commands_.fillZero(sums_);
    commands_.submitAndWait();
}

void SplatMeter::render(const Eye& eye, double near, Picture& picture) {
    const std::uint64_t pixels = std::uint64_t{eye.size_px.x} * eye.size_px.y;
    const glm::uvec2 tiles = tilesOf(eye.size_px);
    const std::uint64_t range_bytes = std::uint64_t{tiles.x} * tiles.y * sizeof(gpu::uvec2);
    if (picture.size_px != eye.size_px) {
        picture = {};
        picture.size_px = eye.size_px;
        picture.colours = Buffer(context_, "colours", pixels * sizeof(gpu::vec4));
    }
    if (buffers_.tile_ranges.bytes() != range_bytes) {
        buffers_.tile_ranges = Buffer(context_, "tile ranges", range_bytes);
    }
    // A device may leave out parts of a tile of very many splats, as llvmpipe did of 103,999: these are black
    // then, not what was in memory.
    commands_.begin();
    commands_.fillZero(picture.colours);
    commands_.submitAndWait();
    do { record(eye, near, picture); } while (!hadCapacity());
}

void SplatMeter::addSums(const Picture& picture, const Picture* wanted) {
    commands_.begin();
    recordContributions(kernels_, commands_, *scene_, buffers_, targets_, picture,
                        wanted != nullptr ? *wanted : picture, sums_, fits_);
    commands_.endPass();
    commands_.submitAndWait();
}

gpu::uint SplatMeter::fullestTile() {
    gpu::uint most = 0;
    for (const gpu::uvec2& range : read<gpu::uvec2>(buffers_.tile_ranges)) {
        most = std::max(most, range.y - range.x);
    }
    return most;
}

void SplatMeter::record(const Eye& eye, double near, const Picture& picture) {
    FrameState state{};
    state.views[0] = viewOf(eye, near);
    EyesOfList eyes;
    if (scene_->usualOrder() == Order::kDistance) { eyes.middle = placeOf(eye.world_from_camera.position); }
    targets_ = {};
    targets_.size_tiles = tilesOf(eye.size_px);
    targets_.all_tiles = targets_.size_tiles.x * targets_.size_tiles.y;
    state.targets[0].colours = picture.colours.address<gpu::vec4>();
    commands_.begin();
    commands_.update(buffers_.state, &state, sizeof(state));
    recordCull(kernels_, commands_, *scene_, buffers_, eyes, Role::kNone);
    recordOrder(kernels_, commands_, *scene_, buffers_, eyes, Role::kNone);
    recordPictures(kernels_, commands_, *scene_, buffers_, targets_, Role::kNone);
    commands_.endPass();
    commands_.copy(buffers_.state, readback_, sizeof(FrameState));
    commands_.submitAndWait();
}

bool SplatMeter::hadCapacity() {
    const FrameState& state = readback_.mapped<FrameState>()[0];
    const gpu::uint needed = state.targets[0].pairs.needed;  // all splats fit
    check(needed <= gpu::kMaxItems, "the scene's splats touch too many tiles of a picture to be judged");
    if (needed <= pairsOf(buffers_, targets_).capacity) { return true; }
    growFrameBuffers(context_, buffers_,
                     {buffers_.visible.capacity(),
                      PairBuffers::capacityFor(pairFormatOf(buffers_, targets_), capacityAbove(needed), 0)});
    return false;
}

template <typename T>
std::vector<T> SplatMeter::read(const Buffer& buffer) {
    const Buffer readback(context_, "read-back", buffer.bytes(), MemoryKind::kReadback);
    commands_.begin();
    commands_.copy(buffer, readback, buffer.bytes());
    commands_.submitAndWait();
    const auto values = readback.mapped<T>();
    return {values.begin(), values.end()};
}

std::vector<std::int64_t> SplatMeter::sums() { return read<std::int64_t>(sums_); }

std::vector<float> SplatMeter::pixels(const Picture& picture) { return read<float>(picture.colours); }

}  // namespace binosplat
