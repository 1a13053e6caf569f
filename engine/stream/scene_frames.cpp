// Handles splats page by page, as bytes.
#include "engine/stream/scene_frames.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace binosplat {
namespace {

constexpr std::size_t kSplatsAPage = gpu::kPageSplats;

// Splats of a page of the same traits, one by one.
class PageReader {
public:
    PageReader(std::span<const std::uint8_t> page, const ChunkLayout& layout, const SceneTraits& traits)
        : bytes_(page.data()), layout_(layout), has_thicknesses_(traits.isGaussian3d()) {}

    [[nodiscard]] glm::vec3 centre(std::size_t i) const { return read<glm::vec3>(layout_.positions, i); }
    [[nodiscard]] glm::quat rotation(std::size_t i) const {
        const auto q = read<glm::vec4>(layout_.rotations, i);
        return {q.w, q.x, q.y, q.z};
    }
    [[nodiscard]] glm::vec3 scales(std::size_t i) const {
        return {read<glm::vec2>(layout_.scales, i),
                has_thicknesses_ ? read<float>(layout_.thicknesses, i) : 0.0f};
    }
    [[nodiscard]] float opacity(std::size_t i) const { return read<float>(layout_.opacities, i); }

    [[nodiscard]] bool isSame(const PageReader& other, std::size_t i) const {
        const auto equal = [&](std::uint64_t array, std::uint64_t bytes) {
            return std::memcmp(bytes_ + array + i * bytes, other.bytes_ + array + i * bytes, bytes) == 0;
        };
        return equal(layout_.positions, sizeof(glm::vec3)) && equal(layout_.rotations, sizeof(glm::vec4)) &&
               equal(layout_.scales, sizeof(glm::vec2)) &&
               (!has_thicknesses_ || equal(layout_.thicknesses, sizeof(float))) &&
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

bool isSame(const PackedPages& a, const PackedPages& b) {
    return a.splatCount() == b.splatCount() &&
           std::memcmp(a.bytes().data(), b.bytes().data(), a.bytes().size()) == 0;
}

template <typename T>
T at(std::span<const std::uint8_t> bytes, std::uint64_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

PackedPages pageBetween(const PackedPages& one, const PackedPages& other, float share,
                        const ChunkLayout& layout, const SceneTraits& traits) {
    const std::span<const std::uint8_t> from = one.bytes(), to = other.bytes();
    std::vector<std::uint8_t> bytes(from.begin(), from.end());
    const auto put = [&]<typename T>(std::uint64_t offset, const T& value) {
        std::memcpy(bytes.data() + offset, &value, sizeof(T));
    };
    // Equal values stay exactly as they are.
    const auto mixFloats = [&](std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t offset = begin; offset < end; offset += sizeof(float)) {
            const auto a = at<float>(from, offset), b = at<float>(to, offset);
            if (a != b) { put(offset, glm::mix(a, b, share)); }
        }
    };
    mixFloats(layout.positions, layout.rotations);
    mixFloats(layout.scales, layout.base_colours);
    for (std::uint64_t offset = layout.rotations; offset < layout.scales; offset += sizeof(glm::vec4)) {
        const auto a = at<glm::vec4>(from, offset), b = at<glm::vec4>(to, offset);
        if (a == b) { continue; }
        const glm::vec4 mixed = glm::mix(a, glm::dot(a, b) < 0.0f ? -b : b, share);
        const float length = glm::length(mixed);
        put(offset, length > 0.0f ? mixed / length : a);
    }
    for (std::uint64_t offset = layout.base_colours; offset < layout.bytes; offset += sizeof(std::uint32_t)) {
        const auto a = at<std::uint32_t>(from, offset), b = at<std::uint32_t>(to, offset);
        if (a != b) {
            put(offset, glm::packHalf2x16(glm::mix(glm::unpackHalf2x16(a), glm::unpackHalf2x16(b), share)));
        }
    }
    PageBounds bounds;
    const PageReader reader(bytes, layout, traits);
    for (std::size_t i = 0; i < one.splatCount(); ++i) {
        bounds.add(reader.centre(i), reader.rotation(i), reader.scales(i), reader.opacity(i));
    }
    return {one.splatCount(), bounds.page(), std::move(bytes)};
}

// Boxes around what changed, based on where the splats' centres are.
class BoxGrid {
public:
    void add(const PageReader& reader, std::size_t i) {
        const float opacity = reader.opacity(i);
        if (!(opacity >= gpu::kMinAlpha)) { return; }
        const glm::vec3 centre = reader.centre(i),
                        half(halfExtentOf(reader.rotation(i), reader.scales(i), opacity));
        boxes_.push_back({{centre - half, centre + half, std::min(opacity, 1.0f)}, centre});
        low_ = glm::min(low_, centre);
        high_ = glm::max(high_, centre);
    }

    [[nodiscard]] std::vector<SceneChange> gathered() const {
        std::array<std::optional<SceneChange>, kMostBoxes> cells;
        const glm::vec3 size = glm::max(high_ - low_, glm::vec3(std::numeric_limits<float>::min()));
        for (const Box& box : boxes_) {
            const glm::vec3 place =
                glm::clamp((box.centre - low_) / size, 0.0f, 1.0f) * static_cast<float>(kBoxesAside);
            const glm::ivec3 cell = glm::min(glm::ivec3(place), kBoxesAside - 1);
            std::optional<SceneChange>& all =
                cells[static_cast<std::size_t>((cell.z * kBoxesAside + cell.y) * kBoxesAside + cell.x)];
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

SceneFrame makeSceneFrame(const Scene& scene, const SceneTraits& traits) {
    SceneFrame frame;
    for (std::size_t first = 0; first < scene.size(); first += kSplatsAPage) {
        frame.emplace_back(scene, first, std::min(kSplatsAPage, scene.size() - first), traits);
    }
    return frame;
}

std::uint64_t splatsIn(const SceneFrame& frame) {
    return frame.empty() ? 0 : (frame.size() - 1) * kSplatsAPage + frame.back().splatCount();
}

std::uint64_t bytesIn(const SceneFrame& frame) {
    return frame.empty() ? 0 : frame.size() * frame.front().bytes().size();
}

bool correspond(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits) {
    const std::uint64_t splats = splatsIn(from);
    if (splats != splatsIn(to) || splats == 0) { return false; }
    constexpr std::uint64_t kSamples = 1009;
    const ChunkLayout layout(kSplatsAPage, traits);
    const auto centreOf = [&](const SceneFrame& frame, std::uint64_t splat) {
        return PageReader(frame[splat / kSplatsAPage].bytes(), layout, traits).centre(splat % kSplatsAPage);
    };
    std::vector<float> moved, apart;
    for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
        const std::uint64_t splat = sample * splats / kSamples,
                            other = (splat + splats / 2 + 97 * sample) % splats;
        moved.push_back(glm::distance(centreOf(from, splat), centreOf(to, splat)));
        apart.push_back(glm::distance(centreOf(from, splat), centreOf(from, other)));
    }
    // All but a few: a splat that appears elsewhere would be seen flying there.
    const auto at = [](std::vector<float>& values, double share) {
        const auto place =
            values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::ranges::nth_element(values, place);
        return static_cast<double>(*place);
    };
    return at(moved, 0.9) <= kNearbyShare * at(apart, 0.5);
}

FrameStep stepBetween(const SceneFrame& from, const SceneFrame& to, const SceneTraits& traits,
                      const SceneFrame* next, float share) {
    const ChunkLayout layout(kSplatsAPage, traits);
    const bool is_between = next != nullptr && correspond(to, *next, traits);
    FrameStep step{splatsIn(to), {}, {}, {}};
    BoxGrid boxes;
    for (std::size_t p = 0; p < std::max(from.size(), to.size()); ++p) {
        const PackedPages* const old = p < from.size() ? &from[p] : nullptr;
        const PackedPages* now = p < to.size() ? &to[p] : nullptr;
        PackedPages mixed;
        if (now != nullptr && is_between && !isSame(*now, (*next)[p])) {
            mixed = pageBetween(*now, (*next)[p], share, layout, traits);
            now = &mixed;
        }
        if (old != nullptr && now != nullptr && isSame(*old, *now)) { continue; }
        step.pages.push_back(static_cast<std::uint32_t>(p));
        const auto readerOf = [&](const PackedPages* page) {
            return PageReader(page == nullptr ? std::span<const std::uint8_t>() : page->bytes(), layout,
                              traits);
        };
        const PageReader was_there = readerOf(old), is_there = readerOf(now);
        for (std::size_t i = 0; i < kSplatsAPage; ++i) {
            const bool was = old != nullptr && i < old->splatCount(),
                       is = now != nullptr && i < now->splatCount();
            if (was && is && was_there.isSame(is_there, i)) { continue; }
            if (was) { boxes.add(was_there, i); }
            if (is) { boxes.add(is_there, i); }
        }
        if (now != nullptr) { step.now.push_back(now == &mixed ? std::move(mixed) : *now); }
    }
    step.changes = boxes.gathered();
    return step;
}

}  // namespace binosplat
