// Where the shared test scenes lie. Tests that need them say so and are skipped, visibly, where they are absent.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace binosplat::test {

// BINOSPLAT_TEST_DATA if set, otherwise ../shared/data beside the checkout.
inline std::optional<std::filesystem::path> sharedData() {
    const char* chosen = std::getenv("BINOSPLAT_TEST_DATA");
    const std::filesystem::path folder =
        chosen != nullptr ? std::filesystem::path(chosen) : std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "../shared/data";
    if (!std::filesystem::is_directory(folder)) {
        MESSAGE("skipped: no shared test scenes at " << folder.string() << " (set BINOSPLAT_TEST_DATA)");
        return std::nullopt;
    }
    return folder;
}

}  // namespace binosplat::test
