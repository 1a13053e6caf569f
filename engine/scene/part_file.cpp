// A temporary file and one rename.
#include "engine/scene/part_file.h"

#include "engine/error.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace binosplat {

PartFile::PartFile(const std::string& target) : target_(target), path_(fmt::format("{}.part{}", target, ::getpid())) {
    std::error_code unreadable;  // opening says why
    check(!std::filesystem::is_directory(target, unreadable), "{}: is a directory, expected a file name to write to", target);
    // Renaming over a device would replace it.
    const bool plain = !std::filesystem::exists(target, unreadable) || std::filesystem::is_regular_file(target, unreadable);
    check(plain, "{}: is not a regular file, expected a file name to write to", target);
    file_ = std::fopen(path_.c_str(), "wb");
    check(file_ != nullptr, "{}: cannot be written: {}", target, std::strerror(errno));
}

PartFile::~PartFile() {
    if (file_ != nullptr) { std::fclose(file_); }
    if (!renamed_) { std::remove(path_.c_str()); }
}

void PartFile::write(const void* data, std::size_t bytes) {
    check(std::fwrite(data, 1, bytes, file_) == bytes, "{}: writing failed: {}", target_, std::strerror(errno));
}

void PartFile::commit() {
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    check(closed, "{}: writing failed: {}", target_, std::strerror(errno));
    check(std::rename(path_.c_str(), target_.c_str()) == 0, "{}: cannot be put in place: {}", target_, std::strerror(errno));
    renamed_ = true;
}

}  // namespace binosplat
