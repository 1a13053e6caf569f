// Joins the tables of several scenes.
#include "engine/stream/placed_scenes.h"

#include "engine/error.h"
#include "engine/gpu/commands.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace binosplat {
namespace {

// Enough for some seconds of ten scenes in motion; older pictures are no longer of use.
constexpr std::size_t kMostChangesRemembered = 4096;
constexpr float kFar = std::numeric_limits<float>::infinity();

gpu::ScenePage nowhere() {
    return {.low = gpu::vec3(kFar), .reach = 0.0f, .high = gpu::vec3(-kFar), .count = 0};
}

void widen(gpu::ScenePage& all, const gpu::ScenePage& page) {
    all.low = glm::min(all.low, page.low);
    all.high = glm::max(all.high, page.high);
    all.count += page.count;
}

// The box around a box that is turned, moved and scaled.
gpu::ScenePage placedBox(const Similarity& target_from_source, const gpu::ScenePage& page) {
    if (page.count == 0) { return nowhere(); }
    const glm::dvec3 low(page.low), high(page.high), half = 0.5 * (high - low);
    const glm::dmat3 turn = glm::mat3_cast(target_from_source.orientation);
    const glm::dvec3 middle = transform(target_from_source, 0.5 * (low + high));
    const glm::dmat3 sizes(glm::abs(turn[0]), glm::abs(turn[1]), glm::abs(turn[2]));
    const glm::dvec3 reach = target_from_source.scale * (sizes * half);
    // The device's rounding as it places splats.
    const glm::dvec3 rounding = 1e-6 * (glm::abs(middle) + reach);
    return {.low = gpu::vec3(middle - reach - rounding),
            .reach = std::nextafter(static_cast<float>(target_from_source.scale * page.reach), kFar),
            .high = gpu::vec3(middle + reach + rounding),
            .count = page.count};
}

// Maps positions of the scene to those of all scenes.
Similarity allFrom(const PlacedScene& placed, const glm::dvec3& origin) {
    Similarity all = placed.world_from_scene;
    all.position = transform(placed.world_from_scene, placed.origin) - origin;
    return all;
}

}  // namespace

PlacedScenes::PlacedScenes(const Context& context, std::span<const PlacedScene> scenes)
    : placed_(scenes.begin(), scenes.end()) {
    check(!scenes.empty(), "there are no scenes to place");
    SceneTraits& traits = scene_.traits_;
    traits = scenes[0].scene->traits();
    origin_ = transform(scenes[0].world_from_scene, scenes[0].origin);
    std::size_t pages = 0;
    for (const PlacedScene& placed : scenes) {
        const SceneTraits& its = placed.scene->traits();
        check(its.splat_kind == traits.splat_kind && its.is_dimmed == traits.is_dimmed &&
                  its.is_light == traits.is_light,
              "scenes of one frame must be all discs, all Gaussians, or all Gaussians with antialiasing, and "
              "of colours encoded alike");
        traits.sh_degree = std::max(traits.sh_degree, its.sh_degree);
        if (its.usual_order == Order::kDistance) { traits.usual_order = Order::kDistance; }
        parts_.push_back(
            {.first_page = pages, .changes_known = placed.scene->changesRecorded(), .bounds = nowhere()});
        pages += placed.scene->table().chunks.size();
    }
    check(pages <= gpu::kMaxItems / gpu::kPageSplats,
          "scenes of one frame have {} pages of {} splats, at most {} can be shown", pages, gpu::kPageSplats,
          gpu::kMaxItems / gpu::kPageSplats);
    const std::size_t places = std::max<std::size_t>(pages, 1);
    scene_.table_.chunks.resize(places);
    scene_.table_.bounds.resize(places);
    scene_.chunk_table_ = Buffer(context, "placed pages' addresses", places * sizeof(gpu::SceneChunk));
    page_table_ = Buffer(context, "placed pages' bounds", places * sizeof(gpu::ScenePage));
    placements_ = Buffer(context, "placements", parts_.size() * sizeof(gpu::Placement));
    scene_.is_placed_ = true;
    scene_.splat_count_ = static_cast<std::uint32_t>(places * gpu::kPageSplats);
    scene_.chunk_bits_ = static_cast<std::uint32_t>(std::countr_zero(gpu::kPageSplats));
    scene_.chunk_count_ = places;
    scene_.chunks_ = scene_.chunk_table_.address<gpu::SceneChunk>();
    scene_.pages_ = page_table_.address<gpu::ScenePage>();
    scene_.bytes_ = scene_.chunk_table_.bytes() + page_table_.bytes() + placements_.bytes();
    scene_.record_changes_ = [this](Commands& commands) { recordChanges(commands); };
}

