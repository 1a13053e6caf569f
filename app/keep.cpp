// Cameras, the device, and how many splats fit into a file.
#include "app/keep.h"

#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"
#include "engine/scene/pick_splats.h"
#include "engine/setup/camera_file.h"
#include "engine/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace binosplat {

namespace {

// Some of the cameras, evenly chosen, with no more pixels than other views have.
std::vector<Eye> eyesOfCameras(const std::string& file, const Scene& scene) {
    const std::vector<FileCamera> cameras = readCameraFile(file, scene.origin);
    check(!cameras.empty(), "{}: has no cameras, expected at least one", file);
    const std::size_t count = std::min(cameras.size(), kJudgingViews);
    std::vector<Eye> eyes;
    for (std::size_t i = 0; i < count; ++i) {
        const Eye& eye = cameras[i * cameras.size() / count].eye;
        const double scale =
            std::min(1.0, static_cast<double>(kJudgingSidePx) / std::max(eye.size_px.x, eye.size_px.y));
        eyes.push_back(
            resize(eye, glm::max(glm::uvec2(glm::round(scale * glm::dvec2(eye.size_px))), glm::uvec2(1))));
    }
    return eyes;
}

constexpr int kMostTries = 6;
constexpr double kAlmost = 0.95;  // of the size: close enough

// How many splats make a file of that size, or slightly less: found by writing them unchanged.
std::uint64_t countThatFits(const Scene& scene, const ThinOut& thin_out, double bytes,
                            const SceneTarget& target) {
    const TemporaryFolder folder("binosplat-keep", "to see how many splats fit into a file");
    const std::string file = (folder.path() / "some").string() + target.extension;
    double count = static_cast<double>(scene.size()), fits = 0.0;
    for (int tries = 0; tries < kMostTries && count >= 1.0; ++tries) {
        target.write(pickSplats(scene, thin_out.choose(static_cast<std::uint64_t>(count))), file, {});
        const auto size = static_cast<double>(std::filesystem::file_size(file));
        if (size <= bytes) { fits = std::max(fits, count); }
        if (size <= bytes && (size >= kAlmost * bytes || count >= static_cast<double>(scene.size()))) {
            break;
        }
        count = std::min(std::floor(count * 0.985 * bytes / size), static_cast<double>(scene.size()));
    }
    return static_cast<std::uint64_t>(fits);
}

}  // namespace

std::vector<Eye> judgingEyes(const ConvertOptions& options, const Scene& scene) {
    return options.cameras_file.empty() ? standingEyes(scene) : eyesOfCameras(options.cameras_file, scene);
}

JudgedScene::JudgedScene(const ConvertOptions& options, const Scene& scene)
    : scene_(scene), context_({.device = options.device}) {
    thin_out_ = std::make_unique<ThinOut>(context_, scene, judgingEyes(options, scene), usualNear(scene),
                                          ProgressLine("judging " + options.scene).progress());
}

std::uint64_t JudgedScene::countOf(const Keep& keep, const SceneTarget& target) const {
    const auto all = static_cast<double>(scene_.size());
    if (keep.unit == Keep::kSplats) { return static_cast<std::uint64_t>(std::min(keep.amount, all)); }
    if (keep.unit == Keep::kShare) {
        return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(keep.amount * all)));
    }
    const std::uint64_t count = countThatFits(scene_, *thin_out_, keep.amount, target);
    check(count > 0, "--keep is {} bytes, too few for a single splat of {} in {}", keep.amount, scene_.name,
          target.extension);
    return count;
}

Scene JudgedScene::keep(std::uint64_t count) {
    return thin_out_->keep(count, ProgressLine("fitting the kept splats").progress());
}

}  // namespace binosplat
