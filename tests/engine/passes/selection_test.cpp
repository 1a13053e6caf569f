// Facts about price and select: the choice of the most worthwhile tiles up to a budget, as in the twin, and
// the lists that patching uses.
#include "tests/engine/passes/choice_stages.h"

SUITE(selection) {

using reference::TileKind;

// Division may be wrong by a few roundings, so a price may be practically on the border between two bins.
bool isOnBorder(double steps, double cost) {
    if (steps < 1.0) { return false; }
    const double sixteenths = std::ldexp(steps / cost, 4 - std::ilogb(steps / cost));
    return std::abs(sixteenths - std::round(sixteenths)) < 1e-4;
}

// Random errors and costs of all sizes, some tiles marked.
Tiles drawTiles(glm::uvec2 size, std::mt19937& random, unsigned marked_percent = 10) {
    Tiles tiles(size);
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        if (random() % 100 < marked_percent) { tiles.kinds[t] = 1 + static_cast<gpu::uint>(random() % 5); }
        do {
            tiles.errors[t] = random() % 8 == 0 ? 0 : static_cast<gpu::uint>(random()) >> (1 + random() % 30);
            tiles.costs[t] = 16 + static_cast<gpu::uint>(random() % (random() % 2 == 0 ? 50 : 5000));
        } while (isOnBorder(tiles.errors[t], tiles.costs[t]));
    }
    return tiles;
}

Tiles drawHistory(glm::uvec2 size, std::mt19937& random) {
    Tiles drawn(size);
    const auto draw = [&] { return static_cast<float>(drawUnit(random)); };
    for (gpu::uint& kind : drawn.kinds) {
        gpu::HistoryTile tile{};
        tile.cost = static_cast<gpu::uint>(random() % 3 == 0 ? random() % 5000 : random() % 40);
        tile.age = static_cast<gpu::uint>(random() % (random() % 4 == 0 ? 500 : 6));
        const bool is_still = random() % 8 == 0;  // as in front of a head that keeps still
        for (int q = 0; q < 4; ++q) {
            tile.growth[q] = is_still || random() % 3 == 0 ? 0.0f : 0.02f * draw();
            tile.errors[q] = is_still || random() % 4 == 0 ? 0.0f : 0.2f * std::pow(draw(), 6.0f);
            tile.grown[q] =
                is_still || random() % 4 == 0 ? 0 : static_cast<gpu::uint>(random()) >> (4 + random() % 28);
            tile.unseen |= random() % 4 == 0 ? static_cast<gpu::uint>(random() % 65) << (8 * q) : 0;
        }
        // Up to 1.4 times what masks errors.
        tile.squared_gradient = static_cast<gpu::uint>(random() % 4'000'000);
        drawn.history.push_back(tile);
        kind = random() % 12 == 0 ? gpu::kTileHidden : 0;
    }
    return drawn;
}

// The lists and the mask must agree with the kinds, and with the counters if `counts`.
void checkLists(const Chosen& chosen, glm::uvec2 size, bool counts = true) {
    std::vector<gpu::uint> list;
    std::vector<std::uint8_t> marked;
    std::uint64_t cost = 0;
    for (std::size_t t = 0; t < chosen.kinds.size(); ++t) {
        marked.push_back(chosen.kinds[t] != 0 && chosen.kinds[t] != gpu::kTileHidden ? 1 : 0);
        if (marked.back() == 0) { continue; }
        list.push_back(static_cast<gpu::uint>(t));
        cost += chosen.costs[t];
    }
    CHECK(these(chosen.list, chosen.mask) == these(list, maskOf(marked, size)));
    const gpu::ListState& tiles = chosen.masked_tiles;
    CHECK(these(tiles.needed, tiles.count, tiles.groups_done) == these(list.size(), list.size(), 0u));
    CHECK(tiles.per_item.x * tiles.per_item.y * gpu::kGroupSize >= list.size());
    // If no tile is rendered, no splat is visited.
    const std::size_t visible = list.empty() ? 0 : kVisible;
    CHECK(these(chosen.masked_visible.count, chosen.masked_visible.per_item.x) ==
          these(visible, (visible + gpu::kGroupSize - 1) / gpu::kGroupSize));
    if (!counts) { return; }
    const auto countKind = [&](gpu::uint kind) { return std::ranges::count(chosen.kinds, kind); };
    const gpu::WarpCounters& counters = chosen.counters;
    CHECK(these(counters.chosen_cost, counters.predicted_tiles, counters.edge_tiles, counters.cheap_tiles) ==
          these(cost, countKind(gpu::kTilePredicted), countKind(gpu::kTileEdge), countKind(gpu::kTileCheap)));
}

