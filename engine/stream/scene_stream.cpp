// Turns what the eyes see into requests, and brings what the loader has read to the device.
#include "engine/stream/scene_stream.h"

#include "engine/error.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace binosplat {

namespace {

constexpr std::uint64_t kPageSplats = gpu::kPageSplats;
// Bytes of splats uploaded in one frame: for a headset, or if the next frame is not urgent, as on a software
// device.
constexpr std::uint64_t kBytesAFrame = std::uint64_t{8} << 20, kBytesAPicture = std::uint64_t{128} << 20;
constexpr std::chrono::milliseconds kLook(50);

std::uint64_t pagesOf(std::uint64_t splats) { return (splats + kPageSplats - 1) / kPageSplats; }

// Of all chunks of the coarsest levels, which are needed first anyway, and of one chunk of each other level.
SceneTraits traitsOf(ChunkSource& source, const StreamSettings& settings) {
    std::set<std::size_t> files;
    std::set<std::uint32_t> levels;
    for (const LodLeaf& leaf : source.leaves()) {
        files.insert(leaf.levels.back().file);
        for (const LodRange& range : leaf.levels) {
            if (levels.insert(range.level).second) { files.insert(range.file); }
        }
    }
    const std::vector<std::size_t> all(files.begin(), files.end());
    source.expect(all);
    bool any = false, discs = true, antialiased = settings.antialiased;
    int sh_degree = 0;
    std::optional<Error> trouble;
    for (const std::size_t file : all) {
        try {
            const SogSplats splats = source.open(file);
            any = true;
            discs = discs && splats.discs();
            antialiased = antialiased || splats.antialiased();
            sh_degree = std::max(sh_degree, splats.shDegree());
        } catch (const Error& error) { trouble = error; }
    }
    if (!any && trouble) { throw *trouble; }
    SceneTraits traits;
    traits.sh_degree = std::min(sh_degree, settings.sh_degree.value_or(kMaxShDegree));
    if (!discs && !settings.flatten) {
        traits.splat_kind = gpu::kGaussians;
        traits.is_dimmed = antialiased;
    }
    return traits;
}

bool isSame(const LevelQuestion& a, const LevelQuestion& b) {
    const auto are_alike = [](const Eye& one, const Eye& other) {
        const auto key = [](const Eye& eye) {
            const Intrinsics& k = eye.intrinsics;
            const Pose& pose = eye.world_from_camera;
            return std::tuple(pose.position, pose.orientation, k.fx, k.fy, k.cx, k.cy, eye.size_px);
        };
        return key(one) == key(other);
    };
    return a.settings == b.settings && a.there == b.there && std::ranges::equal(a.eyes, b.eyes, are_alike);
}

// On the loader's threads.
void pack(LoadedPart& part, const SceneTraits& traits) {
    if (!traits.isGaussian3d()) { part.scene.thicknesses.clear(); }
    part.pages = PackedPages(part.scene, traits);
    part.scene = {};
}

}  // namespace

