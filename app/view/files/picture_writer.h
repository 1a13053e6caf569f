// What both eyes see, beside one another, as a file.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace binosplat {

// Writes pictures on a thread of its own: frames must not wait for files.
class PictureWriter {
public:
    // Begins to write what `frame` rendered last for each of its eyes into `folder`, under a name that is free there. Waits for the device,
    // and for the picture before.
    void begin(StereoFrame& frame, bool one_eye, const std::filesystem::path& folder);
    // The name of a picture that was written since, once, or why it was not.
    [[nodiscard]] std::optional<std::string> takeOutcome();
    // Likewise, waiting for it.
    [[nodiscard]] std::optional<std::string> finish();

private:
    std::future<std::string> under_way_;
};

}  // namespace binosplat
