// Facts about the radix sort at every size that crosses a boundary, and about sums by the last workgroup and
// their lists.
#include "engine/passes/sort.h"
#include "tests/engine/gpu/gpu_fixture.h"

SUITE(sort) {

using Values = std::vector<std::uint32_t>;

// Memory that a pass must not touch is filled with this.
constexpr std::uint32_t kUntouched = 0xdeadbeefu;

std::uint32_t maskOf(unsigned key_bits) { return key_bits == 32 ? UINT32_MAX : (1u << key_bits) - 1; }

// The indices of `keys` sorted by `key_bits` bits, the lowest or those from `first_bit` on, with equal keys
// in their original order.
Values stableOrder(const Values& keys, unsigned key_bits, unsigned first_bit = 0) {
    Values order = numbersUpTo(keys.size());
    std::ranges::stable_sort(order, {},
                             [&](std::uint32_t i) { return keys[i] >> first_bit & maskOf(key_bits); });
    return order;
}

enum Pattern : int { kRandom, kAllEqual, kFewDistinct, kAscending, kDescending, kExtremes, kPatternCount };

Values makeKeys(int pattern, std::size_t size, unsigned key_bits) {
    std::mt19937 random(static_cast<unsigned>(size));
    Values keys(size);
    for (std::size_t i = 0; i < size; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(size),
                     top = maskOf(key_bits);
        const auto drawn = static_cast<std::uint32_t>(random());
        // Bits above the key's must be ignored.
        const std::array<std::uint32_t, kPatternCount> of_patterns{
            drawn,
            0x5a5a5a5au,
            0x01010101u * (drawn % 5),
            static_cast<std::uint32_t>(share * top),
            static_cast<std::uint32_t>((1.0 - share) * top),
            drawn % 2 == 0 ? 0u : UINT32_MAX};
        keys[i] = of_patterns[static_cast<std::size_t>(pattern)];
    }
    return keys;
}

// All lists lie in one buffer, each with space for one more key.
void checkSort(Gpu& gpu, const Sort& sort, const std::vector<Values>& lists, unsigned key_bits) {
    KernelCache kernels(gpu.context(), sort.kernels());
    Values keys, values, sorted_keys, sorted_values;
    std::vector<gpu::ListState> states;
    std::vector<std::size_t> begins;
    std::size_t longest = 0;
    const auto append = [](Values& all, const Values& list) {
        all.insert(all.end(), list.begin(), list.end());
        all.push_back(kUntouched);
    };
    for (const Values& list : lists) {
        begins.push_back(keys.size());
        states.push_back(makeList(list.size()));
        longest = std::max(longest, list.size());
        append(keys, list);
        append(values, numbersUpTo(list.size()));
        Values order = stableOrder(list, key_bits);
        append(sorted_values, order);
        for (std::uint32_t& key : order) { key = list[key]; }
        append(sorted_keys, order);
    }
    const Values blank(keys.size(), kUntouched);
    const Buffer key_buffer = gpu.upload("keys", keys), value_buffer = gpu.upload("values", values),
                 spare_keys = gpu.upload("spare keys", blank),
                 spare_values = gpu.upload("spare values", blank), state_buffer = gpu.upload("lists", states),
                 histograms(gpu.context(), "histograms", Sort::histogramBytes(longest));
    const bool in_spare = KeyBits(key_bits).endInSpare();
    gpu.run([&](Commands& commands) {
        for (std::size_t i = 0; i < lists.size(); ++i) {
            const auto here = [&](const Buffer& buffer) {
                return buffer.address<gpu::uint>(begins[i] * sizeof(gpu::uint));
            };
            const KeyValues sorted = sort.record(kernels, commands, {here(key_buffer), here(value_buffer)},
                                                 {here(spare_keys), here(spare_values)}, at(histograms),
                                                 state_buffer, i * sizeof(gpu::ListState), key_bits);
            CHECK(sorted.keys.value == here(in_spare ? spare_keys : key_buffer).value);
        }
    });
    const auto findOther = [&](const Buffer& buffer, const Values& expected) {
        return std::ranges::mismatch(gpu.readBack<gpu::uint>(buffer, keys.size()), expected).in2 -
               expected.begin();
    };
    CHECK(findOther(in_spare ? spare_keys : key_buffer, sorted_keys) == std::ssize(keys));
    CHECK(findOther(in_spare ? spare_values : value_buffer, sorted_values) == std::ssize(keys));
}

// With every way to match digits that the device offers: real GPUs have wide subgroups and use ballots,
// software devices compare.
void checkSorted(Gpu& gpu, unsigned key_bits, const std::vector<std::size_t>& sizes,
                 const std::vector<int>& patterns) {
    std::vector<DigitMatch> ways{DigitMatch::kBallots};
    if (Sort::hasNarrowSubgroups(gpu.context())) { ways.push_back(DigitMatch::kComparisons); }
    std::vector<Values> lists;
    for (const std::size_t size : sizes) {
        for (const int pattern : patterns) { lists.push_back(makeKeys(pattern, size, key_bits)); }
    }
    for (const DigitMatch match : ways) {
        INFO("match ", match, ", key bits ", key_bits);
        checkSort(gpu, Sort(gpu.context(), match), lists, key_bits);
    }
}

// As tests/engine/passes/sum_up.comp reads it.
struct SumUpPass {
    gpu::DeviceAddress<gpu::uint> values, sums;
    gpu::DeviceAddress<gpu::ListState> result;
    gpu::uint count, capacity;
};

constexpr std::uint32_t kSumUpWords[] = {
#include "sum_up.inc"
};

struct Summed {
    Values sums;  // then the sums before each run, and what comes after
    gpu::ListState result;
};

Summed sumUp(Gpu& gpu, const Values& values, std::uint32_t capacity = UINT32_MAX) {
    gpu.context().replacedShaders()["sum_up"].assign(std::begin(kSumUpWords), std::end(kSumUpWords));
    const Kernel& kernel = gpu.kernel("sum_up", sizeof(SumUpPass));
    const std::size_t count = values.size();
    const Buffer buffer = gpu.upload("values", values),
                 sums = gpu.upload("sums", Values(count + gpu::kSumRuns + 1, kUntouched)),
                 result = gpu.upload("result", std::vector{gpu::ListState{}});
    const SumUpPass pass{at(buffer), at(sums), at(result), static_cast<gpu::uint>(count), capacity};
    // Twice, since the last workgroup must restore the count of workgroups.
    for (int time = 0; time < 2; ++time) { gpu.dispatchOver(kernel, pass, count, 1); }
    return {gpu.readBack<std::uint32_t>(sums, count + gpu::kSumRuns + 1),
            gpu.readBack<gpu::ListState>(result, 1)[0]};
}

auto wordsOf(const gpu::ListState& list) {
    return std::bit_cast<std::array<std::uint32_t, sizeof(list) / 4>>(list);
}

void checkSums(Gpu& gpu, std::size_t count) {
    CAPTURE(count);
    std::mt19937 random(static_cast<unsigned>(count));
    const std::size_t length = count > gpu::kMostInOneRun && count <= gpu::kSumRuns * 0xffffu
                                   ? (count + gpu::kSumRuns - 1) / gpu::kSumRuns
                                   : count;
    Values values, expected;
    std::uint32_t total = 0;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(static_cast<std::uint32_t>(random()) % 100);
        expected.push_back(total);
        total += values.back();
    }
    Summed summed = sumUp(gpu, values);
    const Values runs(summed.sums.begin() + static_cast<std::ptrdiff_t>(count), summed.sums.end());
    CHECK(these((runs[0] == kUntouched), runs.back()) == these((length == count), kUntouched));
    summed.sums.resize(count);
    for (std::size_t i = 0; i < count && length < count; ++i) { summed.sums[i] += runs[i / length]; }
    CHECK(summed.sums == expected);
    CHECK(wordsOf(summed.result) == wordsOf(makeList(total)));
}

