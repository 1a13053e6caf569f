// Headers of structures.
#include "engine/library/structures.h"

namespace binosplat {

void checkHeader(const void* given, bsp_type type, std::size_t first_size, const char* name) {
    check(given != nullptr, "{} is null", name);
    bsp_header header;
    std::memcpy(&header, given, sizeof(header));
    check(header.type == static_cast<std::uint32_t>(type), "{} has the type {}, must be {}", name,
          header.type, static_cast<int>(type));
    check(header.size >= first_size && header.size < 65536, "{} has the size {}, must be at least {}", name,
          header.size, first_size);
}

const bsp_header* findNext(const void* next, std::uint32_t type) {
    while (next != nullptr) {
        const auto* header = static_cast<const bsp_header*>(next);
        if (header->type == type) { return header; }
        next = header->next;
    }
    return nullptr;
}

}  // namespace binosplat