// What the twin expects of an eye's tiles. Errors and prices are the device's, provided that they equal the
// twin's up to rounding.
struct Expected {
    std::vector<TileKind> kinds;
    std::vector<double> errors;
    std::vector<std::uint64_t> costs;
    std::vector<std::optional<std::uint32_t>> prices;
};
Expected expectOf(const Tiles& eye, const Chosen& got) {
    Expected expected{kindsOf(eye.kinds), {}, {eye.costs.begin(), eye.costs.end()}, {}};
    for (const gpu::uint error : eye.errors) { expected.errors.push_back(error / kErrorSteps); }
    std::vector<reference::HistoryTile> twin;
    for (const gpu::HistoryTile& tile : eye.history) { twin.push_back(tileOf(tile)); }
    reference::growErrors(twin);
    for (std::size_t t = 0; t < twin.size(); ++t) {
        const bool hidden = expected.kinds[t] == TileKind::kHidden;
        expected.costs[t] = hidden ? 0 : reference::costOf(twin[t]);
        REQUIRE(got.costs[t] == expected.costs[t]);
        const reference::HistoryTile tile = tileOf(got.history[t]);
        for (std::size_t q = 0; q < 4; ++q) { REQUIRE(isNear(tile.errors[q], twin[t].errors[q], 1e-6, 0.0)); }
        expected.errors[t] = hidden ? 0.0 : reference::worthOf(twin[t]);
        if (got.errors[t] == gpu::kSeenCoarsely) { continue; }
        const double error = got.errors[t] / kErrorSteps;
        REQUIRE(isNear(error, expected.errors[t], 1e-5, 1.0 / kErrorSteps));
        REQUIRE((error == 0.0) == (expected.errors[t] == 0.0));
        expected.errors[t] = error;
    }
    return expected;
}

// Adds the prices. For a tile that is practically on a border between prices, either bin is right, and the
// visible part of an error is not known to the last digit: returns how many are the twin's next ones.
std::size_t priceTiles(Expected& expected, const Chosen& got, const How& how) {
    std::vector<double> shares;
    if (how.gaze) {
        shares = reference::findSeenShares(how.seen, {how.gaze->direction, how.gaze->clear_rad});
    }
    expected.prices = reference::price(expected.kinds, expected.errors, expected.costs, shares);
    std::size_t rough = 0;
    for (std::size_t t = 0; t < expected.prices.size(); ++t) {
        std::optional<std::uint32_t>& price = expected.prices[t];
        if (!price) { continue; }
        if (how.error_bound > 0.0) {
            price = reference::priceUnderBound(*price, tileOf(got.history[t]), how.error_bound);
            continue;
        }
        const gpu::uint bin = got.prices[t] >> 22;
        const bool is_rough = how.gaze || isOnBorder(std::floor(expected.errors[t] * kErrorSteps),
                                                     static_cast<double>(expected.costs[t]));
        if (is_rough && std::max(bin, *price) - std::min(bin, *price) == 1) {
            price = bin;
            ++rough;
        }
    }
    return rough;
}

// Compares the choice among tiles with the twin's.
std::vector<Chosen> checkChoice(Gpu& gpu, const std::vector<Tiles>& eyes, const How& how) {
    INFO("budget ", how.budget, ", eyes.size ", eyes.size(), ", eyes[0].count ", eyes[0].count());
    std::vector<Chosen> got = chooseOnDevice(gpu, eyes, how);
    std::vector<Expected> expected;
    std::vector<gpu::uint> bins(gpu::kPriceBins, 0);
    std::uint64_t picture_cost = 0;
    std::size_t rough = 0;
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        Expected& its = expected.emplace_back(expectOf(eyes[e], got[e]));
        rough += priceTiles(its, got[e], how);
        std::vector<gpu::uint> words;
        for (std::size_t t = 0; t < its.costs.size(); ++t) {
            const auto cost = static_cast<gpu::uint>(its.costs[t]);
            picture_cost += cost;
            words.push_back(its.prices[t] ? *its.prices[t] << 22 | cost : 0);
            if (its.prices[t]) { bins[*its.prices[t]] += cost; }
        }
        if (!how.gaze) { CHECK(got[e].prices == words); }
    }
    if (!how.gaze) { CHECK(got[0].bins == bins); }
    CHECK(rough <= 1 + eyes[0].count() / 50);
    std::vector<reference::PricedTiles> priced;
    for (Expected& its : expected) { priced.push_back({its.kinds, its.prices, its.costs}); }
    if (eyes[0].history.empty()) {
        const auto budget_cost = static_cast<std::uint64_t>(how.budget * how.picture_cost);
        reference::select(expected[0].kinds, expected[0].prices, expected[0].costs, budget_cost);
    } else {
        CHECK(got[0].counters.picture_cost == picture_cost);
        auto budget_cost =
            static_cast<std::uint64_t>(static_cast<float>(how.budget) * static_cast<float>(picture_cost));
        if (how.error_bound > 0.0) {
            budget_cost = std::min<std::uint64_t>(
                reference::budgetUnderBound(priced, budget_cost, picture_cost), how.most_cost);
        }
        reference::selectTogether(priced, budget_cost);
    }
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::vector<gpu::uint> kinds = kindsOf(expected[e].kinds);
        std::size_t other = 0, waiting = 0;
        for (std::size_t t = 0; t < kinds.size(); ++t) {
            other += got[e].kinds[t] != kinds[t];
            waiting += expected[e].prices[t] >= reference::kOverPrice && kinds[t] == 0;
        }
        CHECK(other <= (how.gaze ? 1 + kinds.size() / 100 : 0));
        if (how.error_bound > 0.0) { CHECK(got[e].counters.waiting_tiles == waiting); }
        checkLists(got[e], eyes[e].size);
    }
    return got;
}

