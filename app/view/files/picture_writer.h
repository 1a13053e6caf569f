// The pictures of both eyes, side by side, as a file.
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
    // Begins to write into `folder`, under a free name, what one or two `views` see of the last pictures of
    // `frame`, which are `pictures`. Waits for the device, and for the previous picture.
    void begin(StereoFrame& frame, const std::vector<Eye>& pictures, const std::vector<Eye>& views, const std::filesystem::path& folder);
    // The name of a picture that has been written since, or why it was not; once.
    [[nodiscard]] std::optional<std::string> takeOutcome();
    // The same, but waits for it.
    [[nodiscard]] std::optional<std::string> finish();

private:
    std::future<std::string> under_way_;
};

}  // namespace binosplat
