// The stereo frame as a list of passes.
#include "engine/frame.h"

#include "engine/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace binosplat {
namespace {

glm::uvec2 tilesOf(glm::uvec2 size_px) { return (size_px + (gpu::kTileSize - 1)) / gpu::kTileSize; }

gpu::EyeView viewOf(const Eye& eye, const glm::dvec3& scene_origin, double near) {
    const glm::dmat3 camera_from_world = glm::mat3_cast(glm::conjugate(eye.world_from_camera.orientation));
    const auto row = [&](int i) { return glm::vec3(camera_from_world[0][i], camera_from_world[1][i], camera_from_world[2][i]); };
    const Intrinsics& k = eye.intrinsics;
    return {row(0),
            row(1),
            row(2),
            glm::vec3(eye.world_from_camera.position - scene_origin),
            glm::vec2(k.fx, k.fy),
            glm::vec2(k.cx, k.cy),
            eye.size_px,
            tilesOf(eye.size_px),
            static_cast<float>(near),
            static_cast<float>(1.0 / near)};
}

// Whether every point is as deep for one eye as for the other: then one depth order serves both. Canted eyes differ.
bool haveSameDepths(const Eye& a, const Eye& b) {
    const glm::dvec3 forward_a = a.world_from_camera.orientation * glm::dvec3(0, 0, 1);
    const glm::dvec3 forward_b = b.world_from_camera.orientation * glm::dvec3(0, 0, 1);
    const glm::dvec3 shift = b.world_from_camera.position - a.world_from_camera.position;
    return glm::length(forward_a - forward_b) < 1e-9 && std::abs(glm::dot(shift, forward_a)) <= 1e-9 * std::max(1.0, glm::length(shift));
}

}  // namespace

StereoFrame::StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options)
    : context_(context),
      scene_(scene),
      passes_(context, scene.shDegree(), options.threads_per_cell),
      commands_(context),
      buffers_(makeFrameBuffers(context, scene.splatCount())),
      state_readback_(context, "frame state read-back", sizeof(FrameState), MemoryKind::kReadback) {
    growFrameBuffers(context, buffers_, {std::min(options.first_capacity.visible, std::max(scene.splatCount(), 1u)), options.first_capacity.pairs});
}

FrameResult StereoFrame::render(std::span<const Eye> eyes, const FrameSettings& settings) {
    assert(eyes.size() == (settings.mode == Mode::kMono ? 1u : 2u));
    dominant_ = settings.mode == Mode::kMono ? 0 : settings.dominant;
    prepareImages(eyes, settings);
    do {
        recordFrame(eyes, settings);
        commands_.submitAndWait();
        state_ = state_readback_.mapped<FrameState>()[0];
    } while (!growIfNeeded());
    return collect(eyes, settings);
}

void StereoFrame::recordFrame(std::span<const Eye> eyes, const FrameSettings& settings) {
    FrameState state{};
    std::array<glm::uvec2, 2> tiles{};
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        state.eyes[e] = viewOf(eyes[e], scene_.origin(), settings.near);
        tiles[e] = tilesOf(eyes[e].size_px);
    }
    const int first = dominant_, second = 1 - dominant_;
    const Kept kept{/*depth=*/true, settings.inverse_depth_moments};
    const glm::vec3 background(settings.background);
    const auto recordEye = [&](int eye, int list, const Kept& kept_here, const std::string& role) {
        passes_.recordEye(commands_, scene_, buffers_, eye, list, tiles[eye], images_[eye], background, kept_here, role);
    };

    commands_.begin();
    commands_.update(buffers_.state, &state, sizeof(state));
    switch (settings.mode) {
        case Mode::kMono:
            passes_.recordVisible(commands_, scene_, buffers_, 0, 1, 0, 0, "");
            recordEye(0, 0, kept, "");
            break;
        case Mode::kTwoPass:
            passes_.recordVisible(commands_, scene_, buffers_, first, 1, first, first, "dominant ");
            recordEye(first, first, kept, "dominant ");
            passes_.recordVisible(commands_, scene_, buffers_, second, 1, second, second, "affiliated ");
            recordEye(second, second, {}, "affiliated ");
            break;
        case Mode::kShared:
            passes_.recordVisible(commands_, scene_, buffers_, 0, 2, first, 0, "both ");
            recordEye(first, 0, kept, "dominant ");
            if (!haveSameDepths(eyes[0], eyes[1])) {
                commands_.beginPass("affiliated 2_compact");
                passes_.recordOrder(commands_, scene_, buffers_, second, 0, "affiliated ");
            }
            recordEye(second, 0, {}, "affiliated ");
            break;
    }
    commands_.endPass();
    commands_.copy(buffers_.state, state_readback_, sizeof(FrameState));
}

