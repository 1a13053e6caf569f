// A compiler of shaders that takes what nobody changed from the build, where the viewer's own command made it: 19 runs of glslang are
// seconds of processor time.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

// Writes it into `folder`, which is to stand first in PATH. Lines of the shell may follow each shader, whose $name and file, $last, they
// know.
inline void writeCompilerOfChangedShaders(const std::filesystem::path& folder, const std::string& then = "") {
    std::filesystem::create_directory(folder);
    const std::filesystem::path compiler = folder / "glslangValidator";
    std::ofstream(compiler) << "#!/bin/sh\nfor word; do case $last in -o) out=$word ;; esac; last=$word; done\n"
                               "name=$(basename $last .comp)\n"
                               "if cmp -s $last '" BINOSPLAT_SOURCE_DIR "/shaders/'*/$name.comp; then cp '" BINOSPLAT_BUILD
                               "/shaders/embedded/'$name.spv $out; else PATH=${PATH#*:} glslangValidator \"$@\"; fi\n"
                               "status=$?\n" +
                                   then + "exit $status\n";
    std::filesystem::permissions(compiler, std::filesystem::perms::owner_all);
}

}  // namespace binosplat::test
