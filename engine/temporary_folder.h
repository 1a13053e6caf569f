// Folders that are needed for a while.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// What lies in a folder, each entry once; empty if it cannot be read. Unlike a bare directory_iterator it always ends: where a path is too
// long, the one of MinGW's library may give the same entry again and again.
std::vector<std::filesystem::path> entriesOf(const std::filesystem::path& folder);

// Removes a folder and all within, as far as possible; links are not followed. Always ends, too.
void removeFolder(const std::filesystem::path& folder) noexcept;

// Made in the system's folder for temporary files, and gone with its owner.
class TemporaryFolder {
public:
    // Its name begins with `prefix`. Throws Error if it cannot be made; `purpose` is for the message.
    TemporaryFolder(const std::string& prefix, const char* purpose);
    ~TemporaryFolder();
    TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;  // empty: it has another owner
};

}  // namespace binosplat
