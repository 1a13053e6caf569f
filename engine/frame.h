// The stereo frame as a list of passes: one call renders both eyes.
#pragma once

#include "engine/geometry.h"
#include "engine/mode.h"
#include "engine/passes/passes.h"
#include "engine/passes/warp_passes.h"
#include "engine/passes/warp_traffic.h"
#include "engine/picture/image.h"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct FrameSettings {
    Mode mode = Mode::kPredicted;
    Side dominant = kLeft;
    double near = 0.2;             // scene units
    double units_per_metre = 1.0;  // scene units in a metre of the wearer: says what a jump of the eyes is
    glm::dvec3 background{0.0};
    Order order = Order::kDepth;  // of all modes; a frame of two eyes has one middle, also where nothing is shared
    StereoSettings stereo;        // how one eye is made from the other; `patching` follows from the mode
    // kPaper: each eye is culled, ordered and projected by itself, as in kTwoPass. The two sequential strategies that the paper compares
    // differ only in the second eye's picture (section 4.3), and it mentions no work that the eyes share.
    bool per_eye = false;
    bool half_floats = false;       // pictures of four half floats a pixel: for showing them, half the bytes of what files want
    bool keep_depth = true;         // D of the dominant eye, for readDominantDepth
    bool keep_both_depths = false;  // D of the affiliated eye, too; where it is not rendered, alpha over the inverse depth it was found by
    bool keep_moments = false;      // I and J of the dominant eye, for readInverseDepthMoments
    bool keep_classes = false;      // what made each pixel of the affiliated eye, for readPixelClasses and the report's counters
    bool square_boxes = true;       // the report says how many pairs the customary square bound would make
    // By eye, tiles that nobody will see: a byte a tile, row-major, 1 where it is hidden; empty: none is. They become background, cost no
    // pairs and take no part in the budget, which is a share of the others.
    std::array<std::span<const std::uint8_t>, 2> hidden_tiles = {};
    // kPredicted, by eye: where it looks; empty: nobody knows. Of the affiliated eye's errors only what it sees there counts.
    std::array<std::optional<Gaze>, 2> gazes = {};
    std::uint64_t mark = 0;  // of whoever asks; comes back with the result
};

// Its `stereo`, with what the mode says of patching.
StereoSettings stereoSettingsOf(const FrameSettings& settings);

struct FrameResult {
    PassTimes gpu_ms;
    double gpu_total_ms = 0.0;  // from the first pass to the last
    std::map<std::string, std::uint64_t> counters;
    Traffic stereo_bytes_per_pixel;                    // of the passes that make one eye from the other, where the mode has any
    double tiles_rendered = 1.0, work_rendered = 1.0;  // shares of the affiliated eye's tiles, and of its work if the mode weighs it
    std::uint64_t peak_gpu_bytes = 0;                  // of the device memory this program ever held at a time
    std::vector<std::string> left_out;                 // what this scene and mode did not need
    std::uint64_t mark = 0;                            // of the settings it was asked with
};

// What a frame starts with; the defaults suit every device.
struct FrameOptions {
    FrameCapacity first_capacity{65536, 262144};
    std::uint32_t threads_per_cell = 0;  // see Passes
};

class StereoFrame {
public:
    // Lists of frames that are not waited for have so many times the room that the last known frame needed.
    static constexpr double kRoomAhead = 1.15;

    StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options = {});

    // From now on frames are of `scene`, on the same device. Kernels stay compiled.
    void show(const GpuScene& scene);

    // Renders one eye (Mode::kMono) or two, [kLeft] and [kRight]. Where a buffer is too small for what the eyes see, it grows and the
    // frame is done again: the result is never that of a truncated list. Throws Error if the device lacks the memory.
    // `append` records what becomes of the pictures, in the same submission; it is called again where the frame is done again.
    FrameResult render(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append = {});
    // For showing frame after frame: returns once the frame is on its way to the device, and waits only for the one before the last, whose
    // result it returns (empty where there is none). So the device draws one frame while the next is prepared. Lists have room for more
    // than the last frame needed. A frame that still finds too little room shows background for once and is counted ("frames_cut_short"),
    // and the frame after it is waited for. So is a frame that has little in common with the one before: the first one, one of another
    // size or mode, and one after a jump of the eyes. Where a list has no room in a frame that is waited for, the frame is done again,
    // once, before anybody sees it ("frames_done_again"). What it needs is counted or, where that is not possible, guessed, so that even
    // then it is seldom cut short.
    // `signals`, where given, is signalled when the frame is done.
    std::optional<FrameResult> renderAhead(std::span<const Eye> eyes, const FrameSettings& settings,
                                           const std::function<void(Commands&)>& append = {}, vk::Semaphore signals = {});
    // Makes the images that renderAhead needs for such frames, where they are others than those of the frame before, for which it waits.
    // Throws Error if the device lacks the memory: then no picture is left, and frames as they were before may still be rendered.
    void makeRoom(std::span<const Eye> eyes, const FrameSettings& settings);
    // Waits for all frames under way: after this nothing that they use is in use. The last one's result.
    std::optional<FrameResult> finish();
    // Makes all kernels anew, see Context::replacedShaders. Throws Error where one cannot be made; then some are new and some old.
    void rebuildKernels();
    // Goes on with the kernels of a frame of the same device and options, and with its own that the other lacks: what was made for one
    // scene need not be made again for the next. The other makes anew what it lacks if it goes on.
    void takeKernels(StereoFrame& from);
    // How many it has, but those of sorting.
    [[nodiscard]] std::size_t kernelCount() const { return passes_.kernelCount() + warp_passes_.kernelCount(); }
    // Makes the kernels of such frames, so that none of these waits for a driver's compiler: records them, and has nothing drawn.
    void makeKernels(std::span<const Eye> eyes, const FrameSettings& settings);

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
    [[nodiscard]] const Picture& image(int eye) const { return images_[eye]; }
    [[nodiscard]] const WarpBuffers& warpBuffers() const { return stereo_buffers_; }

