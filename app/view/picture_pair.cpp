// Side by side.
#include "app/view/picture_pair.h"

#include "engine/picture/image_io.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>

namespace binosplat {

namespace {

Image besideOneAnother(const Image& left, const Image& right) {
    Image both{{left.size_px.x + right.size_px.x, left.size_px.y}, left.channels, {}};
    both.values.reserve(left.values.size() + right.values.size());
    const std::size_t row = std::size_t{left.size_px.x} * static_cast<std::size_t>(left.channels);
    for (std::size_t at = 0; at < left.values.size(); at += row) {
        for (const Image* eye : {&left, &right}) {
            const auto begin = eye->values.begin() + static_cast<std::ptrdiff_t>(at);
            both.values.insert(both.values.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
        }
    }
    return both;
}

// Without its extension; pictures are never overwritten.
std::string freePictureName(const std::filesystem::path& folder) {
    for (int number = 1;; ++number) {
        const std::string name = fmt::format("binosplat-{:04}", number);
        std::error_code ignored;  // what cannot be looked at is not written either, and that says why
        if (!std::filesystem::exists(folder / (name + extensionOf(PictureKind::kDisplay)), ignored)) { return name; }
    }
}

}  // namespace

std::string savePicturePair(StereoFrame& frame, bool one_eye, const std::filesystem::path& folder) {
    Image both = frame.readPicture(0);
    if (!one_eye) { both = besideOneAnother(both, frame.readPicture(1)); }
    OutputFiles files(folder);
    const std::string name =
        writePicture(files.staging() / freePictureName(folder), PictureKind::kDisplay, both).front().filename().string();
    files.publish();
    return name;
}

}  // namespace binosplat
