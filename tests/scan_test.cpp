// Facts about prefix sums and the lists they state: sums, room, overflow, and the sizes of the dispatches over them.
#include "engine/passes/scan.h"
#include "tests/gpu_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

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

struct Scanned {
    Values sums;
    gpu::ListState result;
    bool stayed_within;  // the value after the last was left alone
};

enum class Over { kList, kCount };

Scanned scan(Gpu& gpu, const Scan& scan_kernels, Over over, Values values, std::uint32_t capacity) {
    const std::size_t count = values.size();
    values.push_back(kUntouched);
    const Buffer buffer = gpu.upload("values", values), list = gpu.upload("list", std::vector{test::makeList(count)});
    const Buffer result = gpu.allocate<gpu::ListState>("result", 1),
                 block_sums(gpu.context(), "block sums", Scan::blockSumBytes(count + 1));
    gpu.run([&](Commands& commands) {
        const auto to = result.address<gpu::ListState>();
        if (over == Over::kList) {
            scan_kernels.overList(commands, buffer.address<gpu::uint>(), block_sums.address<gpu::uint>(), list, 0, to, capacity);
        } else {
            scan_kernels.overCount(commands, buffer.address<gpu::uint>(), static_cast<gpu::uint>(count), to, capacity);
        }
    });
    Scanned scanned{gpu.readBack<std::uint32_t>(buffer, count + 1), gpu.readBack<gpu::ListState>(result, 1)[0], false};
    scanned.stayed_within = scanned.sums.back() == kUntouched;
    scanned.sums.pop_back();
    return scanned;
}

void checkSame(const gpu::DispatchSize& a, const gpu::DispatchSize& b) {
    CHECK(a.x == b.x);
    CHECK(a.y == b.y);
    CHECK(a.z == b.z);
}

void checkSame(const gpu::ListState& a, const gpu::ListState& b) {
    CHECK(a.needed == b.needed);
    CHECK(a.count == b.count);
    checkSame(a.per_item, b.per_item);
    checkSame(a.per_scan_block, b.per_scan_block);
    checkSame(a.per_sort_block, b.per_sort_block);
    checkSame(a.per_tile, b.per_tile);
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

TEST_CASE("the sums that scans are held against are right on a case done by hand") {
    const auto [sums, total] = sumBefore({3, 0, 5, 1});
    CHECK(sums == Values{0, 3, 3, 8});
    CHECK(total == 9);
}

TEST_CASE_FIXTURE(Gpu, "sums over a list are right at every size across a boundary") {
    const Scan kernels(context());
    for (const std::size_t count : {0u, 1u, 2u, 7u, 8u, 9u, 255u, 256u, 257u, 2047u, 2048u, 2049u, 4097u, (1u << 17) + 1, 5'000'000u}) {
        CAPTURE(count);
        const Values values = makeValues(count, 100);
        const auto [sums, total] = sumBefore(values);
        const Scanned scanned = scan(*this, kernels, Over::kList, values, UINT32_MAX);
        CHECK(scanned.sums == sums);
        CHECK(scanned.stayed_within);
        checkSame(scanned.result, test::makeList(total));
    }
}

TEST_CASE_FIXTURE(Gpu, "sums over a known count are right at every size across a boundary") {
    const Scan kernels(context());
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 255u, 256u, 257u, 2047u, 2048u, 2049u, 4095u, 4096u, 4097u, 100'000u}) {
        CAPTURE(count);
        const Values values = makeValues(count, gpu::kGroupSize + 1);
        const auto [sums, total] = sumBefore(values);
        const Scanned scanned = scan(*this, kernels, Over::kCount, values, UINT32_MAX);
        CHECK(scanned.sums == sums);
        CHECK(scanned.stayed_within);
        checkSame(scanned.result, test::makeList(total));
    }
}

TEST_CASE_FIXTURE(Gpu, "a list that does not fit is empty and says what it needs") {
    const Scan kernels(context());
    for (const Over over : {Over::kList, Over::kCount}) {
        const Values values{10, 20, 30};
        const gpu::ListState fits = scan(*this, kernels, over, values, 60).result,
                             short_of_one = scan(*this, kernels, over, values, 59).result;
        checkSame(fits, test::makeList(60, 60));
        CHECK(fits.count == 60);
        checkSame(short_of_one, test::makeList(60, 59));
        CHECK(short_of_one.count == 0);
        CHECK(short_of_one.per_item.x == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "dispatches fold into rows beyond the groups of one row") {
    const Scan kernels(context());
    constexpr std::uint32_t kRow = gpu::kMaxGroupsX * gpu::kGroupSize;
    for (const std::uint32_t total :
         {kRow - 1, kRow, kRow + 1, gpu::kMaxGroupsX * gpu::kScanBlock, gpu::kMaxGroupsX * gpu::kScanBlock + 1, 4'000'000'000u}) {
        CAPTURE(total);
        const gpu::ListState list = scan(*this, kernels, Over::kList, makeValuesOfSum(total), UINT32_MAX).result;
        checkSame(list, test::makeList(total, UINT32_MAX));
        for (const auto& [size, items] : {std::pair(list.per_item, gpu::kGroupSize), std::pair(list.per_scan_block, gpu::kScanBlock)}) {
            CHECK(size.x <= gpu::kMaxGroupsX);
            CHECK(std::uint64_t{size.x} * size.y * items >= total);
            CHECK(std::uint64_t{size.x} * (size.y - 1) * items < total);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a sum beyond 32 bits is told, whatever room there is") {
    const Scan kernels(context());
    // Just beyond 2^32, where the sum modulo 2^32 is small, and several times that.
    for (const std::uint64_t total :
         {std::uint64_t{1} << 32, (std::uint64_t{1} << 32) + 5, std::uint64_t{5} << 32, (std::uint64_t{9} << 32) + 77}) {
        CAPTURE(total);
        const gpu::ListState list = scan(*this, kernels, Over::kList, makeValuesOfSum(total), UINT32_MAX - 1).result;
        checkSame(list, test::makeList(UINT32_MAX, UINT32_MAX - 1));
        CHECK(list.needed == UINT32_MAX);
        CHECK(list.count == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "a list without items has a sum of nothing") {
    const Scan kernels(context());
    const Scanned scanned = scan(*this, kernels, Over::kList, {}, 0);
    checkSame(scanned.result, test::makeList(0, 0));
    CHECK(scanned.result.per_item.x == 0);
}
