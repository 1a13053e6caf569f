// Folders that are needed only for a while.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// A folder's entries, each once; empty if it cannot be read. Unlike a plain directory_iterator, it always
// ends: if a path is too long, MinGW's may return the same entry again and again.
std::vector<std::filesystem::path> entriesOf(const std::filesystem::path& folder);

// Removes a folder and its content, as far as possible, without following links. This also always ends.
void removeFolder(const std::filesystem::path& folder) noexcept;

// Made in the system's folder for temporary files, and removed with its owner.
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
    std::filesystem::path path_;  // empty: moved to another owner
};

}  // namespace binosplat
