// A scene whose parts come and go between frames: pages of splats in memory of a fixed size.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/gpu_scene.h"

#include <deque>
#include <optional>
#include <queue>

namespace binosplat {

// Nothing here waits for the device. Memory that a frame in flight still reads is overwritten by a copy in a
// later submission to the same queue, after every command of the earlier one (Commands); and the memory from
// which copies read belongs to their recording.
class ResidentScene {
public:
    // A part that was added, until it is removed; numbers are reused.
    using Part = std::uint32_t;

    struct Options {
        std::uint32_t capacity_pages = 0;  // of kPageSplats
        // The most that a frame uploads; at least one page.
        std::uint64_t most_bytes_a_frame = std::uint64_t{16} << 20;
    };
    // Allocates all of its device memory. Throws Error if there is not that much.
    ResidentScene(const Context& context, const SceneTraits& traits, const Options& options);
    ResidentScene(const ResidentScene&) = delete;
    ResidentScene& operator=(const ResidentScene&) = delete;

    // The scene that frames render: they ask it for changes.
    [[nodiscard]] const GpuScene& scene() const { return scene_; }
    [[nodiscard]] const SceneTraits& traits() const { return scene_.traits_; }
    [[nodiscard]] std::uint32_t capacityPages() const {
        return static_cast<std::uint32_t>(scene_.table_.bounds.size());
    }
    [[nodiscard]] std::uint32_t freePages() const { return static_cast<std::uint32_t>(free_.size()); }
    // Splats of all parts, and of those that frames see.
    [[nodiscard]] std::uint32_t splatsAdded() const { return scene_.splats_coming_; }
    [[nodiscard]] std::uint32_t splatsShown() const { return scene_.splats_held_; }

    // The following are for the thread that records frames, between frames. A new page takes the lowest free
    // place.

    // What a part that comes or goes marks as changed since earlier pictures: everything around it, or
    // nothing, if the caller marks changes more precisely.
    enum class Note { kAll, kNone };

    // Adds splats, which the next frames copy in the order in which they were added; they are visible from
    // the first frame on that has the whole part. Empty if there are not enough free pages: then `pages` is
    // unchanged. `fade`: see setFade.
    std::optional<Part> add(PackedPages&& pages, float fade = 1.0f, Note note = Note::kAll);
    // Invisible from the next frame on; its pages are free at once.
    void remove(Part part, Note note = Note::kAll);
    // Something differs from the next frame on.
    void note(const SceneChange& change) { scene_.changes_noted_.push_back(change); }
    // Multiplies the opacity of its splats from the next frame on, 0 to 1. At 0 it costs nothing.
    void setFade(Part part, float fade);
    // True if frames recorded from now on find all of it in place.
    [[nodiscard]] bool isInPlace(Part part) const { return parts_[part].pages_to_copy == 0; }
    [[nodiscard]] bool hasChanges() const { return !waiting_.empty() || !changed_.empty(); }

    // Called for a recording before anything reads the scene (GpuScene::recordChanges). The recording must be
    // submitted, and before the next one.
    void recordChanges(Commands& commands);

private:
    struct PartState {
        std::vector<std::uint32_t> pages;  // where they lie
        PackedPages packed;                // until it is copied
        std::uint32_t pages_to_copy = 0, splats = 0;
        float fade = 1.0f;
        Note note = Note::kAll;
        std::vector<gpu::ScenePage> bounds;
    };
    void change(std::uint32_t page, const gpu::ScenePage& bounds, float fade);
    void show(const PartState& part);
    void noteChange(const PartState& part, float amount);
    // Pages that the next recording copies, and where from.
    struct PageCopy {
        std::uint32_t page;
        const std::uint8_t* from;
    };
    std::vector<PageCopy> takeWaiting();

    std::uint64_t page_bytes_, most_pages_a_frame_ = 1;
    std::uint32_t pages_per_buffer_ = 1;
    GpuScene scene_;  // its buffers hold the pages
    Buffer page_table_;
    // Changes of scene_.table_, which matches the device once they are copied.
    std::vector<std::uint32_t> changed_;
    std::vector<bool> is_changed_;
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> free_;
    std::vector<PartState> parts_;
    std::vector<Part> free_parts_;
    std::deque<Part> waiting_;         // to be copied, the first one perhaps in part
    std::vector<PackedPages> copied_;  // read by the next recording
};

}  // namespace binosplat