// The list for a sum of values, each at most 2^20.
gpu::ListState listOfSum(Gpu& gpu, std::uint64_t sum, std::uint32_t capacity) {
    Values values(sum >> 20, 1u << 20);
    values.push_back(static_cast<std::uint32_t>(sum & ((1u << 20) - 1)));
    return sumUp(gpu, values, capacity).result;
}

TEST_CASE_FIXTURE(Gpu,
                  "lists of sizes round a subgroup, a group and a block are sorted, whatever their keys") {
    for (const unsigned key_bits : {32u, 27u, 14u, 9u, 1u}) {
        checkSorted(*this, key_bits, {0,  1,  2,  3,  4,  5,   7,   8,   9,   15,  16,  17, 31,
                                      32, 33, 63, 64, 65, 127, 128, 129, 255, 256, 257, 600},
                    {kRandom});
        checkSorted(
            *this, key_bits,
            {2, 127, 129, gpu::kSortBlock - 1, gpu::kSortBlock, gpu::kSortBlock + 1, 2 * gpu::kSortBlock + 3},
            {kRandom, kAllEqual, kFewDistinct, kAscending, kDescending, kExtremes});
    }
}

TEST_CASE_FIXTURE(Gpu, "lists of more than one run of blocks, and of so many that blocks grow, are sorted") {
    checkSorted(*this, 32, {gpu::kSortRun * gpu::kSortBlock + 1},
                {kRandom, kAllEqual, kFewDistinct, kDescending});
    checkSorted(*this, 12, {gpu::kMaxSortBlocks * gpu::kSortBlock + 1}, {kRandom});
}

