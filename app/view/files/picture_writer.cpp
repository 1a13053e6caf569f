// Writes both eyes side by side.
#include "app/view/files/picture_writer.h"

#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/picture/join.h"
#include "engine/picture/turned.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>

#include <chrono>
#include <new>
#include <utility>

namespace binosplat {

namespace {

// Without its extension; pictures are never overwritten.
std::string freePictureName(const std::filesystem::path& folder) {
    for (int number = 1;; ++number) {
        const std::string name = fmt::format("binosplat-{:04}", number);
        std::error_code ignored;  // if looking fails, writing will fail too, and will say why
        if (!std::filesystem::exists(folder / (name + extensionOf(PictureKind::kDisplay)), ignored)) { return name; }
    }
}

// Returns a message about the outcome.
std::string write(const Image& picture, const std::filesystem::path& folder) {
    try {
        OutputFiles files(folder);
        const auto written = writePicture(files.staging() / freePictureName(folder), PictureKind::kDisplay, picture);
        files.publish();
        return "picture " + written.front().filename().string();
    } catch (const Error& error) { return error.what(); } catch (const std::bad_alloc&) {
        return "the picture cannot be written: there is not enough memory";
    }
}

}  // namespace

void PictureWriter::begin(StereoFrame& frame, const std::vector<Eye>& pictures, const std::vector<Eye>& views,
                          const std::filesystem::path& folder) {
    if (under_way_.valid()) { under_way_.wait(); }
    std::vector<Image> images;
    for (std::size_t e = 0; e < views.size(); ++e) { images.push_back(frame.readPicture(static_cast<int>(e))); }
    under_way_ = std::async(std::launch::async, [images = std::move(images), pictures, views, folder] {
        const auto seen = [&](std::size_t e) { return showTurned(images[e], pictures[e], views[e]); };
        return write(views.size() == 1 ? seen(0) : besideOneAnother(seen(0), seen(1)), folder);
    });
}

std::optional<std::string> PictureWriter::takeOutcome() {
    const bool is_done = under_way_.valid() && under_way_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return is_done ? std::optional(under_way_.get()) : std::nullopt;
}

std::optional<std::string> PictureWriter::finish() { return under_way_.valid() ? std::optional(under_way_.get()) : std::nullopt; }

}  // namespace binosplat
