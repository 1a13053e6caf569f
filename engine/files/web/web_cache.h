// Fetched files, kept on the disk for the next time: for each address a file with its bytes, and a note
// (JSON) that says which address they are from. Several programs may use the same folder: bytes and notes are
// written under a unique name and put in place in one step, and a note that was written for other bytes is
// ignored.
#pragma once

#include "engine/disk_space.h"
#include "engine/platform.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// A file on its way into the cache: it is removed again unless it is kept.
class IncomingFile {
public:
    IncomingFile(std::filesystem::path path, File file);
    IncomingFile(const IncomingFile&) = delete;
    IncomingFile& operator=(const IncomingFile&) = delete;
    ~IncomingFile();

    // False if the disk is too full for them.
    [[nodiscard]] bool write(const char* data, std::size_t bytes);
    // How much may be written in total, to leave some of the disk free.
    [[nodiscard]] std::uint64_t spaceBytes() const { return space_.bytes(); }
    [[nodiscard]] std::uint64_t sizeBytes() const { return size_bytes_; }

private:
    friend class WebCache;
    std::filesystem::path path_;
    File file_;
    DiskSpace space_;
    std::uint64_t size_bytes_ = 0;
    bool is_kept_ = false;
};

// A server's description of a version of a file, with which to ask whether there is a newer one.
struct FileVersion {
    std::string etag, last_modified;
};

struct KeptCopy {
    std::filesystem::path path;
    FileVersion version;
    std::int64_t fetched_s = 0;  // since 1970
};

class WebCache {
public:
    // Makes the folder if it does not exist.
    explicit WebCache(std::filesystem::path folder);

    // Null, with the reason in errno, if no file can be made. Any thread.
    [[nodiscard]] std::unique_ptr<IncomingFile> begin(const std::string& address) const;
    // Replaces the kept copy and returns where its bytes lie. Throws Error if it cannot be written to the
    // disk.
    std::filesystem::path keep(const std::string& address, std::unique_ptr<IncomingFile> file,
                               const FileVersion& version) const;
    // Finds a copy; this counts as a use.
    [[nodiscard]] std::optional<KeptCopy> find(const std::string& address) const;
    // Removes copies, the least recently used first, until at most `most_bytes` are left, and leftovers of
    // programs that were interrupted. What cannot be removed stays.
    void trim(std::uint64_t most_bytes) const noexcept;

private:
    [[nodiscard]] std::filesystem::path stemOf(const std::string& address) const;
    std::filesystem::path folder_;
};

}  // namespace binosplat
