// The version that `binosplat --version` prints.
#pragma once

namespace binosplat {

extern const char* const kVersion;

}  // namespace binosplat
