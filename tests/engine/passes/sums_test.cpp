// Facts about sums by the last workgroup and the lists they state: sums, room, overflow, and the sizes of the dispatches over them.
#include "engine/gpu/kernel.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

TEST_SUITE_BEGIN("sums");

namespace sums_test {

using namespace binosplat;
using test::Gpu;

namespace {

using Values = std::vector<std::uint32_t>;

constexpr std::uint32_t kUntouched = 0xdeadbeefu;

// Sums of all before, and of all.
std::pair<Values, std::uint64_t> sumBefore(const Values& values) {
    Values sums;
    std::uint64_t sum = 0;
    for (const std::uint32_t value : values) {
        sums.push_back(static_cast<std::uint32_t>(sum));
        sum += value;
    }
    return {sums, sum};
}

// As tests/engine/passes/sum_up.comp takes it.
struct SumUpPass {
    gpu::DeviceAddress<gpu::uint> values, sums;
    gpu::DeviceAddress<gpu::ListState> result;
    gpu::uint count, capacity;
};

constexpr std::uint32_t kSumUpWords[] = {
#include "sum_up.inc"
};

struct Summed {
    Values sums;
    gpu::ListState result;
    bool stayed_within;  // the value after the last was left alone
};

Summed sumUp(Gpu& gpu, const Values& values, std::uint32_t capacity) {
    gpu.context().replacedShaders()["sum_up"].assign(std::begin(kSumUpWords), std::end(kSumUpWords));
    const Kernel& kernel = gpu.kernel("sum_up", sizeof(SumUpPass));
    const std::size_t count = values.size();
    const Buffer buffer = gpu.upload("values", values), sums = gpu.upload("sums", Values(count + 1, kUntouched));
    const Buffer result = gpu.upload("result", std::vector{gpu::ListState{}});
    const SumUpPass pass{buffer.address<gpu::uint>(), sums.address<gpu::uint>(), result.address<gpu::ListState>(),
                         static_cast<gpu::uint>(count), capacity};
    gpu.run([&](Commands& commands) {
        // Twice, since the last workgroup must leave the count of workgroups as it was.
        commands.dispatchOver(kernel, pass, count, 1024);
        commands.dispatchOver(kernel, pass, count, 1024);
    });
    Summed summed{gpu.readBack<std::uint32_t>(sums, count + 1), gpu.readBack<gpu::ListState>(result, 1)[0], false};
    summed.stayed_within = summed.sums.back() == kUntouched;
    summed.sums.pop_back();
    return summed;
}

void checkSame(const gpu::DispatchSize& a, const gpu::DispatchSize& b) {
    CHECK(a.x == b.x);
    CHECK(a.y == b.y);
    CHECK(a.z == b.z);
}

void checkSame(const gpu::ListState& a, const gpu::ListState& b) {
    CHECK(a.needed == b.needed);
    CHECK(a.count == b.count);
    CHECK(a.groups_done == b.groups_done);
    checkSame(a.per_item, b.per_item);
    checkSame(a.per_block, b.per_block);
    checkSame(a.per_sort_block, b.per_sort_block);
}

Values makeValues(std::size_t count, std::uint32_t below) {
    std::mt19937 random(static_cast<unsigned>(count));
    Values values(count);
    for (std::uint32_t& value : values) { value = static_cast<std::uint32_t>(random()) % below; }
    return values;
}

// Values, each at most 2^20, that sum up to `sum`.
Values makeValuesOfSum(std::uint64_t sum) {
    Values values(sum >> 20, 1u << 20);
    values.push_back(static_cast<std::uint32_t>(sum & ((1u << 20) - 1)));
    return values;
}

}  // namespace

TEST_CASE("the sums that others are held against are right on a case done by hand") {
    const auto [sums, total] = sumBefore({3, 0, 5, 1});
    CHECK(sums == Values{0, 3, 3, 8});
    CHECK(total == 9);
}

TEST_CASE_FIXTURE(Gpu, "sums are right at every size across a boundary") {
    for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 127u, 128u, 129u, 1023u, 1024u, 1025u, 2049u, (1u << 17) + 1, 5'000'000u}) {
        CAPTURE(count);
        const Values values = makeValues(count, 100);
        const auto [sums, total] = sumBefore(values);
        const Summed summed = sumUp(*this, values, UINT32_MAX);
        CHECK(summed.sums == sums);
        CHECK(summed.stayed_within);
        checkSame(summed.result, test::makeList(total));
    }
}

TEST_CASE_FIXTURE(Gpu, "a list that does not fit is empty and says what it needs") {
    const Values values{10, 20, 30};
    const gpu::ListState fits = sumUp(*this, values, 60).result, short_of_one = sumUp(*this, values, 59).result;
    checkSame(fits, test::makeList(60, 60));
    CHECK(fits.count == 60);
    checkSame(short_of_one, test::makeList(60, 59));
    CHECK(short_of_one.count == 0);
    CHECK(short_of_one.per_item.x == 0);
}

TEST_CASE_FIXTURE(Gpu, "dispatches fold into rows beyond the groups of one row") {
    constexpr std::uint32_t kRow = gpu::kMaxGroupsX * gpu::kGroupSize;
    for (const std::uint32_t total : {kRow - 1, kRow, kRow + 1, gpu::kMaxGroupsX * gpu::kListBlock, gpu::kMaxGroupsX * gpu::kListBlock + 1,
                                      2'147'000'000u, gpu::kMaxItems}) {
        CAPTURE(total);
        const gpu::ListState list = sumUp(*this, makeValuesOfSum(total), UINT32_MAX).result;
        checkSame(list, test::makeList(total, UINT32_MAX));
        for (const auto& [size, items] : {std::pair(list.per_item, gpu::kGroupSize), std::pair(list.per_block, gpu::kListBlock)}) {
            CHECK(size.x <= gpu::kMaxGroupsX);
            CHECK(std::uint64_t{size.x} * size.y * items >= total);
            // No more groups without work than there are rows.
            CHECK((std::uint64_t{size.x} * size.y - size.y) * items < total);
        }
        CHECK(list.per_sort_block.x <= gpu::kMaxSortBlocks);
        CHECK(list.per_sort_block.y == 1);
    }
}

TEST_CASE_FIXTURE(Gpu, "a sum beyond 31 bits is told, whatever room there is") {
    // Just beyond what an index may be, and beyond 2^32, where the sum modulo 2^32 is small, and several times that.
    for (const std::uint64_t total : {std::uint64_t{gpu::kMaxItems} + 1, std::uint64_t{UINT32_MAX} - 3, std::uint64_t{1} << 32,
                                      (std::uint64_t{1} << 32) + 5, std::uint64_t{5} << 32, (std::uint64_t{9} << 32) + 77}) {
        CAPTURE(total);
        const gpu::ListState list = sumUp(*this, makeValuesOfSum(total), UINT32_MAX - 1).result;
        checkSame(list, test::makeList(UINT32_MAX, UINT32_MAX - 1));
        CHECK(list.needed == UINT32_MAX);
        CHECK(list.count == 0);
    }
}

}  // namespace sums_test
