// What `binosplat --version` says.
#pragma once

namespace binosplat {

extern const char* const kVersion;

}  // namespace binosplat
