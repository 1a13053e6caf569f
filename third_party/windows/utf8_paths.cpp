// Makes libstdc++ take narrow texts for UTF-8 where it makes paths of them. It goes by mbrtowc, which
// Microsoft's old C library lets turn letter by letter; linked with --wrap=mbrtowc.
#include <cstddef>
#include <cstdint>
#include <cwchar>

namespace {

// The low half of a letter beyond 16 bits is kept here while its last byte is outstanding.
static_assert(sizeof(std::mbstate_t) >= sizeof(std::uint16_t));

constexpr auto kWrong = static_cast<std::size_t>(-1), kMissing = static_cast<std::size_t>(-2);

std::size_t lengthOf(unsigned char first) {
    if (first < 0x80) { return 1; }
    if (first >= 0xc2 && first <= 0xdf) { return 2; }
    if (first >= 0xe0 && first <= 0xef) { return 3; }
    return first >= 0xf0 && first <= 0xf4 ? 4 : 0;
}

}  // namespace

extern "C" std::size_t __wrap_mbrtowc(wchar_t* target, const char* bytes, std::size_t most,
                                      std::mbstate_t* state) {
    if (bytes == nullptr) { return 0; }
    if (most == 0) { return kMissing; }
    if (state != nullptr && *state != 0) {
        if (target != nullptr) { *target = static_cast<wchar_t>(*state); }
        *state = 0;
        return 1;
    }
    const auto byteAt = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    const std::size_t length = lengthOf(byteAt(0));
    if (length == 0) { return kWrong; }
    if (length > most) { return kMissing; }
    std::uint32_t letter = length == 1 ? byteAt(0) : byteAt(0) & (0x7fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byteAt(i) & 0xc0) != 0x80) { return kWrong; }
        letter = letter << 6 | (byteAt(i) & 0x3f);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (letter < kLeast[length] || letter > 0x10ffff || (letter >= 0xd800 && letter <= 0xdfff)) {
        return kWrong;
    }
    if (letter < 0x10000) {
        if (target != nullptr) { *target = static_cast<wchar_t>(letter); }
        return letter == 0 ? 0 : length;
    }
    // UTF-16 takes two: the second comes with the last byte.
    if (state == nullptr) { return kWrong; }
    if (target != nullptr) { *target = static_cast<wchar_t>(0xd7c0 + (letter >> 10)); }
    *state = static_cast<std::mbstate_t>(0xdc00 | (letter & 0x3ff));
    return length - 1;
}
