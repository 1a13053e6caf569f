// Facts about the radix sort, held against std::stable_sort at every size that crosses a boundary.
#include "engine/passes/sort.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

TEST_SUITE_BEGIN("sort");

namespace sort_test {

using namespace binosplat;
using test::Gpu;

namespace {

using Keys = std::vector<std::uint32_t>;

// What lies in memory that a sort must leave alone.
constexpr std::uint32_t kUntouched = 0xdeadbeefu;

std::uint32_t maskOf(unsigned key_bits) { return key_bits == 32 ? UINT32_MAX : (1u << key_bits) - 1; }

// The indices of `keys` by their lowest `key_bits` bits, equal keys in the order they came.
Keys stableOrder(const Keys& keys, unsigned key_bits) {
    Keys order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::uint32_t mask = maskOf(key_bits);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return (keys[a] & mask) < (keys[b] & mask); });
    return order;
}

enum Pattern : int { kRandom, kAllEqual, kFewDistinct, kAscending, kDescending, kExtremes, kPatternCount };

Keys makeKeys(Pattern pattern, std::size_t size, unsigned key_bits, unsigned seed) {
    std::mt19937 random(seed);
    Keys keys(size);
    const auto top = maskOf(key_bits);
    for (std::size_t i = 0; i < size; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
        switch (pattern) {
            case kAllEqual:
                keys[i] = 0x5a5a5a5au;
                break;
            case kFewDistinct:
                keys[i] = 0x01010101u * static_cast<std::uint32_t>(random() % 5);
                break;
            case kAscending:
                keys[i] = static_cast<std::uint32_t>(share * top);
                break;
            case kDescending:
                keys[i] = static_cast<std::uint32_t>((1.0 - share) * top);
                break;
            case kExtremes:
                keys[i] = random() % 2 == 0 ? 0u : UINT32_MAX;
                break;
            // The bits above the key's are there to be ignored.
            default:
                keys[i] = static_cast<std::uint32_t>(random());
        }
    }
    return keys;
}

// Several lists in one buffer, each with room for one key more, which the sort must not touch.
struct Batch {
    std::vector<Keys> lists;
    unsigned key_bits;

    // How many lists come out wrong, the first of them told.
    [[nodiscard]] int countWrong(Gpu& gpu, const Sort& sort) const {
        Keys keys, values;
        std::vector<gpu::ListState> states;
        std::vector<std::size_t> begins;
        std::size_t longest = 0;
        for (const Keys& list : lists) {
            begins.push_back(keys.size());
            states.push_back(test::makeList(list.size()));
            keys.insert(keys.end(), list.begin(), list.end());
            values.resize(keys.size());
            std::iota(values.end() - static_cast<std::ptrdiff_t>(list.size()), values.end(), 0u);
            keys.push_back(kUntouched);
            values.push_back(kUntouched);
            longest = std::max(longest, list.size());
        }
        const Keys blank(keys.size(), kUntouched);
        const Buffer key_buffer = gpu.upload("keys", keys), value_buffer = gpu.upload("values", values);
        const Buffer spare_keys = gpu.upload("spare keys", blank), spare_values = gpu.upload("spare values", blank);
        const Buffer state_buffer = gpu.upload("lists", states);
        const Buffer histograms(gpu.context(), "histograms", Sort::histogramBytes(longest));
        bool in_spare = false;
        gpu.run([&](Commands& commands) {
            for (std::size_t i = 0; i < lists.size(); ++i) {
                const auto at = [&](const Buffer& buffer) { return buffer.address<gpu::uint>(begins[i] * sizeof(gpu::uint)); };
                const KeyValues sorted = sort.record(commands, {at(key_buffer), at(value_buffer)}, {at(spare_keys), at(spare_values)},
                                                     histograms.address<gpu::uint>(), state_buffer, i * sizeof(gpu::ListState), key_bits);
                in_spare = sorted.keys.value == at(spare_keys).value;
            }
        });
        const Keys sorted_keys = gpu.readBack<std::uint32_t>(in_spare ? spare_keys : key_buffer, keys.size());
        const Keys sorted_values = gpu.readBack<std::uint32_t>(in_spare ? spare_values : value_buffer, keys.size());
        int wrong = 0;
        for (std::size_t i = 0; i < lists.size(); ++i) {
            const Keys order = stableOrder(lists[i], key_bits);
            bool right = sorted_keys[begins[i] + order.size()] == kUntouched && sorted_values[begins[i] + order.size()] == kUntouched;
            for (std::size_t k = 0; k < order.size(); ++k) {
                right = right && sorted_values[begins[i] + k] == order[k] && sorted_keys[begins[i] + k] == lists[i][order[k]];
            }
            if (!right && wrong++ == 0) { MESSAGE("first wrong list: number " << i << ", of " << order.size() << " keys"); }
        }
        return wrong;
    }
};

