// `binosplat compare`: the difference of two pictures, in the same scores as `bench`.
#include "app/commands.h"
#include "app/scores/flip.h"
#include "app/scores/lpips.h"
#include "app/scores/metrics.h"
#include "app/scores/ssim.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"

#include <filesystem>
#include <optional>
#include <string>

namespace binosplat {

namespace {

Image readColours(const std::filesystem::path& file) {
    Image picture = readPicture(file);
    check(picture.channels >= 3, "{}: number of channels is {}, must be 3 or more", file.string(), picture.channels);
    return picture;
}

}  // namespace

void runCompare(const CompareOptions& options) {
    const Image a = readColours(options.first), b = readColours(options.second);
    check(a.size_px == b.size_px, "{}: has {}x{} pixels, must have {}x{} like {}", options.second.string(), b.size_px.x, b.size_px.y,
          a.size_px.x, a.size_px.y, options.first.string());
    const std::optional<Lpips> lpips = options.lpips_weights.empty() ? std::nullopt : std::optional<Lpips>(options.lpips_weights);
    std::string scores;  // printed together or not at all
    const auto add = [&](const char* name, double value) { scores += fmt::format("{} {:.6f}\n", name, value); };
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