private:
    struct MovesAsked {
        StereoSettings stereo;
        int dominant = 0;
        glm::uvec2 size_px{0, 0};
        std::size_t hidden_tiles = 0;
        bool operator==(const MovesAsked&) const = default;
    };
    // A frame on the device, and what must be remembered to understand what it says. Two take turns; what only the device touches they
    // share, since every command waits for those before it, also those of the frame before.
    struct Flight {
        explicit Flight(const Context& context)
            : readback(context, "frame state read-back", sizeof(FrameState), MemoryKind::kReadback), commands(context) {}

        Buffer readback;
        Commands commands;  // after what it writes: it waits before that goes
        std::vector<Eye> eyes;
        FrameSettings settings;
        EyeRelation relation;
        MovesAsked moves_asked;
        bool may_move = true;
    };
    // What frames must have in common to be under way together.
    struct Shape {
        Mode mode = Mode::kMono;
        int dominant = 0;
        bool per_eye = false, half_floats = false, keep_depth = false, keep_both_depths = false, keep_moments = false, keep_classes = false,
             center_rois = false;
        std::array<glm::uvec2, 2> sizes_px{};
        bool operator==(const Shape&) const = default;
    };
    [[nodiscard]] Shape shapeOf(std::span<const Eye> eyes, const FrameSettings& settings) const;
    // Whether lists for these eyes need not be like those of the frame before.
    [[nodiscard]] bool jumps(std::span<const Eye> eyes, const FrameSettings& settings) const;
    void setRoles(const FrameSettings& settings);
    void prepare(std::span<const Eye> eyes, const FrameSettings& settings);
    // Into the flight whose turn it is.
    void record(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append);
    // Waits for it; its result, if it was under way.
    std::optional<FrameResult> land(Flight& flight);
    // Until the lists had room; how often it was done again.
    std::uint64_t renderUntilComplete(std::span<const Eye> eyes, const FrameSettings& settings,
                                      const std::function<void(Commands&)>& append);
    // The same for who shows frames: once more at most. What has no room even then shows background, and has room the next time if the
    // device has that much memory.
    std::uint64_t renderAtMostTwice(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append);
    void renderOnce(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append);
    // Counts the splats that the eyes see, which costs little: without room for them nothing is known of what follows.
    void makeRoomForVisible(std::span<const Eye> eyes, const FrameSettings& settings);
    // Where the dominant eye's pairs had no room, which the other eye's depend on: a guess.
    void makeRoomForPatches();
    void makeRoomAhead();
    void prepareImages(std::span<const Eye> eyes, const FrameSettings& settings);
    void recordFrame(Commands& commands, std::span<const Eye> eyes, const FrameSettings& settings);
    void recordOrderOfAffiliated(Commands& commands, Order order);
    // Passes weigh to select: the dominant eye's picture goes where the affiliated eye sees it.
    void recordMoving(Commands& commands, std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo,
                      const Target& affiliated);
    // Whether rasterize leaves odd rows out of what moves: they will be moved like even ones, and nobody asks for their moments.
    [[nodiscard]] static bool sumsEvenRows(const FrameSettings& settings, const EyeRelation& relation) {
        return settings.mode == Mode::kPredicted && relation.rectified && !settings.keep_moments &&
               settings.stereo.depth_choice == gpu::kDepthInverse;
    }
    // Whether one order of the splats is that of both eyes.
    [[nodiscard]] bool sharesOrder(Order order) const { return order == Order::kDistance || relation_.same_depths; }
    // Of visible splats, an eye's: both eyes' unless each has its own.
    [[nodiscard]] int listOf(int eye) const { return per_eye_ ? eye : 0; }
    [[nodiscard]] FrameState firstStateOf(std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo) const;
    [[nodiscard]] Target targetOf(std::span<const Eye> eyes, const FrameSettings& settings, int eye) const;
    void prepareLists();
    // Pairs that the dominant eye's sort finds room for in the picture of the other eye, while nothing is in it.
    [[nodiscard]] std::uint32_t mostLentPairs() const;
    [[nodiscard]] FrameCapacity lendWhatFits(FrameCapacity capacity) const;
    // Whether the dominant eye's lists had no room, so that its picture shows nothing.
    [[nodiscard]] bool dominantIsVoid() const;
    // Whether the lists had room; if not, makes room.
    bool growIfNeeded();
    // Whether it made room: with some to spare, or as much as is needed where that does not fit.
    bool growIfItFits();
    // False, and the lists as they were, where the device has not that much memory.
    bool tryToGrow(const FrameCapacity& wanted);
    // Of the lists, for `ahead` times what was needed; those that must grow have room for `spare` times that.
    [[nodiscard]] bool hasRoom(double ahead) const { return roomFor(ahead, spareFor(ahead)) == buffers_.capacity(); }
    [[nodiscard]] FrameCapacity roomFor(double ahead, double spare) const;
    [[nodiscard]] double spareFor(double ahead) const;
    // Whether a list had no room at all.
    [[nodiscard]] bool isCutShort() const;
    [[nodiscard]] FrameResult collect(const Flight& flight) const;
    void collectStereo(const Flight& flight, FrameResult& result) const;
    void explainLeftOut(const Flight& flight, FrameResult& result) const;
    template <typename T>
    [[nodiscard]] std::vector<T> readBuffer(const Buffer& buffer, std::uint64_t first_bytes = UINT64_MAX);

    const Context& context_;
    const GpuScene* scene_;
    Passes passes_;
    WarpPasses warp_passes_;
    FrameBuffers buffers_;
    WarpBuffers stereo_buffers_;
    std::array<ShownTiles, 2> shown_;
    std::array<Picture, 2> images_;
    Buffer moments_;  // I and J of the dominant eye, where keep_moments asks for them
    std::array<glm::uvec2, 2> sizes_px_{};
    FrameState state_{};
    // Of the last frame.
    Mode mode_ = Mode::kMono;
    int dominant_ = 0;
    bool per_eye_ = false;  // nothing is culled or ordered for both eyes
    EyeRelation relation_;
    // `predicted` leaves moving out as long as it did not pay in the last frame known, if that was asked for the same.
    MovesAsked moves_asked_;
    bool may_move_ = true;
    FrameCapacity first_capacity_;
    bool first_frame_ = true;
    Shape shape_;
    std::vector<Eye> eyes_;
    bool room_ahead_fits_ = true;  // in the device's memory
    std::uint64_t cut_short_ = 0, done_again_ = 0;
    std::size_t turn_ = 0;
    std::array<Flight, 2> flights_;  // last: they wait before anything goes that they use
};

}  // namespace binosplat
