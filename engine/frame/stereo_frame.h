// The stereo frame: one call plans, records and runs the passes that render both eyes.
#pragma once

#include "engine/frame/history.h"
#include "engine/frame/record.h"
#include "engine/picture/image.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

class StereoFrame {
public:
    static constexpr double kCapacityAhead = FrameMemory::kCapacityAhead;

    StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options = {});
    // With `kernels`, which outlive it, and which frames on other threads may use, too.
    StereoFrame(const Context& context, const GpuScene& scene, PassKernels& kernels,
                const FrameOptions& options = {})
        : StereoFrame(context, scene, options, &kernels) {}
    StereoFrame(const StereoFrame&) = delete;
    StereoFrame& operator=(const StereoFrame&) = delete;
    ~StereoFrame();
    // Another frame of the scene that `other` shows, with pictures and histories of its own. It uses the
    // kernels of `other`, which must outlive it.
    static std::unique_ptr<StereoFrame> beside(StereoFrame& other);

    // Frames show `scene` from now on, which is on the same device. Kernels stay compiled. Waits for frames
    // in flight. Throws Error if the device does not have enough memory; then frames still show the previous
    // scene.
    void show(const GpuScene& scene);

    // The same without a wait, for a scene that has as many splats, in the same memory (GpuScene::asItIs);
    // between frames.
    void goOnWith(const GpuScene& scene);
    // Memory from which the scene's changes are copied: as much as frames have needed, and makes it before
    // they do, while none is in flight.
    [[nodiscard]] std::uint64_t bytesForChanges() const {
        return std::max(flights_[0].commands.stagingBytes(), flights_[1].commands.stagingBytes());
    }
    void reserveForChanges(std::uint64_t bytes);

    // Renders one eye (Mode::kMono) or two, [kLeft] and [kRight]. If a buffer is too small for what the eyes
    // see, it grows and the frame is rendered once more, so the result never comes from a truncated list.
    // Throws Error if the device does not have enough memory. `append` records what is done with the
    // pictures, in the same submission; it is called again if the frame is rendered once more.
    FrameResult render(std::span<const Eye> eyes, const FrameSettings& settings,
                       const std::function<void(Commands&)>& append = {});
    // For showing frame after frame: returns once the frame is on its way to the device, and waits only for
    // the frame before the previous one, whose result it returns (empty if there is none). The device thus
    // draws one frame while the next is prepared. Lists have more capacity than the last frame needed. A
    // frame whose lists are still too short shows background once and is counted ("frames_cut_short"), and
    // the frame after it is waited for. So is a frame that has little in common with the previous one: the
    // first one, one with another size or mode, and one after a jump of the eyes. If a list is too short in a
    // frame that is waited for, the frame is rendered once more before it is shown ("frames_done_again").
    // What it needs is counted or, if that is not possible, guessed, so even then it is seldom cut short. If
    // the settings say so (FrameSettings::waits_for_lists), only the first frame and those with another mode,
    // or another size without memory for it, are waited for: longer lists are made on a thread, and a later
    // frame uses them. `signals`, if given, is signalled when the frame is done.
    std::optional<FrameResult> renderAhead(std::span<const Eye> eyes, const FrameSettings& settings,
                                           const std::function<void(Commands&)>& append = {},
                                           vk::Semaphore signals = {});
    // Before the first frame of another size for which there is memory (FrameSettings::most_px): true if
    // lists probably have capacity for it; otherwise longer ones are being made beside the frames, and later
    // calls say when they are there. Does not wait.
    [[nodiscard]] bool growFor(glm::uvec2 size_px);
    // In place of a frame, while those of another StereoFrame are shown: waits for the frame before the
    // previous one, as renderAhead does.
    void passOver();
    // A frame for commands that the caller submits, to the device's queue and in the order of recording.
    struct Lent {
        std::uint64_t number;
        vk::CommandBuffer commands;  // secondary, for outside of render passes
    };
    // Does not wait: lists have more capacity than the last frame that came back needed, and a frame with
    // lists that are too short shows background. Each lent frame comes back once.
    Lent lend(std::span<const Eye> eyes, const FrameSettings& settings,
              const std::function<void(Commands&)>& append = {});
    // The device has finished it.
    FrameResult takeBack(std::uint64_t number);
    // Nobody will submit it.
    void takeBackUnused(std::uint64_t number);
    // From now on the caller records the scene's changes, and submits them before each frame.
    void leaveChanges() { brings_changes_ = false; }
    // The next frame has no history.
    void forgetHistory() { histories_ = {}; }

    // Makes the images that renderAhead needs for such frames, if they differ from those of the previous
    // frame, for which it waits. Throws Error if the device does not have enough memory; then no pictures are
    // left, and frames as before may still be rendered.
    void reserve(std::span<const Eye> eyes, const FrameSettings& settings);
    // Waits for all frames in flight, after which nothing that they use is in use, and for lists that are
    // being made. Returns the last one's result.
    std::optional<FrameResult> finish();
    // Makes all kernels again, see Context::replacedShaders. Throws Error if one cannot be made; then some
    // are new and some old.
    void rebuildKernels();
    // The number of its kernels.
    [[nodiscard]] std::size_t kernelCount() const { return kernels_.size(); }
    // Makes the kernels for such frames, so that they do not wait for a driver's compiler: records them, but
    // draws nothing.
    void makeKernels(std::span<const Eye> eyes, const FrameSettings& settings);

    // Pictures of the last frame. RGBA as blended (rgb = sum w c + T background, a = sum w).
    [[nodiscard]] Image readPicture(int eye);
    // D = sum w z of the dominant eye, one channel.
    [[nodiscard]] Image readDominantDepth() { return readDepth(plan_.dominant); }
    // The same for any eye, if it was kept.
    [[nodiscard]] Image readDepth(int eye);
    // The depth, along the eye's axis, of what a pixel shows, D over alpha; only this is read back. Empty if
    // less than half of the pixel is covered, or if the depth was not kept.
    [[nodiscard]] std::optional<double> depthAt(int eye, glm::uvec2 pixel);
    // I = sum w/z and J = sum w/z^2 of the dominant eye, two channels; if they were kept.
    [[nodiscard]] Image readInverseDepthMoments();
    // How each tile of the affiliated picture was made (kTileEdge ...; 0: reprojected), row-major; empty if
    // the mode does not choose tiles.
    [[nodiscard]] std::vector<std::uint32_t> readTileKinds();
    // The same for any eye's picture, including one that is made from its own history.
    [[nodiscard]] std::vector<std::uint32_t> readTileKinds(int eye);
    // How each pixel of the affiliated picture outside such tiles was made (kCovered, kGap, kHole),
    // row-major; if these were kept.
    [[nodiscard]] std::vector<std::uint8_t> readPixelClasses();

    // The same in device memory, for display.
    [[nodiscard]] const Picture& picture(int eye) const {
        return memory_.picture(plan_.targets[static_cast<std::size_t>(eye)].picture);
    }
    // The buffers with the kinds of an eye's tiles in the last frame; null if it was rendered in full.
    [[nodiscard]] const WarpBuffers* chosenTiles(int eye) const;
    // For the target that is made from another; without memory if there is none.
    [[nodiscard]] const WarpBuffers& warpBuffers() const {
        return memory_.warp(plan_.warpedTarget().value_or(0));
    }

