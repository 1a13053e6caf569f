// Bounded walks through folders, and a folder with a random name.
#include "engine/temporary_folder.h"

#include "engine/error.h"
#include "engine/platform.h"

#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

namespace binosplat {

namespace fs = std::filesystem;

std::vector<fs::path> entriesOf(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::set<fs::path> seen;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (!seen.insert(entry->path()).second) { break; }
        entries.push_back(entry->path());
    }
    return entries;
}

void removeFolder(const fs::path& folder) noexcept {
    try {
        std::vector<fs::path> found{folder};
        for (std::size_t i = 0; i < found.size(); ++i) {
            std::error_code error;
            if (!fs::is_directory(fs::symlink_status(found[i], error))) { continue; }
            const std::vector<fs::path> within = entriesOf(found[i]);
            found.insert(found.end(), within.begin(), within.end());
        }
        for (auto last = found.rbegin(); last != found.rend(); ++last) {
            std::error_code stays;
            fs::remove(*last, stays);
        }
    } catch (const std::exception&) {}  // no memory for the names
}

TemporaryFolder::TemporaryFolder(const std::string& prefix, const char* purpose) {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    check(!error, "the folder for temporary files: {}, must be a folder that can be written",
          error.message());
    path_ = createFolder(parent, prefix);
    check(!path_.empty(), "{}: no folder can be made there for {}: {}", parent.string(), purpose,
          std::strerror(errno));
}

TemporaryFolder::~TemporaryFolder() {
    if (!path_.empty()) { removeFolder(path_); }
}

}  // namespace binosplat
