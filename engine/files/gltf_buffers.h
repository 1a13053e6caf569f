// The bytes of a glTF: in the GLB itself, in files beside it, or in its text.
#pragma once

#include "engine/files/input_file.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

class GltfBuffer {
public:
    // `size_bytes` of `file` from `offset` on, which must exist. The file must outlive the buffer.
    GltfBuffer(const InputFile& file, std::uint64_t offset, std::uint64_t size_bytes)
        : file_(&file), offset_(offset), size_bytes_(size_bytes) {}
    explicit GltfBuffer(std::unique_ptr<InputFile> file);
    explicit GltfBuffer(std::vector<std::byte> bytes);

    [[nodiscard]] std::uint64_t sizeBytes() const { return size_bytes_; }
    // Within sizeBytes(). Throws Error if the file has been cut off meanwhile.
    void read(std::uint64_t offset, std::span<std::byte> target) const;
    // Throws Error if a file of its own has been written to.
    void requireUnchanged() const;

private:
    std::unique_ptr<InputFile> own_;
    const InputFile* file_ = nullptr;
    std::vector<std::byte> bytes_;  // if there is no file
    std::uint64_t offset_ = 0, size_bytes_ = 0;
};

// The bytes that a buffer's `uri` names: a file in the folder of `file`, or base64 data. `place` is the
// buffer's, for messages.
GltfBuffer openGltfUri(const InputFile& file, const std::string& uri, const std::string& place);

}  // namespace binosplat
