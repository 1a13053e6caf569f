// Other programs that tests run. If one is missing, its tests are visibly skipped; if the environment
// variable CI is set, as in .ci/run after installing them all, that is a failure.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

inline bool isInstalled(const std::string& program, const std::string& package) {
    if (std::system(("command -v " + program + " > /dev/null").c_str()) == 0) { return true; }
    const std::string missing = program + " is not installed (" + package + ")";
    const char* const ci = std::getenv("CI");
    if (ci != nullptr && *ci != '\0') {
        FAIL_CHECK(missing);
    } else {
        MESSAGE("skipped: " << missing);
    }
    return false;
}

}  // namespace binosplat::test
