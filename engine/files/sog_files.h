// The files of a SOG scene by name: in a directory, or in a .sog bundle, which is a zip archive.
#pragma once

#include "engine/files/input_file.h"
#include "engine/files/scene_files.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace binosplat {

class SogFiles {
public:
    virtual ~SogFiles() = default;
    // The bytes of `name`, at most `max_bytes`. Throws Error if it is missing, larger, or not a plain file
    // name, so that no path leads out.
    [[nodiscard]] virtual std::vector<std::byte> read(const std::string& name, std::uint64_t max_bytes) = 0;
    // For a file that could be read. Throws Error as `read` does.
    [[nodiscard]] virtual std::uint64_t sizeBytes(const std::string& name) const = 0;
    // They will be read soon.
    virtual void expect(const std::vector<std::string>&, std::uint64_t) {}
    // Closes what is held open between reads: a scene may have thousands of chunks.
    virtual void close() {}
    // The file's name in messages: path and name.
    [[nodiscard]] virtual std::string place(const std::string& name) const = 0;
};

std::unique_ptr<SogFiles> openSogFolder(const std::string& folder);
// Those beside `meta`, a meta.json among `files`, which must outlive it.
std::unique_ptr<SogFiles> openSogFolder(SceneFiles& files, const std::string& meta);

// Only in a build with SOG. Throws Error if `file` is not a zip archive or holds no meta.json.
std::unique_ptr<SogFiles> openSogBundle(const InputFile& file);
std::unique_ptr<SogFiles> openSogBundle(SceneFiles& files, const std::string& bundle);

struct NamedBytes {
    std::string name;
    std::vector<std::byte> bytes;
};
// A bundle of such files, stored uncompressed; the same files always give the same bundle. `place` is for
// messages.
std::vector<std::byte> packSogBundle(const std::vector<NamedBytes>& files, const std::string& place);

}  // namespace binosplat
