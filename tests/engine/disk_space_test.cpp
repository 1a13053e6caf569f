// Facts about the free space on disks.
#include "engine/disk_space.h"

#include "engine/platform.h"
#include "tests/suite.h"

SUITE(disk_space) {

TEST_CASE("the smaller of 1 GiB and 5 % of the disk stays free") {
    constexpr std::uint64_t kGib = std::uint64_t{1} << 30;
    for (const auto& [capacity, available, room] :
         std::vector<std::array<std::uint64_t, 3>>{{1000 * kGib, 500 * kGib, 499 * kGib},
                                                   {1000 * kGib, kGib, 0},
                                                   {1000 * kGib, 0, 0},
                                                   {10 * kGib, kGib, kGib / 2},
                                                   {0, 0, 0}}) {
        CHECK(spaceOn({capacity, available, available}) == room);
    }
}

TEST_CASE("a folder has no more room than its disk or memory, and one that is not there none") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    CHECK(spaceIn(folder) <= std::filesystem::space(folder).available);
    CHECK(spaceIn(folder / "not there") == 0);
    CHECK_FALSE(memoryBehind("/proc").has_value());
    if (!std::filesystem::exists("/dev/shm")) { return; }
    const std::optional<std::filesystem::space_info> memory = memoryBehind("/dev/shm");
    REQUIRE(memory.has_value());
    CHECK(memory->available == between(0, memory->capacity));
}

}  // SUITE(disk_space)