SceneStream::SceneStream(const Context& context, std::unique_ptr<ChunkSource> source, StreamSettings settings)
    : context_(context), settings_(std::move(settings)) {
    const std::span<const LodLeaf> tree = source->leaves();
    const SceneTraits traits = traitsOf(*source, settings_);
    // Never more memory than the finest level of all leaves needs or, if a budget is given, than the budget
    // needs. A share of the pages is for exchanges, at least enough for the largest part.
    std::uint64_t most_pages = 0, largest = 1;
    for (const LodLeaf& leaf : tree) {
        std::uint64_t pages = 0;
        for (const LodRange& range : leaf.levels) { pages = std::max(pages, pagesOf(range.splats.count)); }
        most_pages += pages;
        largest = std::max(largest, pages);
    }
    if (settings_.splat_budget > 0) {
        most_pages = std::min(most_pages, pagesOf(settings_.splat_budget) + tree.size());
    }
    std::uint64_t memory_bytes = settings_.memory_bytes;
    if (memory_bytes == 0) {
        memory_bytes = context.deviceMemoryBytes() / 2;
        if (context.memoryLimitBytes() > 0) {
            memory_bytes = std::min(memory_bytes, context.memoryLimitBytes() / 5 * 2);
        }
    }
    page_bytes_ = ChunkLayout(kPageSplats, traits).bytes + sizeof(gpu::SceneChunk) + sizeof(gpu::ScenePage);
    const std::uint64_t affordable =
        std::min<std::uint64_t>(memory_bytes / page_bytes_, gpu::kMaxItems / kPageSplats);
    const std::uint64_t wished = most_pages + std::max(largest, most_pages / 8);
    const std::uint64_t capacity = std::max<std::uint64_t>(std::min(affordable, wished), 1);
    choice_.pages =
        affordable >= wished
            ? most_pages
            : std::max<std::uint64_t>(capacity - std::min(capacity / 2, std::max(largest, capacity / 8)), 1);
    choice_.page_splats = gpu::kPageSplats;
    choice_.splats = settings_.splat_budget > 0 ? settings_.splat_budget : ~std::uint64_t{0};
    choice_.look_ahead_rad = settings_.look_ahead_rad;
    ResidentScene::Options options;
    options.capacity_pages = static_cast<std::uint32_t>(capacity);
    bytes_a_frame_ = settings_.pictures || context.isSoftware() ? kBytesAPicture : kBytesAFrame;
    options.most_bytes_a_frame = bytes_a_frame_;
    leaves_ = std::make_unique<ShownLeaves>(context, traits, options, tree);
    settings_.loader.finish = [traits](LoadedPart& part) { pack(part, traits); };
    loader_ = std::make_unique<ChunkLoader>(std::move(source), settings_.loader);
}

std::uint64_t SceneStream::mostSplats() const {
    std::uint64_t finest = 0;
    for (const LodLeaf& leaf : source().leaves()) { finest += leaf.levels.front().splats.count; }
    return std::min(finest, choice_.pages * kPageSplats);
}

void SceneStream::setSplatBudget(std::uint64_t splats) { choice_.splats = splats; }

std::vector<LeafLevel> SceneStream::missing(const std::vector<LeafLevel>& chosen) const {
    std::vector<LeafLevel> wishes;
    std::ranges::copy_if(chosen, std::back_inserter(wishes), [&](LeafLevel at) {
        return !leaves_->has(at) && std::ranges::find(held_, at, &LoadedPart::at) == held_.end();
    });
    return wishes;
}

void SceneStream::wish(Waits waits, bool coarsest_only) {
    std::vector<LeafLevel> coarsest, finer;
    // A leaf that already shows something does not need a coarse level first.
    std::ranges::copy_if(chosen_.coarsest, std::back_inserter(coarsest), [&](LeafLevel at) {
        return leaves_->isEmpty(at.leaf) || chosen_.levels[at.leaf] == at.level;
    });
    if (!coarsest_only) {
        finer = chosen_.finer;
        // Leaves that will have fewer splats make space for the others.
        std::ranges::stable_partition(finer, [&](LeafLevel at) { return leaves_->isTooFine(at.leaf); });
    }
    has_wishes_ = !loader_->want(missing(coarsest), missing(finer), waits);
}

void SceneStream::takeLoaded(bool at_once) {
    const auto take = [&](LoadedPart& part) {
        const bool taken = leaves_->add(part);
        if (taken && at_once) { leaves_->exchangeAtOnce(); }
        return taken;
    };
    const auto takeHeld = [&] {
        for (std::size_t i = 0; i < held_.size();) {
            if (take(held_[i])) {
                held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(i));
                i = at_once ? 0 : i;  // it may have made space for an earlier one
            } else {
                ++i;
            }
        }
    };
    takeHeld();
    for (LoadedPart& part : loader_->take(at_once ? Waits::kBriefly : Waits::kNever)) {
        if (take(part)) {
            if (at_once) { takeHeld(); }
        } else {
            held_.push_back(std::move(part));
        }
    }
}

