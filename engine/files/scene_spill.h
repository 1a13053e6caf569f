// Scenes that wait on the disk.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace binosplat {

class SceneSpill {
public:
    // In a folder that is made, and gone with this. Throws Error if it cannot be.
    explicit SceneSpill(std::filesystem::path folder);
    SceneSpill(const SceneSpill&) = delete;
    SceneSpill& operator=(const SceneSpill&) = delete;
    ~SceneSpill();

    // Behind what was added as this scene before, which may have other bands. Throws Error where there is no room.
    void add(std::size_t scene, const Scene& part);
    [[nodiscard]] Scene read(std::size_t scene) const;

private:
    [[nodiscard]] std::string fileOf(std::size_t scene) const;

    std::filesystem::path folder_;
    std::vector<std::vector<Scene>> parts_;  // of each scene, without their splats
};

}  // namespace binosplat
