// An empty folder for a test's files, removed with the test. For tests that are independent of the engine,
// whose tests have Workplace.
#pragma once

#include "tests/suite.h"

#include <unistd.h>

namespace simulated {

// A headset's file, whose last table may continue.
inline const std::string kHeadsetToml =
    "name = \"n\"\nsource = \"s\"\nsize = \"100x100\"\ncanting_deg = 0\neye_distance_m = 0.06\n"
    "[left]\nleft = -40\nright = 40\nup = 40\ndown = -40\n[right]\nleft = -40\nright = 40\nup = 40\ndown = "
    "-40\n";

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("binosplat_simulated_" + std::to_string(::getpid()));

    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::string bytesOf(const std::string& name) const {
        return binosplat::test::textIn(path / name);
    }
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path)) {
            names.insert(entry.path().filename().string());
        }
        return names;
    }
};
struct InFolder {
    const Folder folder;
};

}  // namespace simulated
