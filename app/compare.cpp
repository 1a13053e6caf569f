// `binosplat compare`: the difference between two pictures, with the same scores as `bench`, or between the
// frames of two paths.
#include "app/commands.h"
#include "app/scores/flip.h"
#include "app/scores/lpips.h"
#include "app/scores/metrics.h"
#include "app/scores/ssim.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

Image readColours(const std::filesystem::path& file) {
    Image picture = readPicture(file);
    check(picture.channels >= 3, "{}: number of channels is {}, must be 3 or more", file.string(),
          picture.channels);
    return picture;
}

std::pair<Image, Image> readBoth(const std::filesystem::path& first, const std::filesystem::path& second) {
    std::pair<Image, Image> both{readColours(first), readColours(second)};
    const glm::uvec2 a_px = both.first.size_px, b_px = both.second.size_px;
    check(a_px == b_px, "{}: has {}x{} pixels, must have {}x{} like {}", second.string(), b_px.x, b_px.y,
          a_px.x, a_px.y, first.string());
    return both;
}

// The pictures that `render --path` leaves in a folder, frame by frame, for each eye.
std::map<std::string, std::vector<std::string>> framesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::vector<std::string>> frames;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("frame_")) { frames[name.substr(name.rfind('_'))].push_back(name); }
    }
    for (auto& [eye, names] : frames) { std::ranges::sort(names); }
    return frames;
}

// Both eyes count equally, since they have the same number of frames.
void compareFrames(const std::filesystem::path& first, const std::filesystem::path& second) {
    const auto frames = framesIn(first);
    check(!frames.empty(), "{}: has no frames of a path (frame_000000_...)", first.string());
    Difference worst;
    double squares = 0.0, changes_a = 0.0, changes_b = 0.0;
    std::size_t pictures = 0;
    ProgressLine progress("comparing");
    for (const auto& [eye, names] : frames) {
        std::pair<Image, Image> before;
        for (const std::string& name : names) {
            progress.show(static_cast<double>(pictures) / static_cast<double>(frames.size() * names.size()));
            std::pair<Image, Image> now = readBoth(first / name, second / name);
            const Difference difference = compare(now.first, now.second);
            squares += difference.mean_square;
            if (difference.mean_square >= worst.mean_square) { worst = difference; }
            if (!before.first.values.empty()) {
                changes_a += compare(now.first, before.first).mean_square;
                changes_b += compare(now.second, before.second).mean_square;
            }
            before = std::move(now);
            ++pictures;
        }
    }
    const Difference mean{.values = 1, .mean_square = squares / static_cast<double>(pictures)};
    const double change = changes_a == changes_b ? 1.0 : std::sqrt(changes_a / changes_b);
    fmt::print("pictures {}\npsnr {:.6f}\npsnr_least {:.6f}\nchange {:.6f}\n", pictures, mean.psnrDb(),
               worst.psnrDb(), change);
}

}  // namespace

void runCompare(const CompareOptions& options) {
    if (std::filesystem::is_directory(options.first) && std::filesystem::is_directory(options.second)) {
        compareFrames(options.first, options.second);
        return;
    }
    const auto [a, b] = readBoth(options.first, options.second);
    const std::optional<Lpips> lpips =
        options.lpips_weights.empty() ? std::nullopt : std::optional<Lpips>(options.lpips_weights);
    std::string scores;  // printed together or not at all
    const auto add = [&](const char* name, double value) {
        scores += fmt::format("{} {:.6f}\n", name, value);
    };
    {
        ProgressLine progress("comparing");
        add("psnr", compare(a, b).psnrDb());
        progress.show(0.1);
        add("ssim", ssim(a, b).mean().value());
        progress.show(0.3);
        add("flip", flip(a, b, options.pixels_per_degree).mean().value());
        progress.show(0.6);
        if (lpips) { add("lpips", lpips->measure(a, b)); }
    }
    fmt::print("{}", scores);
}

}  // namespace binosplat
