// Lossless WebP files by the simplest means the format has: no transforms, every channel in eight bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace binosplat::test {

// Bits, lowest first.
class BitString {
public:
    void put(std::uint32_t value, int bits) {
        for (int i = 0; i < bits; ++i, ++count_) {
            if (count_ % 8 == 0) { bytes_.push_back('\0'); }
            if ((value >> i & 1u) != 0) { bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) | 1u << count_ % 8); }
        }
    }
    // A Huffman code, which is written from its highest bit down; those of eight bits are the symbols themselves.
    void putSymbol(std::uint8_t symbol) {
        for (int i = 7; i >= 0; --i) { put(symbol >> i & 1u, 1); }
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    int count_ = 0;
};

inline std::string littleWord(std::uint32_t value, int bytes = 4) {
    std::string text;
    for (int i = 0; i < bytes; ++i) { text.push_back(static_cast<char>(value >> 8 * i & 0xff)); }
    return text;
}

// `rgba` has four bytes per pixel; `uses_alpha` is the header's hint.
inline std::string makeWebp(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& rgba, bool uses_alpha = true) {
    BitString bits;
    bits.put(0x2f, 8);
    bits.put(width - 1, 14);
    bits.put(height - 1, 14);
    bits.put(uses_alpha ? 1 : 0, 1);
    bits.put(0, 3);                                   // version
    bits.put(0, 1);                                   // no transform
    bits.put(0, 1);                                   // no colour cache
    bits.put(0, 1);                                   // one set of codes for the whole picture
    for (const int lengths_behind : {24, 0, 0, 0}) {  // green with its 24 length symbols, red, blue, alpha
        bits.put(0, 1);                               // a full code
        bits.put(8, 4);                               // 4 + 8 code length codes, in the order 17 18 0 1 2 3 4 5 16 6 7 8
        for (const std::uint32_t length : {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1}) { bits.put(length, 3); }  // 0 and 8 take a bit each
        bits.put(0, 1);                                                                                   // all symbols follow
        for (int symbol = 0; symbol < 256; ++symbol) { bits.put(1, 1); }                                  // of length 8
        for (int symbol = 0; symbol < lengths_behind; ++symbol) { bits.put(0, 1); }                       // unused
    }
    bits.put(1, 4);  // distances: a simple code of one symbol, 0, in one bit
    for (std::size_t pixel = 0; pixel < rgba.size() / 4; ++pixel) {
        for (const std::size_t channel : {1, 0, 2, 3}) { bits.putSymbol(rgba[4 * pixel + channel]); }
    }
    std::string stream = bits.bytes();
    std::string chunk = "VP8L" + littleWord(static_cast<std::uint32_t>(stream.size())) + stream;
    if (stream.size() % 2 != 0) { chunk.push_back('\0'); }
    return "RIFF" + littleWord(static_cast<std::uint32_t>(4 + chunk.size())) + "WEBP" + chunk;
}

}  // namespace binosplat::test
