// LPIPS stage by stage, so that only one stage's features are held at a time.
#include "app/scores/lpips.h"

#include "app/scores/planes.h"
#include "engine/error.h"
#include "engine/parallel.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <utility>

namespace binosplat {

namespace {

static_assert(std::endian::native == std::endian::little, "weights are read as they lie in the file");
static_assert(Lpips::kValues == std::accumulate(SqueezeNet::kStageChannels.begin(),
                                                SqueezeNet::kStageChannels.end(), SqueezeNet::kWeights));

constexpr std::array<float, 3> kMean{-0.030f, -0.088f, -0.188f}, kDeviation{0.458f, 0.448f, 0.450f};
constexpr double kLeastLength = 1e-10;  // prevents a division by zero for a pixel without features

std::vector<float> readWeights(const std::filesystem::path& file) {
    constexpr std::size_t kBytes = Lpips::kValues * sizeof(float);
    std::error_code trouble;
    const std::uintmax_t bytes = std::filesystem::file_size(file, trouble);
    check(!trouble, "{}: cannot be read ({}), must be the weights of LPIPS (SqueezeNet variant, version 0.1)",
          file.string(), trouble.message());
    check(bytes == kBytes,
          "{}: has {} bytes, must have the {} of the weights of LPIPS (SqueezeNet variant, version 0.1)",
          file.string(), bytes, kBytes);
    std::vector<float> values(Lpips::kValues);
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(values.data()), kBytes);
    check(stream.good(), "{}: cannot be read ({})", file.string(), std::strerror(errno));
    for (std::size_t i = 0; i < values.size(); ++i) {
        check(std::isfinite(values[i]), "{}: value {} is {}, must be finite", file.string(), i, values[i]);
    }
    for (std::size_t i = SqueezeNet::kWeights; i < values.size(); ++i) {
        check(values[i] >= 0.0f, "{}: value {} is {}, must not be negative, as it belongs to a head",
              file.string(), i, values[i]);
    }
    return values;
}

// The factor that gives a pixel's features length 1.
double scaleOf(const float* features, std::size_t channels) {
    double squares = 0.0;
    for (std::size_t i = 0; i < channels; ++i) {
        squares += static_cast<double>(features[i]) * static_cast<double>(features[i]);
    }
    return 1.0 / (std::sqrt(squares) + kLeastLength);
}

// Mean over pixels of the weighted squared differences of features of length 1.
double compareFeatures(const Image& a, const Image& b, const std::vector<float>& head, int threads) {
    const std::size_t width = a.size_px.x, channels = head.size();
    std::vector<double> rows(a.size_px.y, 0.0);
    forBlocks(rows.size(), 1, threads, [&](std::size_t y, std::size_t) {
        for (std::size_t x = 0; x < width; ++x) {
            const float* of_a = a.values.data() + (y * width + x) * channels;
            const float* of_b = b.values.data() + (y * width + x) * channels;
            const double scale_a = scaleOf(of_a, channels), scale_b = scaleOf(of_b, channels);
            for (std::size_t i = 0; i < channels; ++i) {
                const double difference =
                    scale_a * static_cast<double>(of_a[i]) - scale_b * static_cast<double>(of_b[i]);
                rows[y] += static_cast<double>(head[i]) * difference * difference;
            }
        }
    });
    return std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(a.pixelCount());
}

bool isFinitePicture(const Image& picture) {
    for (std::size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
        const float* rgb = picture.values.data() + pixel * static_cast<std::size_t>(picture.channels);
        if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2])) { return false; }
    }
    return true;
}

}  // namespace

Image scaleForNetwork(const Image& picture) {
    Image scaled{picture.size_px, 3, {}};
    scaled.values.reserve(3 * picture.pixelCount());
    for (std::size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
        const float* rgb = picture.values.data() + pixel * static_cast<std::size_t>(picture.channels);
        for (std::size_t i = 0; i < 3; ++i) {
            const float value = std::isfinite(rgb[i]) ? std::clamp(rgb[i], 0.0f, 1.0f) : 0.0f;
            scaled.values.push_back((2.0f * value - 1.0f - kMean[i]) / kDeviation[i]);
        }
    }
    return scaled;
}

Lpips::Lpips(const std::filesystem::path& file) : Lpips(readWeights(file), file.string()) {}

Lpips::Lpips(const std::vector<float>& values, const std::string& file)
    : network_(std::span(values).first(SqueezeNet::kWeights)), file_(file) {
    auto head = values.begin() + SqueezeNet::kWeights;
    for (std::size_t stage = 0; stage < heads_.size(); ++stage) {
        const auto channels = static_cast<std::ptrdiff_t>(SqueezeNet::kStageChannels[stage]);
        heads_[stage].assign(head, head + channels);
        head += channels;
    }
}

double Lpips::measure(const Image& a, const Image& b, int threads) const {
    requireComparable(a, b);
    check(std::min(a.size_px.x, a.size_px.y) >= kLpipsLeastSide_px,
          "LPIPS: pictures have {}x{} pixels, must have at least {} on each side", a.size_px.x, a.size_px.y,
          kLpipsLeastSide_px);
    if (!isFinitePicture(a) || !isFinitePicture(b)) { return std::numeric_limits<double>::infinity(); }
    Image of_a = scaleForNetwork(a), of_b = scaleForNetwork(b);
    double distance = 0.0;
    for (std::size_t stage = 0; stage < heads_.size(); ++stage) {
        of_a = network_.runStage(stage, std::move(of_a), threads);
        of_b = network_.runStage(stage, std::move(of_b), threads);
        distance += compareFeatures(of_a, of_b, heads_[stage], threads);
    }
    check(std::isfinite(distance),
          "{}: leads to values that are not finite, must be the weights of LPIPS (SqueezeNet variant, "
          "version 0.1)",
          file_);
    return distance;
}

}  // namespace binosplat