std::uint64_t costOfErrors(const Tiles& tiles) {
    std::uint64_t cost = 0;
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        cost += tiles.kinds[t] == 0 && tiles.errors[t] > 0 ? tiles.costs[t] : 0;
    }
    return cost;
}

TEST_CASE_FIXTURE(Gpu,
                  "price and select take the twin's tiles, however many, with budgets from none to all") {
    std::mt19937 random(7);
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(31, 1), glm::uvec2(127, 1), glm::uvec2(32, 4),
                                  glm::uvec2(3, 43), glm::uvec2(33, 31), glm::uvec2(100, 50)}) {
        const Tiles tiles = drawTiles(size, random);
        const std::uint64_t all = costOfErrors(tiles);
        if (all == 0) { continue; }
        for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{15}, std::uint64_t{40}, all / 7,
                                           all / 2, all - 1, all, all + 1, 2 * all + 1000}) {
            checkChoice(*this, {tiles}, withCost(std::min<std::uint64_t>(budget, kPictureCost - 1)));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "select takes the first of equal tiles to the last pair, and none without an error") {
    std::mt19937 random(8);
    for (const glm::uvec2 size : {glm::uvec2(20, 1), glm::uvec2(30, 20)}) {
        for (const unsigned values : {1u, 5u}) {
            // A hundred and one steps per pair, however many pairs: all in one bin.
            Tiles tiles(size);
            for (std::size_t t = 0; t < tiles.count(); ++t) {
                tiles.costs[t] = 16 + static_cast<gpu::uint>(random() % 40);
                tiles.errors[t] = static_cast<gpu::uint>(random() % (values + 1)) * 101 * tiles.costs[t];
            }
            const std::uint64_t all = costOfErrors(tiles);
            std::uint64_t first_three = 0;
            for (std::size_t t = 0, n = 0; n < 3; ++t) {
                if (tiles.errors[t] > 0) { first_three += tiles.costs[t], ++n; }
            }
            // Also just below and just above where one more fits.
            std::vector<std::uint64_t> budgets{first_three - 1, first_three, first_three + 1, all - 1, all};
            for (std::uint64_t budget = 0; budget <= all; budget += 1 + all / 7) {
                budgets.push_back(budget);
            }
            for (const std::uint64_t budget : budgets) { checkChoice(*this, {tiles}, withCost(budget)); }
        }
    }
    Tiles none({300, 1});
    checkChoice(*this, {none}, withCost(1000));
    none.errors.assign(300, 4300);
    checkChoice(*this, {none}, withCost(1999));
    checkChoice(*this, {none}, withCost(2000));
}

TEST_CASE_FIXTURE(Gpu, "price tells all prices apart, and takes sums that stopped growing for equal") {
    Tiles tiles({31, 8});
    for (std::size_t t = 0; t < tiles.count(); ++t) {
        const std::size_t bit = t % 31;
        tiles.errors[t] = (1u << bit) | (t / 31 % 2 == 0 ? 0u : (1u << bit) / 3);
        tiles.costs[t] = std::array{17u, 300u, 70001u, gpu::kMaxTileCost - 123456}[t / 62];
        while (isOnBorder(tiles.errors[t], tiles.costs[t])) { ++tiles.errors[t]; }
    }
    for (const std::uint64_t budget : {17, 1000, 200000, 10000000}) {
        checkChoice(*this, {tiles}, withCost(budget));
    }
    Tiles full({6, 1});
    full.errors = {5, 0x7fffffffu, 0xffffffffu, 0x80000000u, 0x7ffffffeu, 0x90000000u};
    for (const std::uint64_t budget : {100, 250, 300, 499, 600}) {
        checkChoice(*this, {full}, withCost(budget));
    }
}

