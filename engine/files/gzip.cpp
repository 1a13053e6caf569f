// zlib, block by block.
#include "engine/files/gzip.h"

#include "engine/error.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <string_view>

namespace binosplat {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
constexpr int kGzipWindow = MAX_WBITS + 16;  // 16: with gzip's header

// zlib's interface is not const-correct and counts in 32 bits.
Bytef* zlibBytes(const std::byte* bytes) { return const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes)); }
uInt zlibCount(std::size_t count) {
    return static_cast<uInt>(std::min<std::size_t>(count, std::numeric_limits<uInt>::max()));
}

}  // namespace

std::vector<std::byte> peekGzip(InputFile& file, std::size_t count) {
    const std::string_view start = file.peek(4096);
    if (!start.starts_with("\x1f\x8b")) { return {}; }
    z_stream stream{};
    if (inflateInit2(&stream, kGzipWindow) != Z_OK) { throw std::bad_alloc(); }
    std::vector<std::byte> bytes(count);
    stream.next_in = zlibBytes(std::as_bytes(std::span(start.data(), start.size())).data());
    stream.avail_in = zlibCount(start.size());
    stream.next_out = zlibBytes(bytes.data());
    stream.avail_out = zlibCount(count);
    inflate(&stream, Z_SYNC_FLUSH);  // whatever it returns, the bytes that came out count
    bytes.resize(count - stream.avail_out);
    inflateEnd(&stream);
    return bytes;
}

struct GzipReader::State {
    z_stream stream{};
    bool ended = false;
};

GzipReader::GzipReader(InputFile& file) : file_(file), state_(std::make_unique<State>()) {
    if (inflateInit2(&state_->stream, kGzipWindow) != Z_OK) { throw std::bad_alloc(); }
}

GzipReader::~GzipReader() { inflateEnd(&state_->stream); }

std::size_t GzipReader::read(std::span<std::byte> target) {
    z_stream& stream = state_->stream;
    std::size_t done = 0;
    while (done < target.size() && !state_->ended) {
        check(fill(), "{}: ends within its gzip stream, at byte {}", file_.name(), file_.positionBytes());
        stream.next_out = zlibBytes(target.data() + done);
        stream.avail_out = zlibCount(target.size() - done);
        const uInt room = stream.avail_out;
        const int result = inflate(&stream, Z_NO_FLUSH);
        done += room - stream.avail_out;
        if (result == Z_MEM_ERROR) { throw std::bad_alloc(); }
        check(result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR,
              "{}: broken gzip stream before byte {} ({})", file_.name(), file_.positionBytes(),
              stream.msg != nullptr ? stream.msg : "no reason given");
        state_->ended = result == Z_STREAM_END;
    }
    return done;
}

bool GzipReader::fill() {
    z_stream& stream = state_->stream;
    if (stream.avail_in > 0) { return true; }
    const std::span<const std::byte> block = file_.readBlock(kBlockBytes);
    // Valid until the next block is requested, after this one is used up.
    stream.next_in = zlibBytes(block.data());
    stream.avail_in = zlibCount(block.size());
    return !block.empty();
}

bool GzipReader::next() {
    // Zeros after a stream are padding, as gzip treats them.
    z_stream& stream = state_->stream;
    while (fill() && *stream.next_in == 0) { ++stream.next_in, --stream.avail_in; }
    if (stream.avail_in == 0) { return false; }
    inflateReset(&stream);
    state_->ended = false;
    return true;
}

struct GzipWriter::State {
    z_stream stream{};
    std::vector<std::byte> block = std::vector<std::byte>(kBlockBytes);
};

GzipWriter::GzipWriter(PartFile& file) : file_(file), state_(std::make_unique<State>()) {
    const int result =
        deflateInit2(&state_->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY);
    if (result != Z_OK) { throw std::bad_alloc(); }
}

GzipWriter::~GzipWriter() { deflateEnd(&state_->stream); }

void GzipWriter::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        state_->stream.next_in = zlibBytes(bytes.data());
        state_->stream.avail_in = zlibCount(bytes.size());
        bytes = bytes.subspan(state_->stream.avail_in);
        deflateAll(false);
    }
}

void GzipWriter::finish() {
    state_->stream.avail_in = 0;
    deflateAll(true);
}

void GzipWriter::deflateAll(bool last) {
    z_stream& stream = state_->stream;
    do {
        stream.next_out = zlibBytes(state_->block.data());
        stream.avail_out = zlibCount(kBlockBytes);
        deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);  // fails only for wrong arguments
        file_.write(state_->block.data(), kBlockBytes - stream.avail_out);
    } while (stream.avail_out == 0);
}

}  // namespace binosplat
