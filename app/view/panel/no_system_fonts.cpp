// For systems that do not tell which fonts have which letters, and without shaping of words.
#include "app/view/panel/formed_words.h"

namespace binosplat {

std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>&) { return {}; }

FormedWords formWords(const std::set<std::u32string>&, std::span<const LoadedFont>, float, std::size_t) {
    return {};
}

}  // namespace binosplat
