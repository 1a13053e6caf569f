// Which stereo modes this build can render.
#include "app/modes.h"

#include "engine/error.h"

namespace binosplat {

Mode frameMode(const std::string& name) {
    if (name == "mono") { return Mode::kMono; }
    if (name == "two-pass") { return Mode::kTwoPass; }
    if (name == "shared") { return Mode::kShared; }
    fail("mode {} is not available in this build yet; use mono, two-pass or shared", name);
}

}  // namespace binosplat