void StereoFrame::prepareImages(std::span<const Eye> eyes, const FrameSettings& settings) {
    std::uint64_t most_tiles = 0;
    for (int e = 0; e < 2; ++e) {
        const bool used = static_cast<std::size_t>(e) < eyes.size();
        sizes_px_[e] = used ? eyes[e].size_px : glm::uvec2(0);
        const std::uint64_t pixels = std::uint64_t{sizes_px_[e].x} * sizes_px_[e].y;
        const glm::uvec2 tiles = tilesOf(sizes_px_[e]);
        most_tiles = std::max(most_tiles, std::uint64_t{tiles.x} * tiles.y);
        const auto resize = [&](Buffer& buffer, const char* name, std::uint64_t bytes) {
            if (buffer.bytes() == bytes) { return; }
            buffer = {};
            buffer = Buffer(context_, name, bytes);
        };
        const bool dominant = used && e == dominant_;
        resize(images_[e].colours, "colours", pixels * sizeof(gpu::vec4));
        resize(images_[e].depths, "depths", dominant ? pixels * sizeof(float) : 0);
        resize(images_[e].inverse_depth_moments, "inverse depth moments", dominant && settings.inverse_depth_moments ? pixels * sizeof(gpu::vec2) : 0);
    }
    const std::uint64_t range_bytes = (most_tiles + 1) * sizeof(gpu::uvec2);  // one more for pairs in no tile
    if (buffers_.tile_ranges.bytes() != range_bytes) {
        buffers_.tile_ranges = {};
        buffers_.tile_ranges = Buffer(context_, "tile ranges", range_bytes);
    }
}

bool StereoFrame::growIfNeeded() {
    std::uint32_t visible = 0, pairs = 0;
    for (int e = 0; e < 2; ++e) {
        visible = std::max(visible, state_.visible[e].needed);
        pairs = std::max(pairs, state_.pairs[e].needed);
    }
    check(pairs != UINT32_MAX, "the eyes see more than 4,294,967,295 pairs of tile and splat: fewer splats or pixels are needed");
    if (visible <= buffers_.visible.capacity() && pairs <= buffers_.pairs.capacity()) { return true; }
    // Just enough the first time, since a single picture needs no more; with room to spare once the view moves.
    const double slack = regrowths_ < 2 ? 1.0 : 1.25;
    ++regrowths_;
    const auto enough = [&](std::uint32_t needed, std::uint32_t capacity) {
        if (needed <= capacity) { return capacity; }
        const double roomy = std::min(std::ceil(needed * slack / 1024.0) * 1024.0, 4294966272.0);
        return std::max(needed, static_cast<std::uint32_t>(roomy));
    };
    const std::uint32_t visible_room = std::min(enough(visible, buffers_.visible.capacity()), std::max(scene_.splatCount(), 1u));
    growFrameBuffers(context_, buffers_, {visible_room, enough(pairs, buffers_.pairs.capacity())});
    return false;
}

FrameResult StereoFrame::collect(std::span<const Eye> eyes, const FrameSettings& settings) const {
    FrameResult result;
    result.gpu_ms = commands_.times();
    result.gpu_total_ms = commands_.totalMs();
    result.peak_gpu_bytes = context_.memoryUse().peak_bytes;
    auto& counters = result.counters;
    counters["splats_read"] = scene_.splatCount();
    counters["scene_bytes"] = scene_.bytes();
    counters["visible_bytes"] = buffers_.visible.bytes();
    counters["pair_bytes"] = buffers_.pairs.bytes();
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::string suffix = settings.mode == Mode::kMono ? "" : e == kLeft ? "_left" : "_right";
        counters["splats_visible" + suffix] = state_.visible[settings.mode == Mode::kTwoPass ? e : 0].count;
        counters["tile_pairs" + suffix] = state_.pairs[e].count;
        counters["square_box_tile_pairs" + suffix] =
            (std::uint64_t{state_.counters[e].square_box_pairs_high} << 32) | state_.counters[e].square_box_pairs_low;
        const glm::uvec2 tiles = tilesOf(eyes[e].size_px);
        counters["tiles" + suffix] = std::uint64_t{tiles.x} * tiles.y;
        counters["pixels" + suffix] = std::uint64_t{eyes[e].size_px.x} * eyes[e].size_px.y;
        counters["pixel_bytes" + suffix] = images_[e].colours.bytes() + images_[e].depths.bytes() + images_[e].inverse_depth_moments.bytes();
    }
    if (scene_.shDegree() < kMaxShDegree) {
        result.left_out.push_back(fmt::format("SH bands above {}: the scene has none", scene_.shDegree()));
    }
    if (!settings.inverse_depth_moments) { result.left_out.emplace_back("moments of inverse depth: no stage of this mode reads them"); }
    if (eyes.size() == 2) { result.left_out.emplace_back("depth of the affiliated eye: nothing reads it"); }
    if (settings.mode == Mode::kShared && haveSameDepths(eyes[0], eyes[1])) {
        result.left_out.emplace_back("culling and depth sort of the affiliated eye: the eyes are parallel, so the dominant eye's order is exact");
    }
    return result;
}

Image StereoFrame::readBuffer(const Buffer& buffer, glm::uvec2 size_px, int channels) {
    Image image{size_px, channels, {}};
    if (buffer.bytes() == 0) { return image; }
    const Buffer readback(context_, "read-back", buffer.bytes(), MemoryKind::kReadback);
    commands_.begin();
    commands_.copy(buffer, readback, buffer.bytes());
    commands_.submitAndWait();
    const auto values = readback.mapped<float>();
    image.values.assign(values.begin(), values.end());
    return image;
}

Image StereoFrame::readPicture(int eye) { return readBuffer(images_[eye].colours, sizes_px_[eye], 4); }
Image StereoFrame::readDominantDepth() { return readBuffer(images_[dominant_].depths, sizes_px_[dominant_], 1); }
Image StereoFrame::readInverseDepthMoments() { return readBuffer(images_[dominant_].inverse_depth_moments, sizes_px_[dominant_], 2); }

}  // namespace binosplat
