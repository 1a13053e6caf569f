// gzip streams: a file read through inflate, and bytes on their way into one.
#pragma once

#include "engine/files/input_file.h"
#include "engine/part_file.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace binosplat {

// The first `count` bytes of the stream in a gzip file, or fewer if it is shorter, without advancing the
// file; empty for other files.
std::vector<std::byte> peekGzip(InputFile& file, std::size_t count);

class GzipReader {
public:
    explicit GzipReader(InputFile& file);
    ~GzipReader();
    GzipReader(const GzipReader&) = delete;
    GzipReader& operator=(const GzipReader&) = delete;

    // Fills `target` as far as the stream goes and returns how many bytes it gave. Throws Error if the stream
    // is broken or the file ends.
    std::size_t read(std::span<std::byte> target);
    // Continues with the next stream after one has ended; false if the file ends there, too.
    bool next();

private:
    struct State;
    bool fill();  // false: the file has ended
    InputFile& file_;
    std::unique_ptr<State> state_;
};

class GzipWriter {
public:
    explicit GzipWriter(PartFile& file);
    ~GzipWriter();
    GzipWriter(const GzipWriter&) = delete;
    GzipWriter& operator=(const GzipWriter&) = delete;

    void write(std::span<const std::byte> bytes);
    void finish();

private:
    void deflateAll(bool last);
    struct State;
    PartFile& file_;
    std::unique_ptr<State> state_;
};

}  // namespace binosplat
