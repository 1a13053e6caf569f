// Scenes kept on the disk for a while.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace binosplat {

class SceneSpill {
public:
    // In a folder that is made for it and removed with it. Throws Error if that cannot be made.
    explicit SceneSpill(std::filesystem::path folder);
    SceneSpill(const SceneSpill&) = delete;
    SceneSpill& operator=(const SceneSpill&) = delete;
    ~SceneSpill();

    // Appends to this scene's earlier parts, which may have other bands. Throws Error if the disk is full.
    void add(std::size_t scene, const Scene& part);
    [[nodiscard]] Scene read(std::size_t scene) const;

private:
    [[nodiscard]] std::string fileOf(std::size_t scene) const;

    std::filesystem::path folder_;
    std::vector<std::vector<Scene>> parts_;  // of each scene, without splats
};

}  // namespace binosplat
