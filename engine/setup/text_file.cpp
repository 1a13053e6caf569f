// Files that are read whole, and therefore must have an end.
#include "engine/setup/text_file.h"

#include "engine/error.h"
#include "engine/git_lfs.h"
#include "engine/platform.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace binosplat {

std::string readTextFile(const std::filesystem::path& path, const std::string& expected,
                         std::size_t most_bytes) {
    std::string reason;
    const File file = openRegularFile(path, reason);
    check(file != nullptr, "{}: cannot be read ({}), must be {}", path.string(), reason, expected);
    std::string text;
    std::size_t end = 0;
    do {
        text.resize(end + (std::size_t{1} << 16));
        errno = 0;
        const std::size_t got = std::fread(text.data() + end, 1, text.size() - end, file.get());
        check(std::ferror(file.get()) == 0, "{}: cannot be read ({}), must be {}", path.string(),
              std::strerror(errno), expected);
        text.resize(end + got);
        check(text.size() <= most_bytes, "{}: cannot be read (longer than {} MiB), must be {}", path.string(),
              most_bytes >> 20, expected);
    } while (std::exchange(end, text.size()) < text.size());
    requireNoLfsPointer(text, path.string());
    return text;
}

}  // namespace binosplat
