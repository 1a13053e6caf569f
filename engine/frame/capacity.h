// The device memory of frames: pictures, lists, and the buffers of warps; as much as the eyes need, which the
// frames themselves find out.
#pragma once

#include "engine/frame/longer_lists.h"
#include "engine/frame/plan.h"
#include "engine/passes/shown_tiles.h"
#include "engine/passes/warp_buffers.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

class FrameMemory {
public:
    // Lists of frames that are not waited for have this many times the capacity that the last known frame
    // needed.
    static constexpr double kCapacityAhead = 1.15;

    // `wait_for_frames`: returns once no frame in flight uses this; called before any of it is freed.
    FrameMemory(const Context& context, const FrameCapacity& first_capacity,
                std::function<void()> wait_for_frames);

    // Lists hold splats of `scene` from now on.
    void show(const GpuScene& scene);
    // Another one with as many splats.
    void goOnWith(const GpuScene& scene) { scene_ = &scene; }
    // Resets this, as if no frame had been drawn yet.
    void forgetFrames() { first_frame_ = true; }
    [[nodiscard]] bool isFirstFrame() const { return first_frame_; }

    // Pictures as the plan wants them. `hidden_tiles`: see FrameSettings. Throws Error if the device lacks
    // the memory: then no picture is left.
    void fitPictures(const FramePlan& plan, const std::array<std::span<const std::uint8_t>, 2>& hidden_tiles);
    // Makes lists, if there are none.
    void fitLists();

    // The following concern what a frame drawn according to `plan` reported.

    // True if a list lacked all capacity.
    [[nodiscard]] static bool isCutShort(const FrameState& state);
    // True if the lists of the target from which others are made lacked capacity, so that its picture shows
    // nothing.
    [[nodiscard]] static bool isSourceVoid(const FramePlan& plan, const FrameState& state);
    // True if the lists have capacity for `ahead` times what was needed.
    [[nodiscard]] bool hasCapacity(const FramePlan& plan, const FrameState& state, double ahead) const;
    // True if the lists were long enough; if not, makes them longer.
    bool growIfNeeded(const FramePlan& plan, const FrameState& state);
    // True if it made them longer: with some to spare or, if that does not fit, just as long as needed.
    bool growIfItFits(const FramePlan& plan, const FrameState& state);
    // If the source's pairs did not fit: makes a guess, since the target's depend on them.
    void growForChosen(const FramePlan& plan, const FrameState& state);
    // Provides kCapacityAhead times what was needed, or less if that does not fit, as long as the lists
    // themselves do.
    void growAhead(const FramePlan& plan, const FrameState& state);
    [[nodiscard]] bool fitsAhead() const { return fits_ahead_; }

    // The same without a wait: begins to make lists that are long enough for what is ahead, beside the
    // frames. Does nothing if they are, or while some are being made.
    void growBeside(const FramePlan& plan, const FrameState& state);
    // False: the device lacked the memory for these and the present ones at a time. Then only the calls above
    // help.
    [[nodiscard]] bool growsBeside() const { return fits_beside_; }
    // Before each frame, once all but the last one have finished: brings lists that have been made.
    void bringLonger();
    // While no frame is on the device: waits for those, and brings them.
    void finishLonger();
    // The frame had enough.
    void haveFrame() { first_frame_ = false; }

    [[nodiscard]] const FrameBuffers& lists() const { return lists_; }
    // By TargetPlan::picture, which need not be the target's number.
    [[nodiscard]] const Picture& picture(int picture) const {
        return pictures_[static_cast<std::size_t>(picture)];
    }
    [[nodiscard]] const Buffer& moments() const { return moments_; }  // I and J of the target that keeps them
    [[nodiscard]] const WarpBuffers& warp(int target) const {
        return warps_[static_cast<std::size_t>(target)];
    }
    [[nodiscard]] const ShownTiles& shown(int target) const {
        return shown_[static_cast<std::size_t>(target)];
    }
    // Where lists of the target, and of those that are rendered with it, may lie.
    [[nodiscard]] EmptyPictures emptyPictures(const FramePlan& plan, const TargetPlan& target) const;
    // For the scene's changes, in all pictures of a frame: made when it is first needed, or with the
    // pictures.
    [[nodiscard]] const Buffer& changedRects();
    // Call this before the passes of a frame.
    void recordShown(Commands& commands);

private:
    // Makes this many bytes, if it has not, and uses some of them; all if `used` is absent.
    void resize(Buffer& buffer, const char* name, std::uint64_t bytes,
                std::optional<std::uint64_t> used = {});
    void growLists(const FrameCapacity& capacity);
    // Colours of both eyes lie side by side where lists are in both.
    void joinColours(const FramePlan& plan);
    void fitPicture(Picture& picture, glm::uvec2 size_px, glm::uvec2 memory_px, const Kept& kept);
    void fitWarps(const FramePlan& plan);
    // The capacity of VisibleBuffers for a list of so many, in this frame and the next.
    [[nodiscard]] std::uint32_t capacityForSplats(const FramePlan& plan, std::uint32_t splats) const;
    // The capacity of PairBuffers for this many pairs of a target, with lists of splats of this capacity.
    [[nodiscard]] std::uint32_t capacityForPairs(const FramePlan& plan, const TargetPlan& target,
                                                 std::uint32_t pairs, std::uint32_t visible,
                                                 bool is_ahead) const;
    // False, with the lists as they were, if the device lacks the memory.
    bool tryToGrow(const FrameCapacity& wanted);
    // Capacity for `spare` times what was needed, in the lists that must grow.
    [[nodiscard]] FrameCapacity capacityFor(const FramePlan& plan, const FrameState& state, double ahead,
                                            double spare) const;
    [[nodiscard]] double spareFor(double ahead) const;
    void learnWhichFitted(std::optional<std::size_t> which);

    const Context& context_;
    const GpuScene* scene_ = nullptr;
    FrameCapacity first_capacity_;
    std::function<void()> wait_for_frames_;
    FrameBuffers lists_;
    Buffer both_colours_;
    std::uint64_t alignment_ = 0;  // of its parts; 0: not asked yet, since that makes a buffer
    std::array<Picture, kFramePictures> pictures_;
    Buffer moments_;
    std::array<WarpBuffers, kMostTargets> warps_;  // of those that are made from others
    std::vector<ShownTiles> shown_;
    Buffer changed_rects_;
    bool first_frame_ = true;
    bool fits_ahead_ = true;  // in the device's memory
    bool fits_beside_ = true;
    std::vector<bool> are_ahead_;  // of the lists that are being made, one after the other until one fits
    LongerLists longer_;           // last: its thread ends first
};

}  // namespace binosplat
