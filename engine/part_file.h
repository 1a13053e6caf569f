// A file being written beside its target: it replaces the target in one step when it is complete, and is
// removed otherwise.
#pragma once

#include "engine/platform.h"

#include <cstddef>
#include <string>

namespace binosplat {

class PartFile {
public:
    // Throws Error if `target` cannot be written or cannot be a file.
    explicit PartFile(const std::string& target);
    ~PartFile();
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    void write(const void* data, std::size_t bytes);
    void commit();

private:
    std::string target_, path_;
    File file_;
    bool renamed_ = false;
};

}  // namespace binosplat
