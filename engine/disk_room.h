// How much may be written to a disk, looked at again now and then: others write to it, too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace binosplat {

// The smaller of 1 GiB and 5 % of a disk stays free for other programs.
std::uint64_t roomOn(const std::filesystem::space_info& disk);
// The same for the disk of a folder; where that is memory, of what of it is free, too. None if the folder cannot be looked at.
std::uint64_t roomIn(const std::filesystem::path& folder);

class DiskRoom {
public:
    using Measure = std::function<std::uint64_t(const std::filesystem::path& folder)>;

    explicit DiskRoom(std::filesystem::path folder, Measure measure = roomIn);

    // How much may be written in all, as of the last look.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    // True if there is room for `more` bytes behind those that were `written`. Looks again once 16 MiB were since the last time.
    [[nodiscard]] bool holds(std::uint64_t written, std::uint64_t more);

private:
    std::filesystem::path folder_;
    Measure measure_;
    std::uint64_t bytes_, looked_at_bytes_ = 0;
};

}  // namespace binosplat
