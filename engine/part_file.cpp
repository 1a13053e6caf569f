// A temporary file and one rename.
#include "engine/part_file.h"

#include "engine/error.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {
constexpr int kMostNames = 1000;
}

PartFile::PartFile(const std::string& target) : target_(target) {
    std::error_code unreadable;  // opening says why
    check(!std::filesystem::is_directory(target, unreadable),
          "{}: is a directory, expected a file name to write to", target);
    // Renaming over a device would replace it.
    const bool plain =
        !std::filesystem::exists(target, unreadable) || std::filesystem::is_regular_file(target, unreadable);
    check(plain, "{}: is not a regular file, expected a file name to write to", target);
    // Names that are taken, by a link into somebody's files perhaps, are left alone.
    for (int attempt = 0; attempt < kMostNames && file_ == nullptr; ++attempt) {
        path_ = fmt::format("{}.part{}-{}", target, processId(), attempt);
        file_ = createFile(path_);
        if (file_ == nullptr && errno != EEXIST) { break; }
    }
    check(file_ != nullptr, "{}: cannot be written: {}", target, std::strerror(errno));
}

PartFile::~PartFile() {
    file_.reset();
    std::error_code ignored;
    if (!renamed_) { std::filesystem::remove(path_, ignored); }
}

void PartFile::write(const void* data, std::size_t bytes) {
    check(std::fwrite(data, 1, bytes, file_.get()) == bytes, "{}: writing failed: {}", target_,
          std::strerror(errno));
}

void PartFile::commit() {
    const bool closed = std::fclose(file_.release()) == 0;
    check(closed, "{}: writing failed: {}", target_, std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(path_, target_, error);
    check(!error, "{}: cannot be moved into place: {}", target_, error.message());
    renamed_ = true;
}

}  // namespace binosplat
