// Fetched files, kept on the disk for the next time: for each address a file of its bytes, and a note (JSON) of whose they are.
// Several programs may use one folder: bytes are written under a name that nobody else has and put in place in one step, as are notes, and
// a note that was written for other bytes is ignored.
#pragma once

#include "engine/disk_room.h"
#include "engine/platform.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// A file on its way into the cache: removed again unless it is kept.
class IncomingFile {
public:
    IncomingFile(std::filesystem::path path, File file);
    IncomingFile(const IncomingFile&) = delete;
    IncomingFile& operator=(const IncomingFile&) = delete;
    ~IncomingFile();

    // False if the disk has no room for them.
    [[nodiscard]] bool write(const char* data, std::size_t bytes);
    // How much may be written in all, so that the disk keeps some free space.
    [[nodiscard]] std::uint64_t roomBytes() const { return room_.bytes(); }
    [[nodiscard]] std::uint64_t sizeBytes() const { return size_bytes_; }

private:
    friend class WebCache;
    std::filesystem::path path_;
    File file_;
    DiskRoom room_;
    std::uint64_t size_bytes_ = 0;
    bool is_kept_ = false;
};

// A server's description of a version of a file, to ask it whether there is a newer one.
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
    // Makes the folder if it is not there.
    explicit WebCache(std::filesystem::path folder);

    // Null, with the reason in errno, if no file can be made. By any thread.
    [[nodiscard]] std::unique_ptr<IncomingFile> begin(const std::string& address) const;
    // Replaces the copy that was kept of it. Throws Error if it cannot be written to the disk.
    void keep(const std::string& address, std::unique_ptr<IncomingFile> file, const FileVersion& version) const;
    // Counts as a use.
    [[nodiscard]] std::optional<KeptCopy> find(const std::string& address) const;
    // Removes copies until those left have `most_bytes` at most, the least recently used first, and leftovers of programs that broke
    // off. What cannot be removed stays.
    void trim(std::uint64_t most_bytes) const noexcept;

private:
    [[nodiscard]] std::filesystem::path stemOf(const std::string& address) const;
    std::filesystem::path folder_;
};

}  // namespace binosplat
