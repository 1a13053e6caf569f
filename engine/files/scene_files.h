// The files of a scene that is not on the disk: an implementation knows where they are, and brings requested
// files to the disk.
#pragma once

#include "engine/files/input_file.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace binosplat {

// A name is relative to the folder of the scene's own file and leads to a place within it, with / between
// folders; the empty name is that file itself.
class SceneFiles {
public:
    virtual ~SceneFiles() = default;
    // Waits until the whole file is there. Throws Error if it cannot be fetched, or is longer than
    // `most_bytes`.
    [[nodiscard]] virtual std::unique_ptr<InputFile> open(const std::string& name,
                                                          std::uint64_t most_bytes = kAnyLength) = 0;
    // They will be opened soon; requests all of them at once.
    virtual void expect(const std::vector<std::string>& names, std::uint64_t most_bytes = kAnyLength) = 0;
    // The file's name in messages.
    [[nodiscard]] virtual std::string place(const std::string& name) const = 0;

    static constexpr std::uint64_t kAnyLength = ~std::uint64_t{0};
};

}  // namespace binosplat
