// The free space that the system reports for a disk, less what must stay free.
#include "engine/disk_space.h"

#include "engine/platform.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

namespace binosplat {

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{1} << 30, kFreeShare = 20;
constexpr std::uint64_t kLookBytes = std::uint64_t{16} << 20;
// For a disk that does not say how large it is; writing to it fails when it is full.
constexpr std::uint64_t kUntoldBytes = std::uint64_t{1} << 62;

}  // namespace

std::uint64_t spaceOn(const std::filesystem::space_info& disk) {
    const std::uint64_t kept = std::min<std::uint64_t>(kFreeBytes, disk.capacity / kFreeShare);
    return disk.available - std::min<std::uint64_t>(disk.available, kept);
}

std::uint64_t spaceIn(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::space_info disk = std::filesystem::space(folder, error);
    if (error) { return 0; }
    const std::uint64_t bytes = disk.capacity > 0 ? spaceOn(disk) : kUntoldBytes;
    const std::optional<std::filesystem::space_info> memory = memoryBehind(folder);
    return memory ? std::min(bytes, spaceOn(*memory)) : bytes;
}

DiskSpace::DiskSpace(std::filesystem::path folder, Measure measure)
    : folder_(std::move(folder)), measure_(std::move(measure)), bytes_(measure_(folder_)) {}

bool DiskSpace::holds(std::uint64_t written, std::uint64_t more) {
    if (written - looked_at_bytes_ >= kLookBytes) {
        looked_at_bytes_ = written;
        bytes_ = written + measure_(folder_);
    }
    return more <= bytes_ - written;
}

}  // namespace binosplat