gpu::DeviceAddress<gpu::Placement> PlacedScenes::placementAt(std::size_t part) const {
    return placements_.address<gpu::Placement>(part * sizeof(gpu::Placement));
}

bool PlacedScenes::isOf(std::span<const PlacedScene> scenes) const {
    return std::ranges::equal(scenes, placed_, {}, &PlacedScene::scene, &PlacedScene::scene);
}

void PlacedScenes::place(std::span<const PlacedScene> scenes) {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        if (scenes[p].world_from_scene != placed_[p].world_from_scene ||
            scenes[p].is_shown != placed_[p].is_shown) {
            parts_[p].is_dirty = true;
        }
        placed_[p] = scenes[p];
    }
}

gpu::Placement PlacedScenes::placementOf(const PlacedScene& placed) const {
    const Similarity all = allFrom(placed, origin_);
    const glm::dmat3 turn = glm::mat3_cast(all.orientation);
    return {gpu::vec3(turn[0]), gpu::vec3(turn[1]), gpu::vec3(turn[2]), gpu::vec3(all.position),
            static_cast<float>(all.scale)};
}

void PlacedScenes::makePages(std::size_t index) {
    const PlacedScene& placed = placed_[index];
    const PageTable& table = placed.scene->table();
    const Similarity all = allFrom(placed, origin_);
    Part& part = parts_[index];
    part.bounds = nowhere();
    for (std::size_t i = 0; i < table.chunks.size(); ++i) {
        gpu::SceneChunk& chunk = scene_.table_.chunks[part.first_page + i];
        gpu::ScenePage& page = scene_.table_.bounds[part.first_page + i];
        chunk = table.chunks[i];
        chunk.placement = placementAt(index);
        page = placed.is_shown ? placedBox(all, table.bounds[i]) : nowhere();
        widen(part.bounds, page);
    }
}

void PlacedScenes::noteChanges(std::size_t index) {
    Part& part = parts_[index];
    const GpuScene& scene = *placed_[index].scene;
    if (part.changes_known == scene.changesRecorded()) { return; }
    if (const auto changes = scene.changesSince(part.changes_known); changes && !part.is_dirty) {
        for (const SceneChange& change : *changes) {
            const gpu::ScenePage box =
                placedBox(allFrom(placed_[index], origin_), {change.low, 0.0f, change.high, 1});
            scene_.changes_.push_back({box.low, box.high, change.amount});
        }
        makePages(index);
    } else {
        part.is_dirty = true;
    }
    part.changes_known = scene.changesRecorded();
}

void PlacedScenes::recordChanges(Commands& commands) {
    if (scene_.changes_.size() > kMostChangesRemembered) {
        const std::size_t forgotten = scene_.changes_.size() / 2;
        scene_.changes_forgotten_ += forgotten;
        scene_.changes_.erase(scene_.changes_.begin(),
                              scene_.changes_.begin() + static_cast<std::ptrdiff_t>(forgotten));
    }
    std::vector<bool> differs(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const std::uint64_t before = parts_[p].changes_known;
        noteChanges(p);
        differs[p] = parts_[p].is_dirty || parts_[p].changes_known != before;
        if (!parts_[p].is_dirty) { continue; }
        const gpu::ScenePage before_it = parts_[p].bounds;
        makePages(p);
        const gpu::ScenePage& now = parts_[p].bounds;
        for (const gpu::ScenePage& box : {before_it, now}) {
            if (box.count > 0) { scene_.changes_.push_back({box.low, box.high, 1.0f}); }
        }
        const gpu::Placement placement = placementOf(placed_[p]);
        commands.update(placements_, &placement, sizeof(placement), p * sizeof(placement));
        parts_[p].is_dirty = false;
    }
    std::uint64_t held = 0, pages_held = 0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const std::size_t first = parts_[p].first_page, pages = placed_[p].scene->table().chunks.size();
        if (differs[p] && pages > 0) {
            commands.update(scene_.chunk_table_, &scene_.table_.chunks[first],
                            pages * sizeof(gpu::SceneChunk), first * sizeof(gpu::SceneChunk));
            commands.update(page_table_, &scene_.table_.bounds[first], pages * sizeof(gpu::ScenePage),
                            first * sizeof(gpu::ScenePage));
        }
        if (!placed_[p].is_shown) { continue; }
        held += placed_[p].scene->splatsHeld();
        pages_held += pages;
    }
    scene_.splats_held_ = scene_.splats_coming_ =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(held, gpu::kMaxItems));
    scene_.pages_held_ = static_cast<std::uint32_t>(pages_held);
}

}  // namespace binosplat
