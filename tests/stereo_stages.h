// The stereo passes on the device, one at a time, over arrays that come from the host and go back to it.
#pragma once

#include "engine/passes/frame_buffers.h"
#include "engine/passes/stereo_passes.h"
#include "tests/gpu_fixture.h"
#include "tests/pass_stages.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace binosplat::test {

// What passes 8 and 9 share. Each call runs one of them; between calls every array may be read or replaced.
class StereoOnDevice {
public:
    // `depths` may be empty where the choice of depth reads none.
    StereoOnDevice(Gpu& gpu, const gpu::StereoView& view, const std::vector<gpu::vec4>& colours, const std::vector<float>& depths,
                   const std::vector<gpu::StereoPixel>& pixels, std::uint32_t boxes = 64)
        : view_(view),
          view_buffer_(gpu.upload("stereo view", std::vector{view})),
          counters_(gpu.upload("stereo counters", std::vector{gpu::StereoCounters{}})),
          colours_(gpu.upload("dominant colours", colours)),
          depths_(gpu.upload("dominant depths", depths)),
          pixels_(gpu.upload("stereo pixels", pixels)),
          buffers_(gpu.context(), view.size_px, boxes),
          borrowed_(gpu.context(), "boxes and pixel classes", buffers_.borrowedBytes()),
          gpu_(gpu) {
        buffers_.borrow(borrowed_.address<gpu::uint>());
        gpu.run([&](Commands& commands) {
            commands.fillZero(buffers_.tiles());
            commands.fillZero(borrowed_);
        });
    }

    void reproject() {
        dispatch("8a_reproject", {alongRows(), readDepth()}, gpu::ReprojectPass{view(), colours(), depths(), stereoPixels(), {}},
                 view_.size_tiles);
    }
    void resolve(bool predict) {
        dispatch("8b_resolve", {alongRows(), predict ? 1u : 0u},
                 gpu::ResolvePass{view(), colours(), stereoPixels(), buffers_.tileErrors(), {}, counters()}, {view_.size_px.y, 1});
    }
    void boundDepths() {
        dispatch("8c_depth_bounds", {alongRows(), readDepth()},
                 gpu::DepthBoundsPass{view(), colours(), depths(), stereoPixels(), buffers_.depthBins()}, view_.size_tiles);
    }
    void findEdgeRois() {
        dispatch("8d_edge_rois", {alongRows()}, gpu::EdgeRoisPass{view(), buffers_.depthBins(), buffers_.tileKinds(), counters()}, {1, 1});
    }
    // All steps of the pass, whatever the counters say of holes.
    void findComponents() {
        const gpu::ComponentsPass pass{
            view(), pixels_.address<gpu::ComponentPixel>(), buffers_.boxes(), buffers_.tileKinds(), counters(), buffers_.boxCapacity()};
        for (std::uint32_t step = 0; step < 4; ++step) { dispatch("8e_components", {alongRows(), step}, pass, view_.size_tiles); }
        dispatch("8e_components", {alongRows(), 4u}, pass, {3, 1});
    }
    // Splats in `order` as `scene` holds them, with what the dominant eye's 4_project counted of each; eye 1 is the affiliated one.
    void addNewcomers(const SceneOnDevice& scene, const std::vector<std::uint32_t>& order, const std::vector<gpu::uint>& dominant_tiles) {
        std::vector<gpu::uint> offsets(dominant_tiles.size());
        std::exclusive_scan(dominant_tiles.begin(), dominant_tiles.end(), offsets.begin(), gpu::uint{0});
        const std::size_t pairs = offsets.empty() ? 0 : offsets.back() + dominant_tiles.back();
        const Buffer order_buffer = gpu_.upload("order", order), offset_buffer = gpu_.upload("dominant offsets", offsets);
        const Buffer lists = gpu_.upload("lists", std::vector{makeList(order.size()), makeList(pairs)});
        gpu::NewcomersPass pass{};
        pass.chunks = scene.scene.chunks();
        pass.eyes = scene.eyeViews();
        pass.stereo = view();
        pass.pixels = stereoPixels();
        pass.order = order_buffer.address<gpu::uint>();
        pass.visible = lists.address<gpu::ListState>();
        pass.dominant_offsets = offset_buffer.address<gpu::uint>();
        pass.dominant_pairs = lists.address<gpu::ListState>(sizeof(gpu::ListState));
        pass.tile_errors = buffers_.tileErrors();
        pass.counters = counters();
        pass.chunk_bits = scene.scene.chunkBits();
        pass.eye = 1;
        dispatch("8f_newcomers", {}, pass, {static_cast<std::uint32_t>((order.size() + gpu::kGroupSize - 1) / gpu::kGroupSize), 1});
    }
    // `visible_count` splats are in the list that patching would go over; returns the lists it will go over instead.
    struct Selected {
        gpu::ListState masked_tiles, masked_visible;
        std::vector<gpu::uint> tile_list, tiles_before;
    };
    Selected select(bool predicted, std::size_t visible_count) {
        const Buffer lists = gpu_.upload("lists", std::vector{makeList(visible_count), gpu::ListState{}, gpu::ListState{}});
        const auto list = [&](std::uint64_t i) { return lists.address<gpu::ListState>(i * sizeof(gpu::ListState)); };
        dispatch("8g_select", {alongRows(), predicted ? 1u : 0u},
                 gpu::SelectPass{view(),
                                 buffers_.tileErrors(),
                                 buffers_.tileKinds(),
                                 buffers_.tileList(),
                                 buffers_.tilesBefore(),
                                 list(0),
                                 list(1),
                                 list(2),
                                 counters(),
                                 {}},
                 {1, 1});
        const auto states = gpu_.readBack<gpu::ListState>(lists, 3);
        return {states[1], states[2], readTiles(buffers_.tileList(), states[1].count), readTiles(buffers_.tilesBefore(), tileCount() + 1)};
    }
    // Returns D.
    std::vector<float> resample(const glm::vec3& background = glm::vec3(0.0f)) {
        const Buffer affiliated_depths = gpu_.upload("affiliated depths", std::vector<float>(pixelCount(), -1.0f));
        dispatch("9_resample", {alongRows(), /*depth=*/1},
                 gpu::ResamplePass{view(), colours(), stereoPixels(), pixels_.address<gpu::vec4>(), affiliated_depths.address<float>(),
                                   buffers_.tileKinds(), buffers_.pixelClasses(), background},
                 view_.size_tiles);
        return gpu_.readBack<float>(affiliated_depths, pixelCount());
    }