private:
    // If null, it has kernels of its own.
    StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options,
                PassKernels* others);

    using Append = std::function<void(Commands&)>;
    // A frame on the device, and what must be remembered to interpret its report. Two take turns. They share
    // what only the device touches, since every command waits for all earlier ones, even those of the
    // previous frame.
    struct Flight {
        explicit Flight(const Context& context, Commands::Level level = Commands::Level::kPrimary)
            : readback(context, "frame state read-back", sizeof(FrameState), MemoryKind::kReadback),
              commands(context, level) {}

        Buffer readback;
        Commands commands;  // last, after the buffer that it writes: it waits before that is freed
        FramePlan plan;
        FrameSettings settings;
        MovingPays::Asked asked;
        std::uint32_t splats_held = 0;  // by the scene
    };

    [[nodiscard]] Flight& flight() { return flights_[turn_]; }
    // `drops`: the recording will be dropped, and must leave the scene's changes to the next one.
    [[nodiscard]] FrameRecorder recorder(bool drops = false) {
        return {kernels_, *scene_, memory_, drops ? std::nullopt : std::optional(changes_known_),
                brings_changes_};
    }
    // The histories that earlier frames have left for such a frame.
    [[nodiscard]] Histories historiesFor(std::span<const Eye> eyes, const FrameSettings& settings) const;
    // The share of both eyes' tiles in which the scene differs from what the last frame shows.
    [[nodiscard]] double changedShare(std::span<const Eye> eyes, const FrameSettings& settings) const;
    // Plans the frame without a history, even if there is one.
    void planAnew(const FrameSettings& settings);
    // Plans the frame, and provides capacity as far as its needs are known.
    void prepare(std::span<const Eye> eyes, const FrameSettings& settings);
    // Records what was prepared.
    void record(Flight& flight, const FrameSettings& settings, const Append& append);
    // Waits for it; returns its result, if it was in flight.
    std::optional<FrameResult> land(Flight& flight);
    // Reads the frame's report, and learns from it.
    FrameResult take(const Flight& flight);
    void renderOnce(const FrameSettings& settings, const Append& append);
    // Renders until the lists are long enough.
    void renderUntilComplete(const FrameSettings& settings, const Append& append);
    // The same for display, but at most once more; returns how often it was repeated. If lists are too short
    // even then, background is shown; they are long enough the next time if the device has that much memory.
    std::uint64_t renderAtMostTwice(const FrameSettings& settings, const Append& append);
    // What the last known frame would have reported if it had seen all splats that come with the next
    // changes.
    [[nodiscard]] FrameState stateAhead() const;
    // `temporal`: true if reprojecting does not pay, and the lists have capacity for whole pictures. If they
    // lack it, longer ones are being made.
    [[nodiscard]] bool rendersInFull(std::span<const Eye> eyes, const FrameSettings& settings);
    void learnWhetherHistoryPays(const HistoryPays::Asked& asked, const FrameCounters& counters);
    // Counts the splats that the eyes see, which costs little; if their list is too short, nothing is known
    // about what follows.
    void growForVisible();
    // How much a frame has in common with the previous one.
    enum class Likeness {
        kAlike,
        kJumps,  // lists may be too short
        kOther,  // it needs other memory
    };
    [[nodiscard]] Likeness likenessToLast(std::span<const Eye> eyes, const FrameSettings& settings) const;
    template <typename T>
    [[nodiscard]] std::vector<T> readBuffer(const Buffer& buffer, std::uint64_t most_bytes = UINT64_MAX,
                                            std::uint64_t from_byte = 0);

    const Context& context_;
    const GpuScene* scene_ = nullptr;
    std::unique_ptr<PassKernels> own_kernels_;  // null if they are another frame's
    PassKernels& kernels_;
    FrameMemory memory_;
    FramePlan plan_;                  // of the last frame
    Histories histories_;             // that the last frame leaves
    FrameShape history_shape_;        // of these histories, apart from sizes
    FrameState state_{};              // the report of the last known frame
    std::uint32_t splats_known_ = 0;  // how many the scene had then
    MovingPays moving_pays_;
    HistoryPays history_pays_;
    bool brings_changes_ = true;
    // The scene's changes that the last frame shows, see GpuScene::changesSince.
    std::uint64_t changes_known_ = 0;
    FrameShape shape_;
    std::vector<Eye> eyes_;
    std::uint64_t cut_short_ = 0, done_again_ = 0;
    std::size_t turn_ = 0;
    std::map<std::uint64_t, std::unique_ptr<Flight>> lent_;
    std::vector<std::unique_ptr<Flight>> idle_;  // can be lent again
    std::array<Flight, 2> flights_;              // last: they wait before anything that they use is freed
};

}  // namespace binosplat
