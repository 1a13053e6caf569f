// Pictures that somebody took, as files.
#pragma once

#include "engine/picture/image.h"

#include <ctime>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// "garden-2026-05-31-142530" for a picture of a file, a folder, an address or a built-in scene.
std::string pictureName(const std::string& scene, const std::tm& when);

// Writes pictures on a thread of its own: frames must not wait for files.
class PictureWriter {
public:
    // Begins to write one eye's picture, or both side by side, into the user's folder of pictures. Waits for
    // the previous picture.
    void begin(std::vector<Image> eyes, const std::string& scene);
    // The name of a picture that has been written since, or why it was not; once.
    [[nodiscard]] std::optional<std::string> takeOutcome();
    // The same, but waits for it.
    [[nodiscard]] std::optional<std::string> finish();

private:
    std::future<std::string> under_way_;
};

}  // namespace binosplat
