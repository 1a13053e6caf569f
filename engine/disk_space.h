// How much may be written to a disk, checked again now and then, since others write to it, too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace binosplat {

// The smaller of 1 GiB and 5 % of a disk stays free for other programs.
std::uint64_t spaceOn(const std::filesystem::space_info& disk);
// The same for the disk of a folder; if that is in memory, also the same share of free memory. Empty if the
// folder cannot be examined.
std::uint64_t spaceIn(const std::filesystem::path& folder);

class DiskSpace {
public:
    using Measure = std::function<std::uint64_t(const std::filesystem::path& folder)>;

    explicit DiskSpace(std::filesystem::path folder, Measure measure = spaceIn);

    // How much may be written in all, as of the last check.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    // True if there is space for `more` bytes after the `written` ones. Checks again after every 16 MiB.
    [[nodiscard]] bool holds(std::uint64_t written, std::uint64_t more);

private:
    std::filesystem::path folder_;
    Measure measure_;
    std::uint64_t bytes_, looked_at_bytes_ = 0;
};

}  // namespace binosplat
