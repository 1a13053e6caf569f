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

    // Throws Error where there is no room.
    void add(const Scene& scene);
    [[nodiscard]] std::size_t size() const { return parts_.size(); }
    // The scene that was added as the `index`th.
    [[nodiscard]] Scene read(std::size_t index) const;

private:
    [[nodiscard]] std::string fileOf(std::size_t index) const;

    std::filesystem::path folder_;
    std::vector<Scene> parts_;  // without their splats
};

}  // namespace binosplat
