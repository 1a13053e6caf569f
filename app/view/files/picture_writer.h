// Saves pictures as files.
#pragma once

#include "app/view/files/picture_shot.h"

#include <ctime>
#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace binosplat {

// "garden-2026-05-31-142530" for a picture of a file, a folder, an address or a built-in scene.
std::string pictureName(const std::string& scene, const std::tm& when);

// Takes pictures and saves them, one after another, on a thread of its own, since frames must wait neither
// for the device nor for files.
class PictureWriter {
public:
    // Begins to take one eye's picture, or both side by side, and to save it in the user's pictures folder.
    void begin(PictureShot shot, const std::string& scene);
    // True until that is done; scenes and shaders must stay as they are meanwhile.
    [[nodiscard]] bool isTaking() const { return under_way_.valid() || !waiting_.empty(); }
    // The name of a picture that has been saved, or why it was not; returned once. Throws
    // vk::DeviceLostError.
    [[nodiscard]] std::optional<std::string> takeOutcome();
    // The same, but waits for the picture; empty if there is none.
    [[nodiscard]] std::optional<std::string> finish();

private:
    struct Task {
        PictureShot shot;
        std::string name;
    };
    void beginNext();

    std::deque<Task> waiting_;
    std::future<std::string> under_way_;
};

}  // namespace binosplat
