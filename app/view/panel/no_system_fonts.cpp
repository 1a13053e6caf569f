// Where the system does not tell which fonts have which letters.
#include "app/view/panel/system_fonts.h"

namespace binosplat {

std::vector<SystemFont> fontsWith(const std::set<std::uint32_t>&) { return {}; }

}  // namespace binosplat