TEST_CASE_FIXTURE(Gpu, "lists of every size to 600, round 2^17 and of 2^21 keys are sorted" * nightly()) {
    std::vector<std::size_t> sizes(601);
    std::iota(sizes.begin(), sizes.end(), std::size_t{0});
    for (const unsigned key_bits : {32u, 27u, 14u, 9u, 1u}) {
        checkSorted(*this, key_bits, sizes, {kRandom});
    }
    for (const unsigned key_bits : {32u, 14u}) {
        checkSorted(*this, key_bits, {(1u << 17) - 1, 1u << 17, (1u << 17) + 1},
                    {kRandom, kAllEqual, kFewDistinct, kDescending});
    }
    for (const unsigned key_bits : {32u, 12u}) { checkSorted(*this, key_bits, {1u << 21}, {kRandom}); }
}

TEST_CASE_FIXTURE(Gpu, "keys alone are sorted by some of their bits, in place if there is one round more") {
    const Sort sort(context());
    KernelCache kernels(context(), sort.kernels());
    for (const std::size_t size : {1u, 600u, 3 * gpu::kSortBlock + 1}) {
        for (const auto& [count, first] : {std::pair(9u, 17u), std::pair(14u, 18u), std::pair(1u, 3u)}) {
            CAPTURE(count);
            const Values keys = makeKeys(kRandom, size, 32);
            const Buffer key_buffer = upload("keys", keys), spare = upload("spare keys", keys),
                         lists = upload("lists", std::vector{makeList(size)}),
                         histograms(context(), "histograms", Sort::histogramBytes(size));
            KeyBits bits(count, first);
            if (bits.endInSpare()) { ++bits.rounds; }
            run([&](Commands& commands) {
                const KeyValues sorted = sort.record(kernels, commands, {at(key_buffer), {}}, {at(spare), {}},
                                                     at(histograms), lists, 0, bits);
                CHECK(sorted.keys.value == key_buffer.address<gpu::uint>().value);
            });
            Values expected;
            for (const std::uint32_t i : stableOrder(keys, count, first)) { expected.push_back(keys[i]); }
            CHECK(readBack<std::uint32_t>(key_buffer, size) == expected);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a list without room is as good as empty: its keys stay as they are") {
    const Sort sort(context());
    KernelCache kernels(context(), sort.kernels());
    const Values keys{5, 4, 3, 2, 1};
    const Buffer key_buffer = upload("keys", keys), spare = upload("spare keys", keys),
                 lists = upload("lists", std::vector{makeList(5, 4)}),
                 histograms(context(), "histograms", Sort::histogramBytes(5));
    run([&](Commands& commands) {
        sort.record(kernels, commands, {at(key_buffer), {}}, {at(spare), {}}, at(histograms), lists, 0, 32);
    });
    CHECK(these(readBack<gpu::uint>(key_buffer, 5), readBack<gpu::uint>(spare, 5)) == these(keys, keys));
}

TEST_CASE_FIXTURE(Gpu, "sums are right at every size across a boundary") {
    for (const std::size_t count :
         {1u, 2u, 7u, 8u, 9u, 127u, 128u, 129u, 1023u, 1024u, 1025u, 2049u, 4096u, 4097u, (1u << 17) + 1}) {
        checkSums(*this, count);
    }
}

// As many counts as two steps take, and one more: above 16.8 million splats, and above 268 million.
TEST_CASE_FIXTURE(Gpu, "sums of millions are right" * nightly()) {
    for (const std::size_t count : {gpu::kSumRuns * 0xffffu, gpu::kSumRuns * 0xffffu + 1}) {
        checkSums(*this, count);
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "a list that does not fit is empty and says what it needs, or that it exceeds 31 bits") {
    for (const std::uint32_t capacity : {60u, 59u}) {
        const gpu::ListState list = sumUp(*this, {10, 20, 30}, capacity).result;
        CHECK(wordsOf(list) == wordsOf(makeList(60, capacity)));
        CHECK(these(list.needed, list.count) == these(60, (capacity == 60 ? 60 : 0)));
    }
    // Just beyond the greatest index; beyond 2^32, where the sum modulo 2^32 is small; and several times
    // that.
    for (const std::uint64_t total :
         {std::uint64_t{gpu::kMaxItems} + 1, std::uint64_t{UINT32_MAX} - 3, std::uint64_t{1} << 32,
          (std::uint64_t{1} << 32) + 5, std::uint64_t{5} << 32, (std::uint64_t{9} << 32) + 77}) {
        CAPTURE(total);
        const gpu::ListState list = listOfSum(*this, total, UINT32_MAX - 1);
        CHECK(wordsOf(list) == wordsOf(makeList(UINT32_MAX, UINT32_MAX - 1)));
    }
}

TEST_CASE_FIXTURE(Gpu, "dispatches over a list fold into rows beyond the groups of one row") {
    constexpr std::uint32_t kRow = gpu::kMaxGroupsX * gpu::kGroupSize;
    for (const std::uint32_t total :
         {kRow - 1, kRow, kRow + 1, gpu::kMaxGroupsX * gpu::kListBlock,
          gpu::kMaxGroupsX * gpu::kListBlock + 1, 2'147'000'000u, gpu::kMaxItems}) {
        CAPTURE(total);
        const gpu::ListState list = listOfSum(*this, total, UINT32_MAX);
        CHECK(wordsOf(list) == wordsOf(makeList(total, UINT32_MAX)));
        for (const auto& [size, items] :
             {std::pair(list.per_item, gpu::kGroupSize), std::pair(list.per_block, gpu::kListBlock)}) {
            CHECK(size.x <= gpu::kMaxGroupsX);
            CHECK(std::uint64_t{size.x} * size.y * items >= total);
            // No more groups without work than there are rows.
            CHECK((std::uint64_t{size.x} * size.y - size.y) * items < total);
        }
        CHECK(these(list.per_sort_block.x, list.per_sort_block.y) ==
              these(within(1, gpu::kMaxSortBlocks), 1));
    }
}

}  // SUITE(sort)
