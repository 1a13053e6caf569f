// Brings in, fades and removes parts.
#include "engine/stream/shown_leaves.h"

#include <algorithm>
#include <utility>

namespace binosplat {

ShownLeaves::ShownLeaves(const Context& context, const SceneTraits& traits,
                         const ResidentScene::Options& options, std::span<const LodLeaf> leaves)
    : resident_(context, traits, options),
      tree_(leaves),
      leaves_(leaves.size()),
      wanted_(leaves.size(), LevelChoices::kNone) {}

void ShownLeaves::want(const std::vector<std::uint32_t>& levels) {
    splats_wanted_ = 0;
    for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) {
        if (std::exchange(wanted_[leaf], levels[leaf]) != levels[leaf] && !leaves_[leaf].empty()) {
            changing_.insert(leaf);
        }
        if (levels[leaf] != LevelChoices::kNone) { splats_wanted_ += splatsOf(leaf, levels[leaf]); }
    }
}

bool ShownLeaves::add(LoadedPart& part) {
    const auto [leaf, level] = part.at;
    std::vector<Shown>& shown = leaves_[leaf];
    const bool is_wanted = wanted_[leaf] == level || (shown.empty() && wanted_[leaf] != LevelChoices::kNone);
    if (!is_wanted || has(part.at)) { return true; }
    if (part.pages.pageCount() > resident_.freePages()) { reserve(); }
    if (part.pages.pageCount() > resident_.freePages() && wanted_[leaf] == level && shown.size() == 1) {
        // As a last resort, when nothing else can go, not even the part being replaced can stay until then.
        const std::uint64_t own_pages =
            (splatsOf(leaf, shown.front().level) + gpu::kPageSplats - 1) / gpu::kPageSplats;
        if (part.pages.pageCount() <= resident_.freePages() + own_pages) { remove(leaf, shown.begin()); }
    }
    const float fade = shown.empty() ? 1.0f : 0.0f;
    const std::optional<ResidentScene::Part> added = resident_.add(std::move(part.pages), fade);
    if (!added) { return false; }
    ++part_count_;
    shown.push_back({level, *added, fade});
    if (shown.size() > 1) { changing_.insert(leaf); }
    return true;
}

void ShownLeaves::remove(std::uint32_t leaf, std::vector<Shown>::iterator shown) {
    resident_.remove(shown->part);
    leaves_[leaf].erase(shown);
    --part_count_;
}

std::vector<ShownLeaves::Shown>::iterator ShownLeaves::goalOf(std::uint32_t leaf) {
    std::vector<Shown>& shown = leaves_[leaf];
    if (wanted_[leaf] == LevelChoices::kNone) { return shown.end(); }
    const auto wanted = std::ranges::find(shown, wanted_[leaf], &Shown::level);
    if (wanted != shown.end()) { return wanted; }
    return std::ranges::max_element(shown, {}, &Shown::fade);
}

bool ShownLeaves::stepLeaf(std::uint32_t leaf, float share, bool at_once) {
    std::vector<Shown>& shown = leaves_[leaf];
    const auto goal = goalOf(leaf);
    const auto setFade = [&](Shown& one, float fade) {
        one.fade = fade;
        resident_.setFade(one.part, fade);
    };
    if (goal != shown.end()) {
        if (!at_once && !resident_.isInPlace(goal->part)) { return true; }
        if (goal->fade < 1.0f) { setFade(*goal, std::min(1.0f, goal->fade + share)); }
        if (goal->fade < 1.0f) { return true; }
    }
    const std::uint32_t stays = goal != shown.end() ? goal->level : LevelChoices::kNone;
    for (std::size_t i = shown.size(); i-- > 0;) {
        Shown& one = shown[i];
        if (one.level == stays) { continue; }
        setFade(one, std::max(0.0f, one.fade - share));
        if (one.fade == 0.0f) { remove(leaf, shown.begin() + static_cast<std::ptrdiff_t>(i)); }
    }
    return shown.size() > (stays != LevelChoices::kNone ? 1u : 0u);
}

void ShownLeaves::step(float share) {
    std::erase_if(changing_, [&](std::uint32_t leaf) { return !stepLeaf(leaf, share, false); });
}

void ShownLeaves::exchangeAtOnce() {
    std::erase_if(changing_, [&](std::uint32_t leaf) { return !stepLeaf(leaf, 1.0f, true); });
}

void ShownLeaves::flush(const Context& context) {
    Commands commands(context);
    while (resident_.hasChanges()) {
        commands.begin();
        resident_.recordChanges(commands);
        commands.submitAndWait();
    }
}

void ShownLeaves::reserve() {
    for (const std::uint32_t leaf : changing_) {
        std::vector<Shown>& shown = leaves_[leaf];
        const auto goal = goalOf(leaf);
        if (goal != shown.end() && goal->fade < 1.0f) { continue; }
        const std::uint32_t stays = goal != shown.end() ? goal->level : LevelChoices::kNone;
        for (std::size_t i = shown.size(); i-- > 0;) {
            if (shown[i].level != stays) { remove(leaf, shown.begin() + static_cast<std::ptrdiff_t>(i)); }
        }
    }
}

bool ShownLeaves::has(LeafLevel at) const {
    return std::ranges::find(leaves_[at.leaf], at.level, &Shown::level) != leaves_[at.leaf].end();
}

bool ShownLeaves::isTooFine(std::uint32_t leaf) const {
    if (wanted_[leaf] == LevelChoices::kNone) { return false; }
    return std::ranges::any_of(leaves_[leaf], [&](const Shown& one) { return one.level < wanted_[leaf]; });
}

std::vector<std::uint64_t> ShownLeaves::loadedLevels() const {
    std::vector<std::uint64_t> loaded(leaves_.size(), 0);
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
        for (const Shown& one : leaves_[leaf]) { loaded[leaf] |= std::uint64_t{1} << one.level; }
    }
    return loaded;
}

std::uint64_t ShownLeaves::splatsThere() const {
    std::uint64_t sum = 0;
    for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) {
        if (wanted_[leaf] != LevelChoices::kNone && has({leaf, wanted_[leaf]})) {
            sum += splatsOf(leaf, wanted_[leaf]);
        }
    }
    return sum;
}

}  // namespace binosplat
