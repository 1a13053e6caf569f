// Splats page by page, as bytes.
#include "engine/stream/scene_frames.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace binosplat {
namespace {

constexpr std::size_t kSplatsAPage = gpu::kPageSplats;

// Splats of a page, one by one.
class PageReader {
public:
    PageReader(const SplatPage& page, const ChunkLayout& layout, const SceneTraits& traits)
        : bytes_(page.bytes.data()), layout_(layout), has_thicknesses_(traits.isGaussian3d()) {}

    [[nodiscard]] glm::vec3 centre(std::size_t i) const { return read<glm::vec3>(layout_.positions, i); }
    [[nodiscard]] glm::quat rotation(std::size_t i) const {
        const auto q = read<glm::vec4>(layout_.rotations, i);
        return {q.w, q.x, q.y, q.z};
    }
    [[nodiscard]] glm::vec3 scales(std::size_t i) const {
        return {read<glm::vec2>(layout_.scales, i), has_thicknesses_ ? read<float>(layout_.thicknesses, i) : 0.0f};
    }
    [[nodiscard]] float opacity(std::size_t i) const { return read<float>(layout_.opacities, i); }

    [[nodiscard]] bool isSame(const PageReader& other, std::size_t i) const {
        const auto equal = [&](std::uint64_t array, std::uint64_t bytes) {
            return std::memcmp(bytes_ + array + i * bytes, other.bytes_ + array + i * bytes, bytes) == 0;
        };
        return equal(layout_.positions, sizeof(glm::vec3)) && equal(layout_.rotations, sizeof(glm::vec4)) &&
               equal(layout_.scales, sizeof(glm::vec2)) && (!has_thicknesses_ || equal(layout_.thicknesses, sizeof(float))) &&
               equal(layout_.opacities, sizeof(float)) && equal(layout_.base_colours, sizeof(glm::uvec2)) &&
               equal(layout_.sh, layout_.sh_bytes_per_splat);
    }

private:
    template <typename T>
    [[nodiscard]] T read(std::uint64_t array, std::size_t i) const {
        T value;
        std::memcpy(&value, bytes_ + array + i * sizeof(T), sizeof(T));
        return value;
    }

    const std::uint8_t* bytes_;
    const ChunkLayout& layout_;
    bool has_thicknesses_;
};

bool isSamePage(const SplatPage& a, const SplatPage& b) { return a.splats == b.splats && a.bytes == b.bytes; }

template <typename T>
T at(const std::vector<std::uint8_t>& bytes, std::uint64_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

SplatPage pageBetween(const SplatPage& from, const SplatPage& to, float share, const ChunkLayout& layout, const SceneTraits& traits) {
    SplatPage page{from.splats, {}, from.bytes};
    const auto put = [&]<typename T>(std::uint64_t offset, const T& value) { std::memcpy(page.bytes.data() + offset, &value, sizeof(T)); };
    // Equal values stay as they are, to the bit.
    const auto mixFloats = [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t offset = begin; offset < end; offset += sizeof(float)) {
            const auto a = at<float>(from.bytes, offset), b = at<float>(to.bytes, offset);
            if (a != b) { put(offset, glm::mix(a, b, share)); }
        }
    };
    mixFloats(layout.positions, layout.rotations);
    mixFloats(layout.scales, layout.base_colours);
    for (std::uint64_t offset = layout.rotations; offset < layout.scales; offset += sizeof(glm::vec4)) {
        const auto a = at<glm::vec4>(from.bytes, offset), b = at<glm::vec4>(to.bytes, offset);
        if (a == b) { continue; }
        const glm::vec4 mixed = glm::mix(a, glm::dot(a, b) < 0.0f ? -b : b, share);
        const float length = glm::length(mixed);
        put(offset, length > 0.0f ? mixed / length : a);
    }
    for (std::uint64_t offset = layout.base_colours; offset < layout.bytes; offset += sizeof(std::uint32_t)) {
        const auto a = at<std::uint32_t>(from.bytes, offset), b = at<std::uint32_t>(to.bytes, offset);
        if (a != b) { put(offset, glm::packHalf2x16(glm::mix(glm::unpackHalf2x16(a), glm::unpackHalf2x16(b), share))); }
    }
    PageBounds bounds;
    const PageReader reader(page, layout, traits);
    for (std::size_t i = 0; i < page.splats; ++i) { bounds.add(reader.centre(i), reader.rotation(i), reader.scales(i), reader.opacity(i)); }
    page.bounds = bounds.page();
    return page;
}

// Boxes around what changed, by where the splats' centres lie.
class BoxGrid {
public:
    void add(const PageReader& reader, std::size_t i) {
        const float opacity = reader.opacity(i);
        if (!(opacity >= gpu::kMinAlpha)) { return; }
        const glm::vec3 centre = reader.centre(i), half(halfExtentOf(reader.rotation(i), reader.scales(i), opacity));
        boxes_.push_back({{centre - half, centre + half, std::min(opacity, 1.0f)}, centre});
        low_ = glm::min(low_, centre);
        high_ = glm::max(high_, centre);
    }

