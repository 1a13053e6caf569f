// Places for pages, and their entries in the device's tables.
#include "engine/stream/resident_scene.h"

#include "engine/error.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace binosplat {
namespace {

// The bytes of a page's entries in the device's tables.
constexpr std::uint64_t kEntryBytes = sizeof(gpu::SceneChunk) + sizeof(gpu::ScenePage);
// Enough for some seconds while a scene is loaded: pictures older than these are no longer of use.
constexpr std::size_t kMostChangesKept = 65536;

// Parts of one copy, merged if they follow one another on both sides.
class CopyParts {
public:
    void add(std::uint64_t from, std::uint64_t to, std::uint64_t bytes) {
        if (!parts_.empty() && parts_.back().srcOffset + parts_.back().size == from &&
            parts_.back().dstOffset + parts_.back().size == to) {
            parts_.back().size += bytes;
        } else {
            parts_.emplace_back(from, to, bytes);
        }
    }
    // In parallel with what was recorded before it, unless it is the `first` one.
    void record(Commands& commands, const Buffer& from, const Buffer& to, bool& first) const {
        if (parts_.empty()) { return; }
        if (!std::exchange(first, false)) { commands.beside(); }
        commands.copy(from, to, parts_);
    }

private:
    std::vector<vk::BufferCopy> parts_;
};

}  // namespace

ResidentScene::ResidentScene(const Context& context, const SceneTraits& traits, const Options& options)
    : page_bytes_(ChunkLayout(gpu::kPageSplats, traits).bytes) {
    const std::uint32_t capacity = options.capacity_pages;
    check(capacity > 0 && capacity <= gpu::kMaxItems / gpu::kPageSplats,
          "{} pages of {} splats, 1 to {} can be held", capacity, gpu::kPageSplats,
          gpu::kMaxItems / gpu::kPageSplats);
    const std::uint64_t table_bytes = capacity * kEntryBytes, most_bytes = context.maxAllocationBytes();
    check(page_bytes_ + table_bytes <= most_bytes,
          "{}: a page of {} splats and a table of {} pages need {} bytes, one allocation holds at most {}",
          context.deviceName(), gpu::kPageSplats, capacity, page_bytes_ + table_bytes, most_bytes);
    // Staging is one allocation, and rounded up.
    const std::uint64_t staged_bytes = std::min(options.most_bytes_a_frame, (most_bytes - table_bytes) / 2);
    most_pages_a_frame_ = std::max<std::uint64_t>(staged_bytes / page_bytes_, 1);
    pages_per_buffer_ = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(context.maxAllocationBytes() / page_bytes_, capacity));
    const ChunkLayout layout(gpu::kPageSplats, traits);
    for (std::uint32_t first = 0; first < capacity; first += pages_per_buffer_) {
        const std::uint32_t pages = std::min(pages_per_buffer_, capacity - first);
        const Buffer& buffer = scene_.buffers_.emplace_back(
            context, fmt::format("scene pages {}", scene_.buffers_.size()), pages * page_bytes_);
        for (std::uint32_t page = 0; page < pages; ++page) {
            scene_.table_.chunks.push_back(layout.chunkAt(buffer, page * page_bytes_, 0.0f));
        }
        scene_.bytes_ += buffer.bytes();
    }
    scene_.table_.bounds.resize(capacity);
    is_changed_.resize(capacity, false);
    scene_.chunk_table_ = Buffer(context, "scene pages' addresses", capacity * sizeof(gpu::SceneChunk));
    page_table_ = Buffer(context, "scene pages' bounds", capacity * sizeof(gpu::ScenePage));
    scene_.traits_ = traits;
    scene_.splat_count_ = capacity * gpu::kPageSplats;
    scene_.chunk_bits_ = static_cast<std::uint32_t>(std::countr_zero(gpu::kPageSplats));
    scene_.chunk_count_ = capacity;
    scene_.chunks_ = scene_.chunk_table_.address<gpu::SceneChunk>();
    scene_.pages_ = page_table_.address<gpu::ScenePage>();
    scene_.bytes_ += scene_.chunk_table_.bytes() + page_table_.bytes();
    scene_.record_changes_ = [this](Commands& commands) { recordChanges(commands); };
    // The first recording uploads the entries of all of them.
    for (std::uint32_t page = 0; page < capacity; ++page) {
        free_.push(page);
        change(page, {}, 0.0f);
    }
}

void ResidentScene::change(std::uint32_t page, const gpu::ScenePage& bounds, float fade) {
    scene_.table_.bounds[page] = bounds;
    scene_.table_.chunks[page].fade = fade;
    if (is_changed_[page]) { return; }
    is_changed_[page] = true;
    changed_.push_back(page);
}

// A page that has faded out counts as empty.
void ResidentScene::show(const PartState& part) {
    for (std::size_t i = 0; i < part.pages.size(); ++i) {
        change(part.pages[i], part.fade > 0.0f ? part.bounds[i] : gpu::ScenePage{}, part.fade);
    }
}

void ResidentScene::noteChange(const PartState& part, float amount) {
    SceneChange change{glm::vec3(std::numeric_limits<float>::infinity()), {}, amount};
    change.high = -change.low;
    for (const gpu::ScenePage& page : part.bounds) {
        if (page.count == 0) { continue; }
        change.low = glm::min(change.low, page.low);
        change.high = glm::max(change.high, page.high);
    }
    if (amount > 0.0f && change.low.x <= change.high.x) { note(change); }
}

