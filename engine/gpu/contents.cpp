// Parts of memory in order.
#include "engine/gpu/contents.h"

#include <iterator>

namespace binosplat {

void Contents::fill(std::uint64_t begin, std::uint64_t bytes, Content content) {
    if (bytes == 0) { return; }
    const std::uint64_t end = begin + bytes;
    auto part = parts_.lower_bound(begin);
    if (part != parts_.begin()) {
        // The part that begins before is cut off, and continues behind if it is longer.
        Part& before = std::prev(part)->second;
        if (before.end > end) { part = parts_.emplace(end, before).first; }
        if (before.end > begin) { before.end = begin; }
    }
    while (part != parts_.end() && part->first < end) {
        if (part->second.end > end) { parts_.emplace(end, part->second); }
        part = parts_.erase(part);
    }
    parts_[begin] = {end, content};
}

bool Contents::hold(std::uint64_t begin, std::uint64_t bytes, Content content) const {
    if (bytes == 0) { return true; }
    auto part = parts_.upper_bound(begin);
    if (part != parts_.begin() && std::prev(part)->second.end > begin) { --part; }
    for (; part != parts_.end() && part->first < begin + bytes; ++part) {
        if (part->second.content != content) { return false; }
    }
    return true;
}

}  // namespace binosplat
