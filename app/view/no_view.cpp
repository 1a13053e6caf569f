// `binosplat view` in a build without OpenXR.
#include "app/view/view.h"

#include "engine/error.h"

namespace binosplat {

void runView(const ViewOptions&) {
    throw Error(ExitCode::kNoDevice, "the OpenXR viewer is not part of this build; use `binosplat render`");
}

}  // namespace binosplat