    [[nodiscard]] std::vector<gpu::StereoPixel> readPixels() { return gpu_.readBack<gpu::StereoPixel>(pixels_, pixelCount()); }
    [[nodiscard]] std::vector<gpu::vec4> readAffiliated() { return gpu_.readBack<gpu::vec4>(pixels_, pixelCount()); }
    [[nodiscard]] gpu::StereoCounters readCounters() { return gpu_.readBack<gpu::StereoCounters>(counters_, 1)[0]; }
    [[nodiscard]] std::vector<gpu::uint> readTileErrors() { return readTiles(buffers_.tileErrors(), tileCount()); }
    [[nodiscard]] std::vector<gpu::uint> readTileKinds() { return readTiles(buffers_.tileKinds(), tileCount()); }
    [[nodiscard]] std::vector<gpu::uint> readDepthBins() { return readTiles(buffers_.depthBins(), gpu::kDepthBins); }
    [[nodiscard]] std::vector<std::uint8_t> readClasses() {
        const std::size_t row_words = view_.size_tiles.x;
        const auto words = gpu_.readBack<gpu::uint>(borrowed_, row_words * view_.size_px.y);
        std::vector<std::uint8_t> classes;
        for (std::size_t y = 0; y < view_.size_px.y; ++y) {
            for (std::size_t x = 0; x < view_.size_px.x; ++x) {
                classes.push_back(static_cast<std::uint8_t>((words[y * row_words + x / 16] >> (2 * (x % 16))) & 3));
            }
        }
        return classes;
    }

    void writePixels(const std::vector<gpu::StereoPixel>& pixels) { gpu_.upload(pixels_, pixels); }
    void writeCounters(const gpu::StereoCounters& counters) { gpu_.upload(counters_, std::vector{counters}); }
    void writeTileKinds(const std::vector<gpu::uint>& kinds) { writeTiles(buffers_.tileKinds(), kinds); }
    void writeTileErrors(const std::vector<gpu::uint>& errors) { writeTiles(buffers_.tileErrors(), errors); }
    void writeDepthBins(const std::vector<gpu::uint>& bins) { writeTiles(buffers_.depthBins(), bins); }

    [[nodiscard]] std::size_t pixelCount() const { return std::size_t{view_.size_px.x} * view_.size_px.y; }
    [[nodiscard]] std::size_t tileCount() const { return buffers_.tileCount(); }

private:
    [[nodiscard]] std::uint32_t alongRows() const { return isRectified(view_) ? 1 : 0; }
    [[nodiscard]] std::uint32_t readDepth() const { return view_.depth_choice != gpu::kDepthInverse ? 1 : 0; }
    [[nodiscard]] gpu::DeviceAddress<gpu::StereoView> view() const { return view_buffer_.address<gpu::StereoView>(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::StereoCounters> counters() const { return counters_.address<gpu::StereoCounters>(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::vec4> colours() const { return colours_.address<gpu::vec4>(); }
    [[nodiscard]] gpu::DeviceAddress<float> depths() const { return depths_.address<float>(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::StereoPixel> stereoPixels() const { return pixels_.address<gpu::StereoPixel>(); }

    template <typename Pass>
    void dispatch(const char* shader, std::initializer_list<std::uint32_t> constants, const Pass& pass, glm::uvec2 groups) {
        const Kernel kernel(gpu_.context(), shader, sizeof(Pass), constants);
        gpu_.run([&](Commands& commands) { commands.dispatch(kernel, pass, groups.x, groups.y); });
    }
    // The arrays over the tiles lie in one buffer.
    [[nodiscard]] std::uint64_t offsetOf(gpu::DeviceAddress<gpu::uint> array) const { return array.value - buffers_.tileErrors().value; }
    [[nodiscard]] std::vector<gpu::uint> readTiles(gpu::DeviceAddress<gpu::uint> array, std::size_t count) {
        return gpu_.readBack<gpu::uint>(buffers_.tiles(), count, offsetOf(array));
    }
    void writeTiles(gpu::DeviceAddress<gpu::uint> array, const std::vector<gpu::uint>& values) {
        auto all = gpu_.readBack<gpu::uint>(buffers_.tiles(), buffers_.tiles().bytes() / sizeof(gpu::uint));
        std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(offsetOf(array) / sizeof(gpu::uint)));
        gpu_.upload(buffers_.tiles(), all);
    }

    gpu::StereoView view_;
    Buffer view_buffer_, counters_, colours_, depths_, pixels_;
    StereoBuffers buffers_;
    Buffer borrowed_;
    Gpu& gpu_;
};

}  // namespace binosplat::test
