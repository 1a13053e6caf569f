// A PNG and a line of text for each scene.
#include "app/view/scenes/seen_scenes.h"

#include "app/view/settings/view_files.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/setup/output_files.h"
#include "engine/setup/text_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace binosplat {

Image makeScenePicture(const Image& view) {
    // The largest part of that aspect ratio around the middle.
    const glm::dvec2 whole(view.size_px), wanted(kScenePicturePx);
    const double shrink = std::min(whole.x / wanted.x, whole.y / wanted.y);
    const glm::dvec2 part = shrink * wanted, low = 0.5 * (whole - part);
    Image small{kScenePicturePx, 3, {}};
    for (glm::uint y = 0; y < kScenePicturePx.y; ++y) {
        for (glm::uint x = 0; x < kScenePicturePx.x; ++x) {
            const auto rangeOf = [&](glm::uint at, glm::length_t axis) {
                const auto from = static_cast<std::size_t>(std::max(low[axis] + shrink * at, 0.0));
                const auto to = static_cast<std::size_t>(low[axis] + shrink * (at + 1));
                const std::size_t most = view.size_px[axis];
                return std::pair(std::min(from, most - 1),
                                 std::clamp(to, std::min(from, most - 1) + 1, most));
            };
            const auto [left, right] = rangeOf(x, 0);
            const auto [top, bottom] = rangeOf(y, 1);
            glm::dvec3 sum(0.0);
            for (std::size_t j = top; j < bottom; ++j) {
                for (std::size_t i = left; i < right; ++i) {
                    const float* pixel = view.values.data() +
                                         (j * view.size_px.x + i) * static_cast<std::size_t>(view.channels);
                    sum += glm::dvec3(pixel[0], pixel[1], pixel[2]);
                }
            }
            sum /= static_cast<double>((right - left) * (bottom - top));
            for (int channel = 0; channel < 3; ++channel) {
                small.values.push_back(std::isfinite(sum[channel])
                                           ? static_cast<float>(std::clamp(sum[channel], 0.0, 1.0))
                                           : 0.0f);
            }
        }
    }
    return small;
}

void keepSeenScene(const std::string& scene, const Image& picture, const std::string& about) {
    try {
        const std::filesystem::path stem = viewFileStem(scene);
        OutputFiles files(stem.parent_path());
        writePicture(files.staging() / stem.filename(), PictureKind::kDisplay, picture);
        writeText(files.staging() / (stem.filename().string() + ".txt"), about + "\n");
        files.publish();
    } catch (const Error&) {}  // there will be another time
}

SeenScene findSeenScene(const std::string& scene) {
    SeenScene seen;
    try {
        const std::string stem = viewFileStem(scene).string(),
                          file = stem + extensionOf(PictureKind::kDisplay);
        std::error_code error;
        const auto written = std::filesystem::last_write_time(file, error);
        if (error) { return seen; }
        seen.about = readTextFile(stem + ".txt", "a line about a scene");
        seen.about = seen.about.substr(0, seen.about.find('\n'));
        const Image picture = readPicture(file);
        if (picture.size_px != kScenePicturePx || picture.channels < 3) { return seen; }
        seen.picture.file = file;
        seen.picture.key = fmt::format("{} {}", file, written.time_since_epoch().count());
        for (std::size_t i = 0; i < picture.pixelCount(); ++i) {
            const float* pixel = picture.values.data() + i * static_cast<std::size_t>(picture.channels);
            for (int channel = 0; channel < 3; ++channel) {
                seen.picture.rgba.push_back(
                    static_cast<unsigned char>(std::lround(255.0f * std::clamp(pixel[channel], 0.0f, 1.0f))));
            }
            seen.picture.rgba.push_back(255);
        }
    } catch (const Error&) {}  // treated as never shown
    return seen;
}

}  // namespace binosplat
