// A shader compiler that takes unchanged shaders from the build, where the viewer would run the real one: 19
// runs of glslang take seconds of processor time.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

// Writes the compiler into `folder`, which must come first in PATH. For each shader, the shell lines `then`
// run afterwards; they can use its $name and its file, $last.
inline void writeCompilerOfChangedShaders(const fs::path& folder, const std::string& then = "") {
    fs::create_directory(folder);
    const fs::path compiler = folder / "glslangValidator";
    std::ofstream(compiler)
        << "#!/bin/sh\nfor word; do case $last in -o) out=$word ;; esac; last=$word; done\n"
           "name=$(basename $last .comp)\n"
           "if cmp -s $last '" BINOSPLAT_SOURCE_DIR "/shaders/'*/$name.comp; then cp '" BINOSPLAT_BUILD
           "/shaders/embedded/'$name.spv $out; else PATH=${PATH#*:} glslangValidator \"$@\"; fi\n"
           "status=$?\n" +
               then + "exit $status\n";
    fs::permissions(compiler, fs::perms::owner_all);
}

}  // namespace binosplat::test
