// For systems that do not say which fonts have which letters; words are not shaped.
#include "app/view/panel/formed_words.h"

namespace binosplat {

std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>&) { return {}; }

FormedWords formWords(const std::set<std::u32string>&, std::span<const LoadedFont>, float, std::size_t) {
    return {};
}

}  // namespace binosplat
