// Working on the shaders while the viewer runs: compiled from their sources, and only if all of them compile.
#pragma once

#include "engine/gpu/context.h"

#include <filesystem>
#include <functional>
#include <string>

namespace binosplat {

// Where the sources are: `folder` if it is not empty, else BINOSPLAT_SHADERS of the environment. Empty:
// reloading is off.
std::filesystem::path shaderFolder(const std::filesystem::path& folder);

// Compiles every shader of `folder` with glslang. Throws Error with file, line and reason of the first that
// does not compile.
ShaderWords compileShaders(const std::filesystem::path& folder);

// Compiles them, replaces the context's shaders and calls `rebuild`, which remakes all kernels. If either
// fails, everything stays as it was. Returns the outcome in one line. Structs that shaders share with C++
// (shaders/shared) must be those of the build.
std::string reloadShaders(const Context& context, const std::filesystem::path& folder,
                          const std::function<void()>& rebuild);

}  // namespace binosplat
