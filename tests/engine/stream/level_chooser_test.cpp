// What leaves of a streamed scene are to show: by size and place, within a budget, and steadily.
#include "engine/stream/level_chooser.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

TEST_SUITE_BEGIN("level_chooser");

namespace level_chooser_test {

using namespace binosplat;

namespace {

constexpr std::uint32_t kNone = LevelChoices::kNone;

// Cubes of a metre side by side on the plane y = 0, x from -n/2 to n/2 and z from 0 to n: level k has `splats` / 4^k splats, in file k.
std::vector<LodLeaf> makeField(int n, std::uint32_t levels = 4, std::uint64_t splats = 16384) {
    std::vector<LodLeaf> leaves;
    for (int z = 0; z < n; ++z) {
        for (int x = 0; x < n; ++x) {
            const glm::vec3 low(static_cast<float>(x - n / 2), 0.0f, static_cast<float>(z));
            LodLeaf leaf{low, low + 1.0f, {}};
            for (std::uint32_t level = 0; level < levels; ++level) {
                const std::uint64_t count = splats >> (2 * level);
                leaf.levels.push_back({level, level, {static_cast<std::uint64_t>(leaves.size()) * count, count}});
            }
            leaves.push_back(std::move(leaf));
        }
    }
    return leaves;
}

// 90 degrees wide and high, a thousand pixels.
Eye eyeAt(const glm::dvec3& position, double yaw_rad = 0.0) {
    const glm::dquat turn = glm::angleAxis(yaw_rad, glm::dvec3(0.0, 1.0, 0.0));
    return {{turn, position}, {500.0, 500.0, 500.0, 500.0}, {1000, 1000}};
}

const LevelChoices& choose(LevelChooser& chooser, const Eye& eye, const ChoiceSettings& settings, const LevelsThere& there = {}) {
    return chooser.choose(std::span(&eye, 1), settings, there);
}

ChoiceSettings within(std::uint64_t splats) {
    ChoiceSettings settings;
    settings.splats = splats;
    settings.pages = ~std::uint64_t{0};
    return settings;
}

std::uint64_t splatsOf(const std::vector<LodLeaf>& leaves, const std::vector<std::uint32_t>& levels) {
    std::uint64_t sum = 0;
    for (std::size_t l = 0; l < leaves.size(); ++l) { sum += levels[l] == kNone ? 0 : leaves[l].levels[levels[l]].splats.count; }
    return sum;
}

}  // namespace

TEST_CASE("the coarsest level of every leaf comes first, the nearest in view before the others") {
    const std::vector<LodLeaf> leaves = makeField(8);
    LevelChooser chooser(leaves);
    const LevelChoices& choices = choose(chooser, eyeAt({0.5, 0.5, -1.0}), within(1 << 18));
    REQUIRE(choices.coarsest.size() == leaves.size());
    std::set<std::uint32_t> seen;
    for (const LeafLevel& one : choices.coarsest) {
        CHECK(one.level == 3);
        seen.insert(one.leaf);
    }
    CHECK(seen.size() == leaves.size());
    CHECK(choices.coarsest.front().leaf == 4);  // straight ahead
    CHECK(choices.finer.front().leaf == 4);
    CHECK(choices.finer.front().level == 0);
    for (const LeafLevel& one : choices.finer) { CHECK(choices.levels[one.leaf] == one.level); }
}

TEST_CASE("the budget is kept and used, whatever it is") {
    const std::vector<LodLeaf> leaves = makeField(8);
    const std::uint64_t coarsest = leaves.size() * leaves.front().levels.back().splats.count;
    for (const std::uint64_t budget : {coarsest, 2 * coarsest, 100'000ul, 300'000ul, 1'000'000ul}) {
        CAPTURE(budget);
        LevelChooser chooser(leaves);
        const LevelChoices& choices = choose(chooser, eyeAt({0.5, 0.5, -0.5}), within(budget));
        CHECK(choices.splats <= budget);
        CHECK(choices.splats == splatsOf(leaves, choices.levels));
        if (budget <= 300'000) { CHECK(choices.splats > 0.9 * static_cast<double>(budget)); }
        CHECK(choices.coarsest.size() == leaves.size());
    }
    LevelChooser chooser(leaves);
    const LevelChoices& few = choose(chooser, eyeAt({0.5, 0.5, -0.5}), within(10 * leaves.front().levels.back().splats.count));
    CHECK(few.coarsest.size() == 10);
    CHECK(std::ranges::count(few.levels, kNone) == 54);
    CHECK(few.levels[4] == 3);
    // Pages count likewise: a level of one splat takes a whole one.
    ChoiceSettings pages = within(1 << 24);
    pages.pages = 70;
    CHECK(choose(chooser, eyeAt({0.5, 0.5, -0.5}), pages).pages <= 70);
}

TEST_CASE("nearer leaves show more, and splats that would lie closer than half a pixel are not asked for") {
    const std::vector<LodLeaf> leaves = makeField(64, 6);
    LevelChooser chooser(leaves);
    const LevelChoices& choices = choose(chooser, eyeAt({0.5, 0.5, -1.0}), within(1 << 24));
    std::uint32_t before = 0;
    for (std::size_t z = 0; z < 64; ++z) {
        const std::uint32_t level = choices.levels[z * 64 + 32];
        CHECK(level >= before);
        before = level;
        if (z < 2) { continue; }
        // The step that was not taken would have led to less than half a pixel, the last one that was did not.
        const double size_px = 500.0 * std::sqrt(3.0) / (static_cast<double>(z) + 1.0 + 0.25 * std::sqrt(3.0));
        const auto apart = [&](std::uint32_t a, std::uint32_t b) {
            const auto& levels = leaves[z * 64 + 32].levels;
            return size_px / std::pow(static_cast<double>(levels[a].splats.count) * static_cast<double>(levels[b].splats.count), 0.25);
        };
        if (level > 0) { CHECK(apart(level, level - 1) < 0.5); }
        if (level < 5) { CHECK(apart(level + 1, level) >= 0.5); }
    }
    CHECK(choices.levels[32] == 0);
    CHECK(before > 0);
}

TEST_CASE("what lies behind is the first to go and the last to come") {
    const std::vector<LodLeaf> leaves = makeField(16);
    LevelChooser chooser(leaves);
    const glm::dvec3 middle(0.5, 0.5, 8.5);
    const auto sums = [&](const LevelChoices& choices) {
        std::array<std::uint64_t, 2> sum{};  // before and behind
        for (std::size_t l = 0; l < leaves.size(); ++l) {
            sum[leaves[l].low.z < 8.0f ? 1 : 0] += leaves[l].levels[choices.levels[l]].splats.count;
        }
        return sum;
    };
    const auto ahead = sums(choose(chooser, eyeAt(middle), within(300'000)));
    CHECK(ahead[0] > 4 * ahead[1]);
    const auto turned = sums(choose(chooser, eyeAt(middle, std::numbers::pi), within(300'000)));
    CHECK(turned[1] > turned[0]);
    CHECK(2 * turned[0] < ahead[0]);
    // To the eyes' right, beyond the edge, there is more than behind.
    const LevelChoices& choices = choose(chooser, eyeAt({-7.5, 0.5, 8.5}, -0.5 * std::numbers::pi / 2.0), within(300'000));
    CHECK(choices.splats <= 300'000);
}

TEST_CASE("a head that trembles changes nothing") {
    const std::vector<LodLeaf> leaves = makeField(16);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> tremor(-1.0, 1.0);
    for (const std::uint64_t budget : {60'000ul, 200'000ul, 10'000'000ul}) {
        LevelChooser chooser(leaves);
        const std::vector<std::uint32_t> at_rest = choose(chooser, eyeAt({0.3, 0.5, 2.0}), within(budget)).levels;
        CHECK(choose(chooser, eyeAt({0.3, 0.5, 2.0}), within(budget)).levels == at_rest);
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 position = glm::dvec3(0.3, 0.5, 2.0) + 0.01 * glm::dvec3(tremor(random), tremor(random), tremor(random));
            CHECK(choose(chooser, eyeAt(position, 0.01 * tremor(random)), within(budget)).levels == at_rest);
        }
    }
}

TEST_CASE("a slow walk changes the level of a leaf once each time it comes nearer") {
    const std::vector<LodLeaf> leaves = makeField(24, 6);
    LevelChooser chooser(leaves);
    std::vector<std::uint32_t> before = choose(chooser, eyeAt({0.5, 0.5, -30.0}), within(1 << 24)).levels;
    std::size_t changes = 0;
    for (int step = 0; step < 320; ++step) {
        const std::vector<std::uint32_t> now = choose(chooser, eyeAt({0.5, 0.5, -30.0 + 0.05 * step}), within(1 << 24)).levels;
        for (std::size_t l = 0; l < leaves.size(); ++l) {
            CHECK(now[l] <= before[l]);  // finer, or as it was: none has left the view
            changes += now[l] != before[l];
        }
        before = now;
    }
    CHECK(changes > leaves.size() / 4);
    CHECK(changes <= 2 * leaves.size());
}

TEST_CASE("levels in broken files are passed over, unless they are loaded") {
    const std::vector<LodLeaf> leaves = makeField(2);
    const Eye eye = eyeAt({0.0, 0.5, -1.0});
    LevelChooser chooser(leaves);
    CHECK(choose(chooser, eye, within(1 << 20)).levels == std::vector<std::uint32_t>(4, 0));
    LevelsThere there{{true, false, false, false}, {}};
    CHECK(choose(chooser, eye, within(1 << 20), there).levels == std::vector<std::uint32_t>(4, 1));
    there.loaded = {0, 1};
    CHECK(choose(chooser, eye, within(1 << 20), there).levels == std::vector<std::uint32_t>{1, 0, 1, 1});
    there = {{false, false, false, true}, {}};
    const LevelChoices& without_coarsest = choose(chooser, eye, within(1 << 20), there);
    CHECK(without_coarsest.levels == std::vector<std::uint32_t>(4, 0));
    CHECK(without_coarsest.coarsest.front().level == 2);
    there.broken.assign(4, true);
    CHECK(choose(chooser, eye, within(1 << 20), there).levels == std::vector<std::uint32_t>(4, kNone));
}

TEST_CASE("leaves of odd shape, count and place are no trouble") {
    std::vector<LodLeaf> leaves{
        {glm::vec3(0), glm::vec3(0), {{0, 0, {0, 1}}}},
        {glm::vec3(-1e6f), glm::vec3(1e6f), {{0, 1, {0, 100}}}},
        {glm::vec3(1), glm::vec3(2), {{0, 0, {1, 5}}, {1, 2, {0, 5}}, {2, 3, {0, 9}}}},  // coarser levels have no fewer
        {glm::vec3(3e38f), glm::vec3(3e38f), {{0, 0, {6, 1ull << 40}}, {1, 2, {5, 1}}}}};
    LevelChooser chooser(leaves);
    const LevelChoices& choices = choose(chooser, eyeAt(glm::dvec3(0.0)), within(1000));
    CHECK(choices.levels == std::vector<std::uint32_t>{0, 0, 0, 1});
    CHECK(choices.splats == 107);
    CHECK(choose(chooser, eyeAt(glm::dvec3(0.0)), within(0)).levels == std::vector<std::uint32_t>(4, kNone));
    LevelChooser nothing(std::span<const LodLeaf>{});
    CHECK(choose(nothing, eyeAt(glm::dvec3(0.0)), within(1000)).levels.empty());
}

}  // namespace level_chooser_test
