// Operations in frames that may wait, as counted by two layers (tests/faults/waits.h).
#pragma once

#include "tests/app/view/view_acts.h"

namespace binosplat::test {

inline const std::string kWatched =
    "XDG_CONFIG_HOME=\"$PWD/../config\" DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 "
    "VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
    "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults XR_API_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
    "/openxr' XR_ENABLE_API_LAYERS=XR_APILAYER_BINOSPLAT_faults BINOSPLAT_FAULT_WAITS=waits.txt "
    "BINOSPLAT_FAULT_TICKS=1";  // frames take no time, so none is drawn smaller to save time

// For each frame, what it did that may wait.
inline std::vector<std::set<std::string>> waitsOf(const Workplace& work) {
    std::vector<std::set<std::string>> kinds;
    std::ifstream file(work.path / "waits.txt");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string number, kind, count;
        words >> number;
        CHECK(number == std::to_string(kinds.size()));
        kinds.emplace_back();
        while (words >> kind >> count) { kinds.back().insert(kind); }
    }
    return kinds;
}

inline std::string listed(const std::set<std::string>& kinds) {
    return fmt::format("{}", fmt::join(kinds, " "));
}

// No frame but the first ones waited or made anything.
inline void checkQuiet(const Workplace& work, std::size_t first_frames = 45) {
    const std::vector<std::set<std::string>> waits = waitsOf(work);
    REQUIRE(waits.size() > first_frames + 45);
    for (std::size_t frame = first_frames; frame < waits.size(); ++frame) {
        CHECK_MESSAGE(waits[frame].empty(), frame, ": ", listed(waits[frame]));
    }
}

}  // namespace binosplat::test
