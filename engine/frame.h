// The stereo frame as a list of passes: one call renders both eyes.
#pragma once

#include "engine/geometry.h"
#include "engine/mode.h"
#include "engine/passes/passes.h"
#include "engine/passes/stereo_passes.h"
#include "engine/passes/stereo_traffic.h"
#include "engine/picture/image.h"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// What splats are blended by, front to back.
enum class Order {
    kDepth,     // camera z of their centres, as scenes are trained: changes as an eye turns, and differs between canted eyes
    kDistance,  // distance of their centres from the middle between the eyes: one order for both eyes, however they turn
};

struct FrameSettings {
    Mode mode = Mode::kPredicted;
    Side dominant = kLeft;
    double near = 0.2;  // scene units
    glm::dvec3 background{0.0};
    Order order = Order::kDepth;  // of all modes; a frame of two eyes has one middle, also where nothing is shared
    StereoSettings stereo;        // how one eye is made from the other; `patching` follows from the mode
    // kPaper: each eye is culled, ordered and projected by itself, as in kTwoPass. The paper has two sequential strategies that differ in
    // the second eye's picture alone (section 4.3); it says of no work that they share.
    bool per_eye = false;
    bool half_floats = false;       // pictures of four half floats a pixel: for showing them, half the bytes of what files want
    bool keep_depth = true;         // D of the dominant eye, for readDominantDepth
    bool keep_both_depths = false;  // D of the affiliated eye, too; where it is not rendered, alpha over the inverse depth it was found by
    bool keep_moments = false;      // I and J of the dominant eye, for readInverseDepthMoments
    bool keep_classes = false;      // what made each pixel of the affiliated eye, for readPixelClasses and the report's counters
    // By eye, tiles that nobody will see: a byte a tile, row-major, 1 where it is hidden; empty: none is. They become background, cost no
    // pairs and take no part in the budget, which is a share of the others.
    std::array<std::span<const std::uint8_t>, 2> hidden_tiles = {};
};

// Its `stereo`, with what the mode says of patching.
StereoSettings stereoSettingsOf(const FrameSettings& settings);

struct FrameResult {
    PassTimes gpu_ms;           // in frame order; "dominant 7_rasterize", "both 1_cull", or the bare pass where there is one eye
    double gpu_total_ms = 0.0;  // from the first pass to the last
    std::map<std::string, std::uint64_t> counters;
    Traffic stereo_bytes_per_pixel;                    // of the passes that make one eye from the other, where the mode has any
    double tiles_rendered = 1.0, work_rendered = 1.0;  // shares of the affiliated eye's tiles, and of its work if the mode weighs it
    std::uint64_t peak_gpu_bytes = 0;                  // of the device memory this program ever held at a time
    std::vector<std::string> left_out;                 // what this scene and mode did not need
};

// What a frame starts with; the defaults suit every device.
struct FrameOptions {
    FrameCapacity first_capacity{65536, 262144};
    std::uint32_t threads_per_cell = 0;  // see Passes
};

class StereoFrame {
public:
    StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options = {});

    // From now on frames are of `scene`, on the same device. Kernels stay compiled.
    void show(const GpuScene& scene);

    // Renders one eye (Mode::kMono) or two, [kLeft] and [kRight]. Where a buffer is too small for what the eyes see, it grows and the
    // frame is done again: the result is never that of a truncated list. Throws Error if the device has not the memory.
    // `append` records what becomes of the pictures, in the same submission; it is called again where the frame is done again.
    FrameResult render(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append = {});
    // Makes all kernels anew, see Context::replacedShaders. Throws Error where one cannot be made; then some are new and some old.
    void rebuildKernels();

    // Pictures of the last frame. RGBA as blended (rgb = sum w c + T background, a = sum w).
    [[nodiscard]] Image readPicture(int eye);
    // D = sum w z of the dominant eye, one channel.
    [[nodiscard]] Image readDominantDepth() { return readDepth(dominant_); }
    // The same of any eye, where it was kept.
    [[nodiscard]] Image readDepth(int eye);
    // I = sum w/z and J = sum w/z^2 of the dominant eye, two channels; where they were kept.
    [[nodiscard]] Image readInverseDepthMoments();
    // What made each tile of the affiliated picture (kTileEdge ...; 0: reprojection), row-major; empty where no mode chose.
    [[nodiscard]] std::vector<std::uint32_t> readTileKinds();
    // What made each pixel of the affiliated picture that lies in no such tile (kCovered, kGap, kHole), row-major; where they
    // were kept.
    [[nodiscard]] std::vector<std::uint8_t> readPixelClasses();

    // The same in device memory, for whoever shows them.
    [[nodiscard]] const EyeImage& image(int eye) const { return images_[eye]; }
    [[nodiscard]] const StereoBuffers& stereoBuffers() const { return stereo_buffers_; }

private:
    void prepareImages(std::span<const Eye> eyes, const FrameSettings& settings);
    void recordFrame(std::span<const Eye> eyes, const FrameSettings& settings);
    void recordOrderOfAffiliated(Order order);
    // Whether one order of the splats is that of both eyes.
    [[nodiscard]] bool sharesOrder(Order order) const { return order == Order::kDistance || relation_.same_depths; }
    // Of visible splats, an eye's: both eyes' unless each has its own.
    [[nodiscard]] int listOf(int eye) const { return per_eye_ ? eye : 0; }
    [[nodiscard]] FrameState firstStateOf(std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo) const;
    [[nodiscard]] EyeTarget targetOf(std::span<const Eye> eyes, const FrameSettings& settings, int eye) const;
    void prepareLists();
    // Pairs that the dominant eye's sort finds room for in the picture of the other eye, while nothing is in it.
    [[nodiscard]] std::uint32_t mostLentPairs() const;
    [[nodiscard]] FrameCapacity lendWhatFits(FrameCapacity capacity) const;
    // Whether the dominant eye's lists had no room, so that its picture shows nothing.
    [[nodiscard]] bool dominantIsVoid() const;
    // Whether the lists had room; if not, makes room.
    bool growIfNeeded();
    [[nodiscard]] FrameResult collect(std::span<const Eye> eyes, const FrameSettings& settings) const;
    void explainLeftOut(std::span<const Eye> eyes, const FrameSettings& settings, FrameResult& result) const;
    template <typename T>
    [[nodiscard]] std::vector<T> readBuffer(const Buffer& buffer, std::uint64_t first_bytes = UINT64_MAX);

    const Context& context_;
    const GpuScene* scene_;
    Passes passes_;
    StereoPasses stereo_passes_;
    Commands commands_;
    FrameBuffers buffers_;
    StereoBuffers stereo_buffers_;
    std::array<ShownTiles, 2> shown_;
    std::array<EyeImage, 2> images_;
    Buffer moments_;  // I and J of the dominant eye, where keep_moments asks for them
    std::array<glm::uvec2, 2> sizes_px_{};
    Buffer state_readback_;
    FrameState state_{};
    // Of the last frame.
    Mode mode_ = Mode::kMono;
    int dominant_ = 0;
    bool per_eye_ = false;  // nothing is culled or ordered for both eyes
    EyeRelation relation_;
    // Whether anything is moved. `predicted` leaves it out as long as it did not pay in the frame before, if that was asked for the same.
    struct MovesAsked {
        StereoSettings stereo;
        int dominant = 0;
        glm::uvec2 size_px{0, 0};
        std::size_t hidden_tiles = 0;
        bool operator==(const MovesAsked&) const = default;
    };
    MovesAsked moves_asked_;
    bool may_move_ = true;
    FrameCapacity first_capacity_;
    bool first_frame_ = true;
};

}  // namespace binosplat
