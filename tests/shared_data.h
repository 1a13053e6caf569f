// Where the shared test scenes are. A case that needs them is `"its name" * needsSharedData()`: such cases of
// a program are one line of ctest, which is reported as skipped if the scenes are missing.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

inline bool shared_data_is_missing = false;

inline doctest::test_suite needsSharedData() { return doctest::test_suite("shared_data"); }

// BINOSPLAT_TEST_DATA if set, otherwise ../shared/data beside the checkout.
inline std::optional<fs::path> sharedData() {
    const char* chosen = std::getenv("BINOSPLAT_TEST_DATA");
    const fs::path folder =
        chosen != nullptr ? fs::path(chosen) : fs::path(BINOSPLAT_SOURCE_DIR) / "../shared/data";
    if (!fs::is_directory(folder)) {
        shared_data_is_missing = true;
        MESSAGE("skipped: no shared test scenes at " << folder.string() << " (set BINOSPLAT_TEST_DATA)");
        return std::nullopt;
    }
    return folder;
}

}  // namespace binosplat::test