std::optional<ResidentScene::Part> ResidentScene::add(PackedPages&& pages, float fade, Note note) {
    assert(fade >= 0.0f && fade <= 1.0f);
    if (pages.pageCount() > freePages()) { return std::nullopt; }
    assert(pages.bytes().size() == pages.pageCount() * page_bytes_);  // of the same traits
    Part part = static_cast<Part>(parts_.size());
    if (free_parts_.empty()) {
        parts_.emplace_back();
    } else {
        part = free_parts_.back();
        free_parts_.pop_back();
    }
    PartState& state = parts_[part];
    state.splats = pages.splatCount();
    state.pages_to_copy = pages.pageCount();
    state.fade = fade;
    state.note = note;
    state.bounds = pages.pages();
    for (std::uint32_t i = 0; i < pages.pageCount(); ++i) {
        state.pages.push_back(free_.top());
        free_.pop();
    }
    scene_.splats_coming_ += state.splats;
    state.packed = std::move(pages);
    if (state.pages_to_copy > 0) { waiting_.push_back(part); }
    return part;
}

void ResidentScene::remove(Part part, Note note) {
    PartState& state = parts_[part];
    if (isInPlace(part)) {
        scene_.splats_held_ -= state.splats;
        scene_.pages_held_ -= static_cast<std::uint32_t>(state.pages.size());
        if (note == Note::kAll) { noteChange(state, state.fade); }
    } else {
        waiting_.erase(std::ranges::find(waiting_, part));
    }
    scene_.splats_coming_ -= state.splats;
    for (const std::uint32_t page : state.pages) {
        change(page, {}, 0.0f);
        free_.push(page);
    }
    state = {};
    free_parts_.push_back(part);
}

void ResidentScene::setFade(Part part, float fade) {
    assert(fade >= 0.0f && fade <= 1.0f);
    PartState& state = parts_[part];
    const float before = std::exchange(state.fade, fade);
    if (before == fade || !isInPlace(part)) { return; }
    show(state);
    noteChange(state, std::abs(fade - before));
}

std::vector<ResidentScene::PageCopy> ResidentScene::takeWaiting() {
    std::vector<PageCopy> copies;
    while (!waiting_.empty() && copies.size() < most_pages_a_frame_) {
        PartState& state = parts_[waiting_.front()];
        const std::size_t done = state.pages.size() - state.pages_to_copy;
        const std::size_t now =
            std::min<std::size_t>(state.pages_to_copy, most_pages_a_frame_ - copies.size());
        for (std::size_t i = done; i < done + now; ++i) {
            copies.push_back({state.pages[i], state.packed.bytes().data() + i * page_bytes_});
        }
        state.pages_to_copy -= static_cast<std::uint32_t>(now);
        if (state.pages_to_copy > 0) { break; }
        copied_.push_back(std::move(state.packed));
        scene_.splats_held_ += state.splats;
        scene_.pages_held_ += static_cast<std::uint32_t>(state.pages.size());
        show(state);
        if (state.note == Note::kAll) { noteChange(state, state.fade); }
        waiting_.pop_front();
    }
    return copies;
}

void ResidentScene::recordChanges(Commands& commands) {
    // As much in each frame, so that none but the first ones make it.
    const std::uint64_t most_pages = std::min<std::uint64_t>(capacityPages(), most_pages_a_frame_);
    const Buffer& staging = commands.staging(most_pages * page_bytes_ + capacityPages() * kEntryBytes);
    if (!hasChanges()) { return; }
    const std::vector<PageCopy> copies = takeWaiting();
    std::ranges::sort(changed_);
    std::uint8_t* const to = staging.mapped<std::uint8_t>().data();
    std::uint64_t staged = 0;
    const auto stage = [&](CopyParts& parts, const void* data, std::uint64_t at, std::uint64_t bytes) {
        std::memcpy(to + staged, data, bytes);
        parts.add(staged, at, bytes);
        staged += bytes;
    };
    std::vector<CopyParts> of_buffers(scene_.buffers_.size());
    for (const PageCopy& copy : copies) {
        stage(of_buffers[copy.page / pages_per_buffer_], copy.from,
              copy.page % pages_per_buffer_ * page_bytes_, page_bytes_);
    }
    CopyParts of_chunks, of_pages;
    for (const std::uint32_t page : changed_) {
        stage(of_chunks, &scene_.table_.chunks[page], page * sizeof(gpu::SceneChunk),
              sizeof(gpu::SceneChunk));
    }
    for (const std::uint32_t page : changed_) {
        stage(of_pages, &scene_.table_.bounds[page], page * sizeof(gpu::ScenePage), sizeof(gpu::ScenePage));
        is_changed_[page] = false;
    }
    changed_.clear();
    copied_.clear();
    if (scene_.changes_.size() > kMostChangesKept) {
        scene_.changes_forgotten_ += scene_.changes_.size();
        scene_.changes_.clear();
    }
    scene_.changes_.insert(scene_.changes_.end(), scene_.changes_noted_.begin(), scene_.changes_noted_.end());
    scene_.changes_noted_.clear();
    bool first = true;
    for (std::size_t b = 0; b < of_buffers.size(); ++b) {
        of_buffers[b].record(commands, staging, scene_.buffers_[b], first);
    }
    of_chunks.record(commands, staging, scene_.chunk_table_, first);
    of_pages.record(commands, staging, page_table_, first);
}

}  // namespace binosplat
