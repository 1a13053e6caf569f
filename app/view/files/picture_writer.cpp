// Names, folders, and a thread for saving pictures.
#include "app/view/files/picture_writer.h"

#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/picture/join.h"
#include "engine/platform.h"
#include "engine/ready.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;  // in bytes, of a scene

// Pictures are never overwritten: the second one within a second is "NAME-2".
std::string freeName(const fs::path& folder, const std::string& name) {
    for (int number = 1;; ++number) {
        const std::string numbered = number == 1 ? name : fmt::format("{}-{}", name, number);
        std::error_code ignored;  // if this fails, writing will fail too, and will say why
        if (!fs::exists(folder / (numbered + extensionOf(PictureKind::kDisplay)), ignored)) {
            return numbered;
        }
    }
}

// Returns a message about the outcome.
std::string write(const PictureShot& shot, const std::string& name) {
    try {
        const std::vector<Image> eyes = shot.take();
        const fs::path folder = userPicturesFolder();
        check(!folder.empty(),
              "the picture cannot be written: there is no folder for pictures, since HOME is not set");
        OutputFiles files(folder);
        const Image picture = eyes.size() == 1 ? eyes.front() : besideOneAnother(eyes[0], eyes[1]);
        const auto written =
            writePicture(files.staging() / freeName(folder, name), PictureKind::kDisplay, picture);
        files.publish();
        return "picture " + (folder / written.front().filename()).string();
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        return fmt::format("the picture cannot be rendered: {}", error.what());
    } catch (const Error& error) { return error.what(); } catch (const std::bad_alloc&) {
        return "the picture cannot be written: there is not enough memory";
    }
}

}  // namespace

std::string pictureName(const std::string& scene, const std::tm& when) {
    const auto lastPart = [](std::string path) {
        while (!path.empty() && (path.back() == '/' || path.back() == '\\')) { path.pop_back(); }
        const std::size_t slash = path.find_last_of("/\\:");
        return slash == std::string::npos ? std::pair(std::string(), path)
                                          : std::pair(path.substr(0, slash), path.substr(slash + 1));
    };
    auto [folder, name] = lastPart(scene);
    // A file name that all folders of a kind use says nothing.
    if (name == "meta.json" || name == "lod-meta.json" || name == "point_cloud.ply") {
        name = lastPart(folder).second;
    }
    if (const std::size_t dot = name.rfind('.'); dot != std::string::npos && dot > 0) { name.resize(dot); }
    for (char& letter : name) {  // Windows allows no others in names
        if (static_cast<unsigned char>(letter) < 0x20 ||
            std::string_view("<>\"|?*").find(letter) != std::string_view::npos) {
            letter = '_';
        }
    }
    std::size_t bytes = std::min(name.size(), kLongestName);
    while (bytes > 0 && bytes < name.size() && (static_cast<unsigned char>(name[bytes]) & 0xc0) == 0x80) {
        --bytes;
    }
    name.resize(bytes);
    return fmt::format("{}{}{:04}-{:02}-{:02}-{:02}{:02}{:02}", name, name.empty() ? "" : "-",
                       when.tm_year + 1900, when.tm_mon + 1, when.tm_mday, when.tm_hour, when.tm_min,
                       when.tm_sec);
}

void PictureWriter::begin(PictureShot shot, const std::string& scene) {
    const std::time_t now = std::time(nullptr);
    waiting_.push_back({std::move(shot), pictureName(scene, *std::localtime(&now))});
    beginNext();
}

void PictureWriter::beginNext() {
    if (under_way_.valid() || waiting_.empty()) { return; }
    under_way_ = std::async(std::launch::async,
                            [task = std::move(waiting_.front())] { return write(task.shot, task.name); });
    waiting_.pop_front();
}

std::optional<std::string> PictureWriter::takeOutcome() {
    return isReady(under_way_) ? finish() : std::nullopt;
}

std::optional<std::string> PictureWriter::finish() {
    if (!under_way_.valid()) { return std::nullopt; }
    std::string outcome = under_way_.get();
    beginNext();
    return outcome;
}

}  // namespace binosplat