    [[nodiscard]] std::vector<SceneChange> gathered() const {
        std::array<std::optional<SceneChange>, kMostBoxes> cells;
        const glm::vec3 size = glm::max(high_ - low_, glm::vec3(std::numeric_limits<float>::min()));
        for (const Box& box : boxes_) {
            const glm::vec3 place = glm::clamp((box.centre - low_) / size, 0.0f, 1.0f) * static_cast<float>(kBoxesAside);
            const glm::ivec3 cell = glm::min(glm::ivec3(place), kBoxesAside - 1);
            std::optional<SceneChange>& all = cells[static_cast<std::size_t>((cell.z * kBoxesAside + cell.y) * kBoxesAside + cell.x)];
            if (!all) { all = box.change; }
            all->low = glm::min(all->low, box.change.low);
            all->high = glm::max(all->high, box.change.high);
            all->amount = std::max(all->amount, box.change.amount);
        }
        std::vector<SceneChange> changes;
        for (const std::optional<SceneChange>& change : cells) {
            if (change) { changes.push_back(*change); }
        }
        return changes;
    }

private:
    struct Box {
        SceneChange change;
        glm::vec3 centre;
    };
    std::vector<Box> boxes_;
    glm::vec3 low_{std::numeric_limits<float>::infinity()}, high_{-std::numeric_limits<float>::infinity()};
};

}  // namespace

SceneFrame makeSceneFrame(const Scene& scene, const SceneTraits& traits, const SceneFrame& like) {
    const PackedPages packed(scene, traits);
    const std::size_t page_bytes = ChunkLayout(kSplatsAPage, traits).bytes;
    SceneFrame frame;
    for (std::size_t p = 0; p < packed.pageCount(); ++p) {
        const auto splats = static_cast<std::uint32_t>(std::min<std::size_t>(kSplatsAPage, packed.splatCount() - p * kSplatsAPage));
        const auto bytes = packed.bytes().subspan(p * page_bytes, page_bytes);
        const bool is_there = p < like.size() && like[p]->splats == splats && std::ranges::equal(like[p]->bytes, bytes);
        frame.push_back(is_there ? like[p]
                                 : std::make_shared<const SplatPage>(SplatPage{splats, packed.pages()[p], {bytes.begin(), bytes.end()}}));
    }
    return frame;
}

std::uint64_t splatsIn(const SceneFrame& frame) {
    std::uint64_t splats = 0;
    for (const auto& page : frame) { splats += page->splats; }
    return splats;
}

std::uint64_t bytesIn(const SceneFrame& frame, const SceneFrame& without) {
    std::uint64_t bytes = 0;
    for (std::size_t p = 0; p < frame.size(); ++p) {
        if (p >= without.size() || without[p] != frame[p]) { bytes += frame[p]->bytes.size(); }
    }
    return bytes;
}

bool correspond(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits) {
    const std::uint64_t splats = splatsIn(from);
    if (splats != splatsIn(to) || splats == 0) { return false; }
    constexpr std::uint64_t kSamples = 1009;
    const ChunkLayout layout(kSplatsAPage, traits);
    const auto centreOf = [&](const SceneFrame& frame, std::uint64_t splat) {
        return PageReader(*frame[splat / kSplatsAPage], layout, traits).centre(splat % kSplatsAPage);
    };
    std::vector<float> moved, apart;
    for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
        const std::uint64_t splat = sample * splats / kSamples, other = (splat + splats / 2 + 97 * sample) % splats;
        moved.push_back(glm::distance(centreOf(from, splat), centreOf(to, splat)));
        apart.push_back(glm::distance(centreOf(from, splat), centreOf(from, other)));
    }
    // All but a few: a splat that turns up elsewhere is seen to fly there.
    const auto at = [](std::vector<float>& values, double share) {
        const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::ranges::nth_element(values, place);
        return static_cast<double>(*place);
    };
    return at(moved, 0.9) <= kNearbyShare * at(apart, 0.5);
}

SceneFrame between(const SceneFrame& from, const SceneFrame& to, float share, const SceneTraits& traits) {
    const ChunkLayout layout(kSplatsAPage, traits);
    SceneFrame frame = from;
    for (std::size_t p = 0; p < frame.size(); ++p) {
        if (from[p] == to[p] || isSamePage(*from[p], *to[p])) { continue; }
        frame[p] = std::make_shared<const SplatPage>(pageBetween(*from[p], *to[p], share, layout, traits));
    }
    return frame;
}

FrameDifference differenceOf(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits) {
    const ChunkLayout layout(kSplatsAPage, traits);
    FrameDifference difference;
    BoxGrid boxes;
    for (std::size_t p = 0; p < std::max(from.size(), to.size()); ++p) {
        const SplatPage* const old = p < from.size() ? from[p].get() : nullptr;
        const SplatPage* const now = p < to.size() ? to[p].get() : nullptr;
        if (old == now || (old != nullptr && now != nullptr && isSamePage(*old, *now))) { continue; }
        difference.pages.push_back(static_cast<std::uint32_t>(p));
        for (std::size_t i = 0; i < kSplatsAPage; ++i) {
            const bool was = old != nullptr && i < old->splats, is = now != nullptr && i < now->splats;
            if (was && is && PageReader(*old, layout, traits).isSame(PageReader(*now, layout, traits), i)) { continue; }
            if (was) { boxes.add(PageReader(*old, layout, traits), i); }
            if (is) { boxes.add(PageReader(*now, layout, traits), i); }
        }
    }
    difference.changes = boxes.gathered();
    return difference;
}

}  // namespace binosplat
