// Next chains and strings in UTF-8, checked.
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr int kLongestChain = 64;

// How many bytes follow this leading byte, -1 if it cannot lead. Overlong forms and surrogates are left to
// the check below.
int followersOf(unsigned char lead) {
    if (lead < 0x80) { return 0; }
    if (lead >= 0xC2 && lead < 0xE0) { return 1; }
    if (lead >= 0xE0 && lead < 0xF0) { return 2; }
    if (lead >= 0xF0 && lead < 0xF5) { return 3; }
    return -1;
}

bool isUtf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const int followers = followersOf(lead);
        if (followers < 0 || i + followers >= text.size()) { return false; }
        std::uint32_t code = followers == 0 ? lead : lead & (0x3F >> followers);
        for (int k = 1; k <= followers; ++k) {
            const auto byte = static_cast<unsigned char>(text[i + k]);
            if ((byte & 0xC0) != 0x80) { return false; }
            code = code << 6 | (byte & 0x3F);
        }
        constexpr std::uint32_t kLeast[4] = {0, 0x80, 0x800, 0x10000};
        if (code < kLeast[followers] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) {
            return false;
        }
        i += followers + 1;
    }
    return true;
}

}  // namespace

void checkChain(const void* next) {
    int length = 0;
    for (auto* link = static_cast<const XrBaseInStructure*>(next); link != nullptr; link = link->next) {
        require(++length <= kLongestChain, XR_ERROR_VALIDATION_FAILURE, "a next chain does not end after ",
                kLongestChain, " structures");
    }
}

const XrBaseInStructure* findInChain(const void* next, XrStructureType type) {
    for (auto* link = static_cast<const XrBaseInStructure*>(next); link != nullptr; link = link->next) {
        if (link->type == type) { return link; }
    }
    return nullptr;
}

std::string makePrintable(std::string_view text) {
    constexpr std::size_t kMost = 300;
    std::string shown("'");
    shown.append(text.substr(0, kMost)).append(text.size() > kMost ? "...'" : "'");
    for (char& letter : shown) {
        if (letter < ' ' || letter > '~') { letter = '?'; }
    }
    return shown;
}

std::string textOf(const char* characters, std::size_t size) {
    const std::size_t length = strnlen(characters, size);
    require(length < size, XR_ERROR_VALIDATION_FAILURE, "a string does not end within its ", size, " bytes");
    if (!isUtf8({characters, length})) {
        refuse(XR_ERROR_VALIDATION_FAILURE, "a string is not UTF-8: ", makePrintable({characters, length}));
    }
    return {characters, length};
}

}  // namespace simulated