// Every way of matching digits that the device can take: real GPUs have wide subgroups and take ballots, software devices compare.
std::vector<DigitMatch> matches(const Context& context) {
    std::vector<DigitMatch> ways{DigitMatch::kBallots};
    if (Sort::hasNarrowSubgroups(context)) { ways.push_back(DigitMatch::kComparisons); }
    return ways;
}

}  // namespace

TEST_CASE("the order that sorts are held against is right on a case done by hand") {
    CHECK(stableOrder({3, 1, 2, 1, 3, 0}, 32) == Keys{5, 1, 3, 2, 0, 4});
    // By the lowest bit alone: 2, 0 (even), then 3, 1, 1, 3.
    CHECK(stableOrder({3, 1, 2, 1, 3, 0}, 1) == Keys{2, 5, 0, 1, 3, 4});
    CHECK(stableOrder({}, 32).empty());
}

TEST_CASE_FIXTURE(Gpu, "lists of every size from 0 to 600 are sorted, whatever the bits of their keys") {
    for (const DigitMatch match : matches(context())) {
        CAPTURE(match);
        const Sort sort(context(), match);
        for (const unsigned key_bits : {32u, 14u, 12u, 8u, 1u}) {
            CAPTURE(key_bits);
            Batch batch{{}, key_bits};
            for (unsigned size = 0; size <= 600; ++size) { batch.lists.push_back(makeKeys(kRandom, size, key_bits, size)); }
            CHECK(batch.countWrong(*this, sort) == 0);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "equal, few, ascending, descending and extreme keys are sorted at sizes round a block") {
    for (const DigitMatch match : matches(context())) {
        CAPTURE(match);
        const Sort sort(context(), match);
        for (const unsigned key_bits : {32u, 14u, 12u, 8u, 1u}) {
            CAPTURE(key_bits);
            Batch batch{{}, key_bits};
            for (const unsigned size :
                 {1u, 2u, 127u, 129u, gpu::kSortBlock - 1, gpu::kSortBlock, gpu::kSortBlock + 1, 2 * gpu::kSortBlock + 3}) {
                for (int pattern = 0; pattern < kPatternCount; ++pattern) {
                    batch.lists.push_back(makeKeys(static_cast<Pattern>(pattern), size, key_bits, size));
                }
            }
            CHECK(batch.countWrong(*this, sort) == 0);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "lists round 2^17 keys are sorted") {
    for (const DigitMatch match : matches(context())) {
        CAPTURE(match);
        const Sort sort(context(), match);
        Batch batch{{}, 32};
        for (const std::size_t size : {(1u << 17) - 1, 1u << 17, (1u << 17) + 1}) { batch.lists.push_back(makeKeys(kRandom, size, 32, 7)); }
        // More blocks than one step of the spine takes.
        for (const Pattern pattern : {kAllEqual, kFewDistinct, kDescending}) {
            batch.lists.push_back(makeKeys(pattern, (1u << 17) + 1, 32, 7));
        }
        CHECK(batch.countWrong(*this, sort) == 0);
        batch.key_bits = 14;
        CHECK(batch.countWrong(*this, sort) == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "2^21 keys are sorted") {
    for (const DigitMatch match : matches(context())) {
        CAPTURE(match);
        const Sort sort(context(), match);
        CHECK(Batch{{makeKeys(kRandom, 1u << 21, 32, 8)}, 32}.countWrong(*this, sort) == 0);
        CHECK(Batch{{makeKeys(kRandom, 1u << 21, 12, 9)}, 12}.countWrong(*this, sort) == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "a list without room is as good as empty: its keys stay as they are") {
    const Sort sort(context());
    const Keys keys{5, 4, 3, 2, 1};
    const Buffer key_buffer = upload("keys", keys), values = upload("values", keys), spare_keys = upload("spare keys", keys),
                 spare_values = upload("spare values", keys);
    const Buffer lists = upload("lists", std::vector{test::makeList(5, 4)});
    const Buffer histograms(context(), "histograms", Sort::histogramBytes(5));
    run([&](Commands& commands) {
        sort.record(commands, {key_buffer.address<gpu::uint>(), values.address<gpu::uint>()},
                    {spare_keys.address<gpu::uint>(), spare_values.address<gpu::uint>()}, histograms.address<gpu::uint>(), lists, 0, 32);
    });
    CHECK(readBack<std::uint32_t>(key_buffer, 5) == keys);
    CHECK(readBack<std::uint32_t>(spare_keys, 5) == keys);
}

}  // namespace sort_test
