// Numbers and compressed streams as files hold them.
#pragma once

#include "tests/suite.h"

#include <zlib.h>

namespace binosplat::test {

inline std::string littleWord(std::uint64_t value, int bytes = 4) {
    std::string text;
    for (int i = 0; i < bytes; ++i) { text.push_back(static_cast<char>(value >> 8 * i & 0xff)); }
    return text;
}

// Zlib's `window_bits` choose the wrapping: MAX_WBITS + 16 is gzip, -MAX_WBITS is none.
inline std::string deflated(const std::string& bytes, int window_bits, int level = 9) {
    std::string packed(compressBound(static_cast<uLong>(bytes.size())) + 64, '\0');
    z_stream stream{};
    bool done = deflateInit2(&stream, level, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) == Z_OK;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    done = done && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (!done) { throw std::runtime_error("zlib does not compress"); }
    return packed;
}

}  // namespace binosplat::test