TEST_CASE_FIXTURE(Gpu, "select pays from a share of the picture's cost, rounded down") {
    Tiles tiles({10, 1});
    tiles.errors.assign(10, 1000);
    // 0.15 in single precision is slightly more than that.
    for (const auto& [share, picture_cost, chosen] :
         {std::tuple(0.15, 2000u, 3), std::tuple(0.15, 1999u, 2), std::tuple(0.5, 2000u, 10),
          std::tuple(1.0, 1000u, 10), std::tuple(1.0, 999u, 9), std::tuple(0.0, 2000u, 0),
          std::tuple(1.0, 4000000000u, 10)}) {
        INFO("share ", share, ", picture cost ", picture_cost);
        const auto got = chooseOnDevice(*this, {tiles}, {.budget = share, .picture_cost = picture_cost});
        CHECK(got[0].counters.predicted_tiles == static_cast<gpu::uint>(chosen));
    }
}

TEST_CASE_FIXTURE(Gpu, "select lists the tiles that others marked, or all where nothing is worth moving") {
    std::mt19937 random(10);
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(64, 4), glm::uvec2(65, 40)}) {
        for (const unsigned percent : {0u, 3u, 50u, 100u}) {
            const Tiles tiles = drawTiles(size, random, percent);
            const Chosen marked = chooseOnDevice(*this, {tiles}, {.budget = 1.0, .predicted = false})[0];
            CHECK(marked.kinds == tiles.kinds);
            checkLists(marked, size, /*counts=*/false);
            const Chosen all = chooseOnDevice(*this, {tiles}, {.moves = false})[0];
            std::vector<gpu::uint> expected = tiles.kinds;
            std::ranges::replace(expected, 0u, gpu::kTileCheap);
            CHECK(all.kinds == expected);
            checkLists(all, size);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "price counts of an error what the twin's eye sees, wherever it looks") {
    const Eye eye{Pose{}, intrinsicsFromAngles({-0.9, 0.7, 0.8, -0.85}, {531, 777}), {531, 777}};
    std::mt19937 random(11);
    const Tiles tiles = drawTiles(tilesOf(eye.size_px), random);
    std::vector<double> errors;
    for (const gpu::uint error : tiles.errors) { errors.push_back(error / kErrorSteps); }
    const std::vector<std::uint64_t> costs(tiles.costs.begin(), tiles.costs.end());
    // The budget ends where it would if errors were seen whole.
    const std::vector<gpu::uint> bins = chooseOnDevice(*this, {tiles}, {})[0].bins;
    for (const Gaze& gaze :
         {Gaze{{0.0, 0.0, 1.0}, 0.0}, Gaze{{0.0, 0.0, 1.0}, 0.3}, Gaze{{-3.0, 1.0, 4.0}, 0.1},
          Gaze{{1.0, 0.0, 0.0}, 0.0}, Gaze{{0.0, 0.1, -1.0}, 0.0}}) {
        INFO("direction.x ", gaze.direction.x, ", clear ", gaze.clear_rad);
        const Chosen got = chooseOnDevice(*this, {tiles}, {.seen = eye, .gaze = gaze})[0];
        const auto shares = reference::findSeenShares(eye, {gaze.direction, gaze.clear_rad});
        const auto expected = reference::price(kindsOf(tiles.kinds), errors, costs, shares);
        CHECK(got.bins == bins);
        std::size_t priced = 0, other_bins = 0, unnoticed = 0, coarse = 0;
        for (std::size_t t = 0; t < expected.size(); ++t) {
            CHECK((got.prices[t] != 0) == expected[t].has_value());
            const bool is_coarse = got.errors[t] == gpu::kSeenCoarsely;
            CHECK((is_coarse || got.errors[t] == tiles.errors[t]));
            CHECK((is_coarse == (shares[t] <= 0.25) || std::abs(shares[t] - 0.25) < 1e-4));
            coarse += is_coarse;
            unnoticed += tiles.kinds[t] == 0 && tiles.errors[t] != 0 && got.prices[t] == 0;
            if (got.prices[t] == 0) { continue; }
            ++priced;
            const int off = static_cast<int>(got.prices[t] >> 22) - static_cast<int>(expected[t].value_or(0));
            CHECK(std::abs(off) <= 1);
            other_bins += off != 0;
        }
        CHECK(priced > 100);
        CHECK(unnoticed > 100);
        CHECK(coarse > 5);
        CHECK(other_bins <= 3);  // a place that rounds to the next bin
    }
}

TEST_CASE_FIXTURE(Gpu, "of tiles with a history, the twin's are taken for any budget, bound and gaze") {
    std::mt19937 random(11);
    for (const auto& [left, right] :
         {std::pair(glm::uvec2(1, 1), glm::uvec2(1, 1)), std::pair(glm::uvec2(16, 8), glm::uvec2(16, 8)),
          std::pair(glm::uvec2(43, 9), glm::uvec2(43, 9)), std::pair(glm::uvec2(20, 17), glm::uvec2(5, 3))}) {
        for (const double budget : {0.0, 0.001, 0.1, 0.3, 0.9, 1.0}) {
            checkChoice(*this, {drawHistory(left, random), drawHistory(right, random)}, {.budget = budget});
            checkChoice(*this, {drawHistory(left, random)}, {.budget = budget});
            checkChoice(*this, {drawHistory(left, random), drawHistory(right, random)},
                        {.budget = budget, .error_bound = 0.04});
        }
    }
    Eye eye = makeEye({43 * 16, 20 * 16});
    eye.intrinsics = intrinsicsFromFovX(glm::radians(90.0), eye.size_px);
    const Gaze gaze{glm::normalize(glm::dvec3(0.3, -0.1, 1.0)), 0.05};
    for (const double budget : {0.02, 0.2, 0.6, 1.0}) {
        checkChoice(*this, {drawHistory({43, 20}, random), drawHistory({43, 20}, random)},
                    {.budget = budget, .seen = eye, .gaze = gaze});
    }
}

TEST_CASE_FIXTURE(Gpu, "of equal tiles with a history the first are first, and a dear one has its turn") {
    gpu::HistoryTile plain{};
    plain.cost = 84;  // 100 including the cost of the tile itself
    plain.age = 1;
    plain.errors = gpu::vec4(0.1f);
    plain.squared_gradient = 3 * 256 << 14;  // an eighth in each channel of each pixel, which masks errors
    std::vector<Tiles> equal(2, Tiles({20, 10}));
    for (Tiles& tiles : equal) { tiles.history.assign(200, plain); }
    // The lists of both eyes.
    const auto chosen = [&](const std::vector<Tiles>& eyes, const How& how) {
        const auto got = checkChoice(*this, eyes, how);
        return std::tuple(got[0].list, got[1].list);
    };
    for (const double budget : {0.0, 0.01, 0.4975, 0.51, 1.0}) { chosen(equal, {.budget = budget}); }
    CHECK(chosen(equal, {.budget = 0.75}) == these(numbersUpTo(200), numbersUpTo(100)));
    std::vector<Tiles> dear = equal;
    dear[1].history[150].cost = 10000;
    dear[1].history[150].age = 60000;
    CHECK(chosen(dear, {.budget = 0.001}) == these(numbersUpTo(0), std::vector{150u}));
    // Under a bound, tiles that are good enough stay, except for a twentieth of the work, however large the
    // budget. What nobody saw before is rendered without a budget, as far as lists have capacity.
    std::vector<Tiles> bounded = equal;
    bounded[0].history[20].errors = gpu::vec4(0.01f, 0.11f, 0.01f, 0.01f);
    bounded[1].history[30].errors = bounded[1].history[40].errors = gpu::vec4(0.2f);
    bounded[1].history[40].unseen = 0x14141414;  // 20 pixels each
    How how{.budget = 1.0, .error_bound = 0.105};
    const auto has = [](const std::vector<gpu::uint>& list, gpu::uint tile) {
        return std::ranges::count(list, tile) == 1;
    };
    const auto [left, right] = chosen(bounded, how);
    CHECK((has(left, 20) && !has(left, 50) && has(right, 30) && has(right, 40)));
    CHECK(left.size() + right.size() == 3 + 20);
    // An error that contrast masks is visible where there is no contrast.
    std::vector<Tiles> smooth = bounded;
    smooth[0].history[50].squared_gradient = 0;
    CHECK(has(std::get<0>(chosen(smooth, how)), 50));
    how.budget = 0.0;
    CHECK(chosen(bounded, how) == these(numbersUpTo(0), std::vector{40u}));
    how.most_cost = 0;
    CHECK(chosen(bounded, how) == these(numbersUpTo(0), numbersUpTo(0)));
}

}  // SUITE(selection)
