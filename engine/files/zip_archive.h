// Zip archives, through libzip; not in a build without SOG.
#pragma once

#include "engine/files/input_file.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

class ZipArchive {
public:
#ifdef BINOSPLAT_SOG
    static constexpr bool kIsBuiltIn = true;
#else
    static constexpr bool kIsBuiltIn = false;
#endif
    using Open = std::function<std::unique_ptr<InputFile>()>;
    struct Entry {
        std::string place;  // for messages
        std::uint64_t index = 0, size_bytes = 0;
    };

    // `path` and `expected` are for messages. The file is opened when it is needed.
    ZipArchive(std::string path, std::string expected, Open open);
    ~ZipArchive();

    // Names of all entries, including folders, in the archive's order. Throws Error if the archive is
    // incomplete.
    [[nodiscard]] std::vector<std::string> names() const;
    // Throws Error if there is no such entry, or if it is encrypted.
    [[nodiscard]] Entry find(const std::string& name) const;
    // Closes the file until it is needed again.
    void close();

private:
    friend class ZipReader;
    struct State;
    std::unique_ptr<State> state_;
};

// An entry read from front to back; its archive stays open meanwhile.
class ZipReader {
public:
    ZipReader(const ZipArchive& archive, const ZipArchive::Entry& entry);
    ~ZipReader();
    ZipReader(const ZipReader&) = delete;
    ZipReader& operator=(const ZipReader&) = delete;

    // Fills `target` as far as the entry goes and returns the number of bytes. Throws Error if the entry is
    // broken; its checksum is compared at the end.
    std::size_t read(std::span<std::byte> target);

private:
    struct State;
    std::string place_;
    std::unique_ptr<State> state_;
};

}  // namespace binosplat
