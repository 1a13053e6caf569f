// What both eyes see, beside one another, as a file.
#pragma once

#include "engine/frame.h"

#include <filesystem>
#include <string>

namespace binosplat {

// Writes what `frame` rendered last for each of its eyes into `folder`, under a name that is free there, and returns that name.
// Waits for the device. Throws Error if the file cannot be written.
std::string savePicturePair(StereoFrame& frame, bool one_eye, const std::filesystem::path& folder);

}  // namespace binosplat
