// Structures of programs that were compiled against an earlier or later header than this library.
#pragma once

#include "engine/error.h"
#include "engine/library/binosplat.h"

#include <algorithm>
#include <cstring>

namespace binosplat {

// Throws Error unless it is one of this type, and of the size that it had in the first version or more.
void checkHeader(const void* given, bsp_type type, std::size_t first_size, const char* name);

// The fields that this library knows; 0 for those that the program does not know. Throws Error if the program
// sets a field that the library does not know.
template <typename Structure>
Structure readStructure(const Structure* given, bsp_type type, std::size_t first_size, const char* name) {
    checkHeader(given, type, first_size, name);
    Structure known{};
    std::memcpy(&known, given, std::min<std::size_t>(given->size, sizeof(Structure)));
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    for (std::size_t at = sizeof(Structure); at < given->size; ++at) {
        check(
            bytes[at] == 0,
            "{} has {} bytes, and not all are 0 after the {} that this library knows, a later one is needed",
            name, given->size, sizeof(Structure));
    }
    return known;
}

// Fills the fields that the program knows.
template <typename Structure>
void writeStructure(Structure* given, const Structure& known) {
    auto* bytes = reinterpret_cast<unsigned char*>(given);
    const auto* from = reinterpret_cast<const unsigned char*>(&known);
    std::memcpy(bytes + sizeof(bsp_header), from + sizeof(bsp_header),
                std::min<std::size_t>(given->size, sizeof(Structure)) - sizeof(bsp_header));
}

// The structure of this type in the chain of `next`; null if there is none.
const bsp_header* findNext(const void* next, std::uint32_t type);

}  // namespace binosplat