void SceneStream::update(std::span<const Eye> eyes, double step_seconds) {
    if (!planner_) {
        planner_.emplace([chooser = LevelChooser(source().leaves())](const LevelQuestion& question) mutable {
            return chooser.choose(question.eyes, question.settings, question.there);
        });
    }
    if (std::optional<LevelChoices> answer = planner_->take()) {
        chosen_ = std::move(*answer);
        answered_ = true;
        leaves_->want(chosen_.levels);
        has_wishes_ = true;
    }
    if (!chosen_.levels.empty()) {
        takeLoaded(false);
        leaves_->step(
            static_cast<float>(settings_.fade_seconds > 0.0 ? step_seconds / settings_.fade_seconds : 1.0));
        if (has_wishes_) { wish(Waits::kNever); }
    }
    ask(eyes);
}

void SceneStream::ask(std::span<const Eye> eyes) {
    const std::optional<std::vector<bool>> broken = loader_->brokenFiles(Waits::kNever);
    if (!broken) { return; }
    LevelQuestion question{{eyes.begin(), eyes.end()}, choice_, {}};
    if (std::ranges::find(*broken, true) != broken->end()) {
        question.there = {*broken, leaves_->loadedLevels()};
    }
    if (asked_ && isSame(*asked_, question)) { return; }
    answered_ = false;
    if (planner_->ask(LevelQuestion(question))) { asked_ = std::move(question); }
}

// The rest comes with the next frame, which then knows where it is.
void SceneStream::flushIfMuch() {
    const ResidentScene& resident = leaves_->resident();
    const std::uint64_t waiting =
        resident.splatsAdded() - std::min(resident.splatsAdded(), resident.splatsShown());
    if (waiting * page_bytes_ / kPageSplats > bytes_a_frame_ / 2) { leaves_->flush(context_); }
}

void SceneStream::settleChosen(std::span<const Eye> eyes, bool coarsest_only, const Progress& progress) {
    if (!chooser_) { chooser_.emplace(source().leaves()); }
    std::optional<std::vector<bool>> broken;
    for (;;) {
        const std::optional<std::vector<bool>> now = loader_->brokenFiles(Waits::kBriefly);
        if (broken == now && loader_->isDone(Waits::kBriefly)) { break; }
        if (broken != now) {
            broken = now;
            chosen_ = chooser_->choose(eyes, choice_, {*broken, leaves_->loadedLevels()});
            leaves_->want(chosen_.levels);
            leaves_->exchangeAtOnce();
            wish(Waits::kBriefly, coarsest_only);
        }
        takeLoaded(true);
        flushIfMuch();
        if (progress) { progress(share()); }
        (void)loader_->waitForNews(kLook);
    }
    takeLoaded(true);
    flushIfMuch();
}

void SceneStream::settle(std::span<const Eye> eyes, const Progress& progress) {
    settleChosen(eyes, false, progress);
}

void SceneStream::settleCoarsest(std::span<const Eye> eyes, const Progress& progress) {
    settleChosen(eyes, true, progress);
}

bool SceneStream::isSettled() const {
    return answered_ && !has_wishes_ && held_.empty() && !leaves_->isExchanging() &&
           !leaves_->resident().hasChanges() && loader_->isDone(Waits::kNever);
}

double SceneStream::share() const {
    const std::uint64_t wanted = leaves_->splatsWanted();
    return wanted == 0 ? 0.0 : static_cast<double>(leaves_->splatsThere()) / static_cast<double>(wanted);
}

StreamCounters SceneStream::counters() const {
    const ResidentScene& resident = leaves_->resident();
    return {resident.splatsAdded(), resident.splatsShown(), leaves_->partCount(), 0, 0};
}

}  // namespace binosplat
