// Which levels the leaves of a streamed scene should show: by size and place, in a budget, without flicker.
#include "engine/stream/level_chooser.h"
#include "tests/suite.h"

SUITE(level_chooser) {

constexpr std::uint32_t kNone = LevelChoices::kNone;

// Cubes of a metre side by side on the plane y = 0, with x from -n/2 to n/2 and z from 0 to n: level k has
// `splats` / 4^k splats, in file k.
std::vector<LodLeaf> makeField(int n, std::uint32_t levels = 4, std::uint64_t splats = 16384) {
    std::vector<LodLeaf> leaves;
    for (int z = 0; z < n; ++z) {
        for (int x = 0; x < n; ++x) {
            const glm::vec3 low(static_cast<float>(x - n / 2), 0.0f, static_cast<float>(z));
            LodLeaf leaf{low, low + 1.0f, {}};
            for (std::uint32_t level = 0; level < levels; ++level) {
                const std::uint64_t count = splats >> (2 * level);
                leaf.levels.push_back(
                    {level, level, {static_cast<std::uint64_t>(leaves.size()) * count, count}});
            }
            leaves.push_back(std::move(leaf));
        }
    }
    return leaves;
}

// 90 degrees wide and high, with a thousand pixels.
Eye eyeAt(const glm::dvec3& position, double yaw_rad = 0.0) {
    const glm::dquat turn = glm::angleAxis(yaw_rad, glm::dvec3(0.0, 1.0, 0.0));
    return {{turn, position}, {500.0, 500.0, 500.0, 500.0}, {1000, 1000}};
}

// Where most look along the rows of leaves from.
const Eye kBefore = eyeAt({0.5, 0.5, -1.0});

// A chooser that owns its leaves.
struct Chooser {
    std::vector<LodLeaf> leaves;
    LevelChooser chooser{leaves};

    explicit Chooser(std::vector<LodLeaf> of) : leaves(std::move(of)) {}
    const LevelChoices& choose(const Eye& eye, std::uint64_t splats, const LevelsThere& there = {},
                               std::uint64_t pages = ~std::uint64_t{0}) {
        ChoiceSettings settings;
        settings.splats = splats;
        settings.pages = pages;
        return chooser.choose(std::span(&eye, 1), settings, there);
    }
    // The splats of the leaves for which this is false, and true.
    template <typename Is>
    [[nodiscard]] std::array<std::uint64_t, 2> splatsWhere(const LevelChoices& choices, const Is& is) const {
        std::array<std::uint64_t, 2> sum{};
        for (std::size_t l = 0; l < leaves.size(); ++l) {
            const std::uint32_t level = choices.levels[l];
            sum[is(leaves[l]) ? 1 : 0] += level == kNone ? 0 : leaves[l].levels[level].splats.count;
        }
        return sum;
    }
};

// How far apart in pixels splats lie between two levels of a leaf that is z metres behind the first.
double apartPx(const LodLeaf& leaf, std::size_t z, std::uint32_t a, std::uint32_t b) {
    const double size_px = 500.0 * std::sqrt(3.0) / (static_cast<double>(z) + 1.0 + 0.25 * std::sqrt(3.0));
    return size_px / std::pow(static_cast<double>(leaf.levels[a].splats.count) *
                                  static_cast<double>(leaf.levels[b].splats.count),
                              0.25);
}

TEST_CASE("the coarsest level of every leaf comes first, the nearest in view before the others") {
    Chooser field(makeField(8));
    const LevelChoices& choices = field.choose(kBefore, 1 << 18);
    REQUIRE(choices.coarsest.size() == field.leaves.size());
    std::set<std::uint32_t> seen;
    for (const LeafLevel& one : choices.coarsest) {
        CHECK(one.level == 3);
        seen.insert(one.leaf);
    }
    CHECK(seen.size() == field.leaves.size());
    CHECK(choices.coarsest.front().leaf == 4);  // straight ahead
    CHECK(choices.finer.front() == LeafLevel{4, 0});
    for (const LeafLevel& one : choices.finer) { CHECK(choices.levels[one.leaf] == one.level); }
}

TEST_CASE("the budget is kept and used, whatever it is") {
    const std::vector<LodLeaf> leaves = makeField(8);
    const Eye eye = eyeAt({0.5, 0.5, -0.5});
    const std::uint64_t coarsest = leaves.size() * leaves.front().levels.back().splats.count;
    for (const std::uint64_t budget : {coarsest, 2 * coarsest, 100'000ul, 300'000ul, 1'000'000ul}) {
        CAPTURE(budget);
        Chooser field(leaves);
        const LevelChoices& choices = field.choose(eye, budget);
        CHECK(choices.splats <= budget);
        CHECK(choices.splats == field.splatsWhere(choices, [](const LodLeaf&) { return true; })[1]);
        if (budget <= 300'000) { CHECK(choices.splats > 0.9 * static_cast<double>(budget)); }
        CHECK(choices.coarsest.size() == leaves.size());
    }
    Chooser field(leaves);
    const LevelChoices& few = field.choose(eye, coarsest * 10 / 64);
    CHECK(these(few.coarsest.size(), std::ranges::count(few.levels, kNone), few.levels[4]) ==
          these(10, 54, 3));
    // Pages count in the same way: a level of one splat takes a whole page.
    CHECK(field.choose(eye, 1 << 24, {}, 70).pages <= 70);
}

TEST_CASE("nearer leaves show more, and splats that would lie closer than half a pixel are not asked for") {
    Chooser field(makeField(64, 6));
    const LevelChoices& choices = field.choose(kBefore, 1 << 24);
    std::uint32_t before = 0;
    for (std::size_t z = 0; z < 64; ++z) {
        const std::uint32_t level = choices.levels[z * 64 + 32];
        CHECK(level >= before);
        before = level;
        if (z < 2) { continue; }
        // The step that was not taken would have led below half a pixel; the last one that was taken did not.
        const LodLeaf& leaf = field.leaves[z * 64 + 32];
        if (level > 0) { CHECK(apartPx(leaf, z, level, level - 1) < 0.5); }
        if (level < 5) { CHECK(apartPx(leaf, z, level + 1, level) >= 0.5); }
    }
    CHECK(choices.levels[32] == 0);
    CHECK(before > 0);
}

TEST_CASE("levels that are off by more than 36 dB are chosen only where their splats are twice as close") {
    std::vector<LodLeaf> leaves = makeField(64, 6);
    const auto levelsOf = [&](const std::vector<float>& errors) {
        for (LodLeaf& leaf : leaves) { leaf.errors = errors; }
        return Chooser(leaves).choose(kBefore, 1 << 26).levels;
    };
    const std::vector<std::uint32_t> unknown = levelsOf({});
    // All are within 36 dB; or the second is, and no coarser one.
    CHECK(levelsOf({0.0f, 1e-5f, 2e-5f, 1e-4f, 2e-4f, 2.4e-4f}) == unknown);
    const std::vector<std::uint32_t> one = levelsOf({0.0f, 2e-4f, 3e-4f, 4e-4f, 5e-4f, 6e-4f});
    std::size_t finer = 0;
    for (std::size_t z = 0; z < 64; ++z) {
        const std::uint32_t level = one[z * 64 + 32], usual = unknown[z * 64 + 32];
        CHECK(level == within(std::min(usual, 1u), usual));
        finer += level < usual;
        if (level >= 2) { CHECK(apartPx(leaves[z * 64 + 32], z, level, level - 1) < 0.25); }
    }
    CHECK(finer > 0);
}

TEST_CASE("what lies behind is the first to go and the last to come") {
    Chooser field(makeField(16));
    // Splats in front of and behind somebody in the middle who looks that way.
    const auto look = [&](double yaw_rad) {
        const LevelChoices& choices = field.choose(eyeAt({0.5, 0.5, 8.5}, yaw_rad), 300'000);
        return field.splatsWhere(choices, [](const LodLeaf& leaf) { return leaf.low.z < 8.0f; });
    };
    const auto ahead = look(0.0), turned = look(std::numbers::pi);
    CHECK(ahead[0] > 4 * ahead[1]);
    CHECK(turned[1] > turned[0]);
    CHECK(2 * turned[0] < ahead[0]);
}

TEST_CASE("where it was measured what levels are off by, splats go to where they mend most") {
    const Eye inside = eyeAt({0.5, 0.5, 2.0});
    constexpr std::uint64_t kBudget = 8 * 16384;
    const auto isRight = [](const LodLeaf& leaf) { return leaf.low.x >= 0.0f; };
    const auto withErrors = [&](const std::vector<float>& left, const std::vector<float>& right) {
        std::vector<LodLeaf> leaves = makeField(4);
        for (LodLeaf& leaf : leaves) { leaf.errors = isRight(leaf) ? right : left; }
        return Chooser(leaves);
    };
    // As if each level's error were twice that of the next finer one, and ten times that on the right.
    const std::vector<float> doubling{0.0f, 0.001f, 0.002f, 0.004f};
    Chooser field = withErrors(doubling, {0.0f, 0.01f, 0.02f, 0.04f});
    const LevelChoices& choices = field.choose(inside, kBudget);
    const auto splats = field.splatsWhere(choices, isRight);
    CHECK(choices.splats <= kBudget);
    CHECK(splats[1] > 2 * splats[0]);
    // If they are the same everywhere, errors do not affect how levels depend on distance.
    const auto by_place = withErrors(doubling, doubling).choose(kBefore, kBudget).levels;
    for (std::size_t l = 4; l < by_place.size(); ++l) { CHECK(by_place[l] >= by_place[l - 4]); }
    // A level that improves nothing comes after all that do, and keeps none of them away.
    const std::vector<float> flat{0.0f, 0.001f, 0.001f, 0.001f};
    CHECK(withErrors(flat, flat).choose(inside, 1 << 24).levels == std::vector<std::uint32_t>(16, 0));
    // Nor does it keep a finer one away that mends more than elsewhere.
    Chooser stepped = withErrors(doubling, {0.0f, 0.03f, 0.03f, 0.031f});
    const LevelChoices& mended = stepped.choose(kBefore, kBudget);
    for (std::size_t l = 0; l < 16; ++l) {
        const LodLeaf& leaf = stepped.leaves[l];
        if (isRight(leaf) && leaf.low.z < 3.0f) { CHECK(mended.levels[l] == 0); }
    }
}

TEST_CASE("a head that trembles changes nothing") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> tremor(-0.01, 0.01);
    for (const std::uint64_t budget : {60'000ul, 200'000ul, 10'000'000ul}) {
        Chooser field(makeField(16));
        const glm::dvec3 place(0.3, 0.5, 2.0);
        const std::vector<std::uint32_t> at_rest = field.choose(eyeAt(place), budget).levels;
        CHECK(field.choose(eyeAt(place), budget).levels == at_rest);
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 moved(tremor(random), tremor(random), tremor(random));
            CHECK(field.choose(eyeAt(place + moved, tremor(random)), budget).levels == at_rest);
        }
    }
}

TEST_CASE("a slow walk changes the level of a leaf once each time it comes nearer") {
    Chooser field(makeField(24, 6));
    const auto levelsAt = [&](double z) { return field.choose(eyeAt({0.5, 0.5, z}), 1 << 24).levels; };
    std::vector<std::uint32_t> before = levelsAt(-30.0);
    const std::size_t leaves = before.size();
    std::size_t changes = 0, coarser = 0;
    for (int step = 0; step < 320; ++step) {
        const std::vector<std::uint32_t> now = levelsAt(-30.0 + 0.05 * step);
        for (std::size_t l = 0; l < leaves; ++l) {
            coarser += now[l] > before[l];
            changes += now[l] != before[l];
        }
        before = now;
    }
    CHECK(coarser == 0);  // none has left the view
    CHECK(changes > leaves / 4);
    CHECK(changes <= 2 * leaves);
}

TEST_CASE("levels in broken files are passed over, unless they are loaded") {
    using Levels = std::vector<std::uint32_t>;
    Chooser field(makeField(2));
    const auto choose = [&](const LevelsThere& there) -> const LevelChoices& {
        return field.choose(eyeAt({0.0, 0.5, -1.0}), 1 << 20, there);
    };
    CHECK(choose({}).levels == Levels(4, 0));
    CHECK(choose({{true, false, false, false}, {}}).levels == Levels(4, 1));
    CHECK(choose({{true, false, false, false}, {0, 1}}).levels == Levels{1, 0, 1, 1});
    CHECK(choose({{false, false, false, true}, {}}).levels == Levels(4, 0));
    CHECK(choose({{false, false, false, true}, {}}).coarsest.front().level == 2);
    CHECK(choose({{true, true, true, true}, {}}).levels == Levels(4, kNone));
}

TEST_CASE("leaves of odd shape, count and place are no trouble") {
    Chooser odd({{glm::vec3(0), glm::vec3(0), {{0, 0, {0, 1}}}},
                 {glm::vec3(-1e6f), glm::vec3(1e6f), {{0, 1, {0, 100}}}},
                 // Coarser levels do not have fewer splats.
                 {glm::vec3(1), glm::vec3(2), {{0, 0, {1, 5}}, {1, 2, {0, 5}}, {2, 3, {0, 9}}}},
                 {glm::vec3(3e38f), glm::vec3(3e38f), {{0, 0, {6, 1ull << 40}}, {1, 2, {5, 1}}}}});
    const Eye eye = eyeAt(glm::dvec3(0.0));
    const LevelChoices& choices = odd.choose(eye, 1000);
    CHECK(these(choices.levels, choices.splats) == these(std::vector<std::uint32_t>{0, 0, 0, 1}, 107));
    CHECK(odd.choose(eye, 0).levels == std::vector<std::uint32_t>(4, kNone));
    CHECK(Chooser({}).choose(eye, 1000).levels.empty());
}

}  // SUITE(level_chooser)
