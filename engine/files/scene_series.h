// The frames of a moving scene: numbered files of one format in a folder.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

// True if `source` is such a folder; false for a folder that counts as something else: SOG, streamed or not,
// or the output of a training run.
bool isMovingScene(const std::string& source);

class SceneSeries {
public:
    // Throws Error if `source` is not one, if it has two possible groups of numbered files, or if the folder
    // cannot be read.
    explicit SceneSeries(const std::string& source);

    [[nodiscard]] const std::string& name() const { return name_; }
    // The number of frames. A number that is missing from an otherwise regular sequence also counts as a
    // frame, which shows the same scene as the frame before it.
    [[nodiscard]] std::size_t size() const { return frames_.size(); }
    // Files.
    [[nodiscard]] std::size_t sceneCount() const { return scenes_.size(); }
    // The scene that a frame shows.
    [[nodiscard]] std::size_t sceneOf(std::size_t frame) const { return frames_[frame]; }
    [[nodiscard]] const std::string& nameOf(std::size_t scene) const { return scenes_[scene]; }
    // The size of the largest file relative to the first, at least 1: all that is known of splat counts
    // before all files are read.
    [[nodiscard]] double growth() const { return growth_; }
    // What a user should know, one sentence each.
    [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

    // On any thread. Throws Error if the file is broken, or has another format than the first.
    [[nodiscard]] Scene load(std::size_t scene, LoadNotes& notes, const Progress& progress = {}) const;

private:
    std::string name_, format_;
    // The first file's origin is used for all; otherwise the scene would jump.
    glm::dvec3 origin_{0.0};
    std::vector<std::string> scenes_;  // files
    std::vector<std::size_t> frames_;
    double growth_ = 1.0;
    std::vector<std::string> lines_;
};

}  // namespace binosplat
