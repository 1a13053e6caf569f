// Files that appear all together or not at all.
#include "engine/setup/output_files.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/temporary_folder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace binosplat {

namespace fs = std::filesystem;

// As long as most names of written files.
static constexpr const char* kLongName = "frame_000000_a_name_of_the_usual_length";

OutputFiles::OutputFiles(const fs::path& folder) : folder_(folder) {
    // Remember which folders are new, so that a failed run can take them away again.
    for (fs::path part = fs::absolute(folder).lexically_normal(); !part.empty() && part != part.root_path();
         part = part.parent_path()) {
        std::error_code ignored;
        if (fs::exists(part, ignored)) { break; }
        if (part.has_filename()) { made_folders_.insert(made_folders_.begin(), part); }
    }
    std::error_code error;
    fs::create_directories(folder_, error);
    const bool is_folder = !error && fs::is_directory(folder_, error);
    if (!is_folder) {
        removeUnpublished();
        fail("{}: cannot be used as output directory ({}), must be a directory that can be made and written",
             folder_.string(), error ? error.message() : "not a directory");
    }
    // A folder made inside proves that the place is writable, whatever its permission bits say; a file in
    // that folder proves that the path is not too long: otherwise some systems make the folder, but nothing
    // in it.
    makeStaging();
    const fs::path probe = staging_ / kLongName;
    const bool fits = createFile(probe) != nullptr && entriesOf(staging_) == std::vector<fs::path>{probe};
    std::error_code ignored;
    fs::remove(probe, ignored);  // by its name, since looking through the folder may not find it
    removeFolder(staging_);
    staging_.clear();
    if (fits) { return; }
    removeUnpublished();
    fail(
        "{}: files in it cannot be made and found again: its path may be too long, with {} letters; must be "
        "a shorter one",
        folder_.string(), fs::absolute(folder_).string().size());
}

const fs::path& OutputFiles::staging() {
    if (staging_.empty()) { makeStaging(); }
    return staging_;
}

void OutputFiles::makeStaging() {
    staging_ = createFolder(folder_, ".binosplat-");
    if (staging_.empty()) {
        const std::string reason = std::strerror(errno);
        removeUnpublished();
        fail("{}: cannot be written ({}), must be a writable directory", folder_.string(), reason);
    }
}

OutputFiles::~OutputFiles() { removeUnpublished(); }

void OutputFiles::removeUnpublished() noexcept {
    std::error_code ignored;
    if (!staging_.empty()) { removeFolder(staging_); }
    // Only empty folders go: `remove` refuses the others.
    for (auto folder = made_folders_.rbegin(); folder != made_folders_.rend(); ++folder) {
        fs::remove(*folder, ignored);
    }
    made_folders_.clear();
}

void OutputFiles::publish() {
    if (staging_.empty()) { return; }
    // A folder in a file's place, or a pipe or a device, which moving would replace, must be noticed before
    // the first file moves.
    const std::vector<fs::path> staged = entriesOf(staging_);
    for (const fs::path& entry : staged) {
        const fs::path target = folder_ / entry.filename();
        std::error_code none;
        const fs::file_status there = fs::status(target, none);
        check(!fs::exists(there) || fs::is_regular_file(there),
              "{}: cannot be written ({}), must be a file or not there", target.string(),
              fs::is_directory(there) ? "is a directory" : "not a regular file");
    }
    for (const fs::path& entry : staged) {
        const fs::path target = folder_ / entry.filename();
        std::error_code error;
        fs::rename(entry, target, error);
        check(!error, "{}: cannot be written ({})", target.string(), error.message());
        made_folders_.clear();
    }
}

void writeText(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) {
        std::error_code ignored;
        fs::remove(path, ignored);
        fail("{}: cannot be written ({})", path.string(), std::strerror(errno));
    }
}

}  // namespace binosplat
