// FLIP: colours after the eye's contrast sensitivity, compared in Lab; raised where edges or points differ.
#include "app/scores/flip.h"

#include "app/scores/colour.h"
#include "engine/error.h"
#include "engine/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace binosplat {

namespace {

// The paper's constants: exponents of the colour and the feature difference, the knee of the colour map, the
// width of features in degrees.
constexpr float kColourExponent = 0.7f, kFeatureExponent = 0.5f;  // q_c, q_f
constexpr float kKneeDifference = 0.4f, kKneeScore = 0.95f;       // p_c, p_t
constexpr double kFeatureWidth_deg = 0.082;                       // w
constexpr std::size_t kBlock = 65536;                             // pixels a thread converts at a time

// One term a sqrt(pi/b) exp(-pi^2 d^2 / b) of a channel's contrast sensitivity, d in degrees (the paper's
// table 1).
struct SensitivityTerm {
    double a, b;
};
constexpr SensitivityTerm kAchromatic{1.0, 0.0047}, kRedGreen{1.0, 0.0053}, kBlueYellow{34.1, 0.04},
    kBlueYellowNarrow{13.5, 0.025};

double sigmaOf(const SensitivityTerm& term, double pixels_per_degree) {
    return pixels_per_degree * std::sqrt(term.b / (2.0 * std::numbers::pi * std::numbers::pi));
}

// All channels' filters reach to three sigma of the widest.
int sensitivityRadius(double pixels_per_degree) {
    return static_cast<int>(std::ceil(3.0 * sigmaOf(kBlueYellow, pixels_per_degree)));
}

// The sum of a term's weights over the filter's square.
double weightOf(const SensitivityTerm& term, double pixels_per_degree) {
    const double sigma = sigmaOf(term, pixels_per_degree);
    const int radius = sensitivityRadius(pixels_per_degree);
    double sum = 0.0;
    for (int x = -radius; x <= radius; ++x) { sum += std::exp(-x * x / (2.0 * sigma * sigma)); }
    return term.a * std::sqrt(std::numbers::pi / term.b) * sum * sum;
}

// Scales the positive weights to a sum of 1 and the negative ones to -1.
Weights balance(const std::vector<double>& weights) {
    double above = 0.0, below = 0.0;
    for (const double weight : weights) { (weight > 0.0 ? above : below) += std::abs(weight); }
    Weights kernel;
    for (const double weight : weights) {
        kernel.push_back(static_cast<float>(weight / (weight > 0.0 ? above : below)));
    }
    return kernel;
}

// Gaussian, and its first and second derivative, along one axis.
struct FeatureKernels {
    Weights smooth, edge, point;
};

FeatureKernels makeFeatureKernels(double pixels_per_degree) {
    const double sigma = 0.5 * kFeatureWidth_deg * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<double> edge, point;
    for (int x = -radius; x <= radius; ++x) {
        const double bell = std::exp(-x * x / (2.0 * sigma * sigma));
        edge.push_back(-x * bell);
        point.push_back((x * x / (sigma * sigma) - 1.0) * bell);
    }
    return {gaussianKernel(sigma, radius), balance(edge), balance(point)};
}

using Planes = std::array<Plane, 3>;

// Calls convert(pixel) for all pixels, on some threads.
template <typename Convert>
void forPixels(std::size_t count, int threads, const Convert& convert) {
    forBlocks(count, kBlock, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) { convert(pixel); }
    });
}

Planes makePlanes(glm::uvec2 size_px) {
    Planes planes;
    planes.fill({size_px, std::vector<float>(std::size_t{size_px.x} * size_px.y)});
    return planes;
}

glm::vec3 pixelOf(const Planes& planes, std::size_t pixel) {
    return {planes[0].values[pixel], planes[1].values[pixel], planes[2].values[pixel]};
}

void setPixel(Planes& planes, std::size_t pixel, const glm::vec3& value) {
    for (int i = 0; i < 3; ++i) { planes[static_cast<std::size_t>(i)].values[pixel] = value[i]; }
}

// R, G and B if all are finite.
bool readRgb(const Image& image, std::size_t pixel, glm::vec3& rgb) {
    const float* values = image.values.data() + pixel * static_cast<std::size_t>(image.channels);
    bool finite = true;
    for (int i = 0; i < 3; ++i) {
        finite = finite && std::isfinite(values[i]);
        rgb[i] = std::isfinite(values[i]) ? std::clamp(values[i], 0.0f, 1.0f) : 0.0f;
    }
    return finite;
}

// L*a*b* of a colour the display can show, with the chroma that is seen at its lightness (the Hunt effect;
// the paper's equation 4).
glm::vec3 huntLab(const glm::vec3& linear) {
    const glm::vec3 lab = labFromXyz(xyzFromLinear(glm::clamp(linear, 0.0f, 1.0f)));
    return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z};
}

// HyAB distance to the power q_c.
float hyabPower(const glm::vec3& a, const glm::vec3& b) {
    return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), kColourExponent);
}

// The largest difference the paper maps to 1: green against blue.
float largestDifference() { return hyabPower(huntLab({0.0f, 1.0f, 0.0f}), huntLab({0.0f, 0.0f, 1.0f})); }

// Differences up to the knee share 0 to 0.95, those beyond it the rest.
float colourScore(float difference, float largest) {
    const float knee = kKneeDifference * largest;
    if (difference < knee) { return kKneeScore / knee * difference; }
    return std::min(1.0f, kKneeScore + (difference - knee) / (largest - knee) * (1.0f - kKneeScore));
}

// A picture as the eye perceives it: Hunt-adjusted Lab after contrast sensitivity, and the strength of edges
// and points.
struct Seen {
    Planes lab;
    Plane edges, points;
};

Plane magnitudeOf(const Plane& grey, const Weights& derivative, const Weights& smooth, int threads) {
    Plane along_x = filterPlane(grey, derivative, smooth, Border::kClamp, threads);
    const Plane along_y = filterPlane(grey, smooth, derivative, Border::kClamp, threads);
    for (std::size_t i = 0; i < along_x.values.size(); ++i) {
        const float x = along_x.values[i], y = along_y.values[i];
        along_x.values[i] = std::sqrt(x * x + y * y);
    }
    return along_x;
}

Seen see(const Image& image, double pixels_per_degree, int threads) {
    Seen seen{makePlanes(image.size_px), {}, {}};
    Planes& planes = seen.lab;
    forPixels(image.pixelCount(), threads, [&](std::size_t pixel) {
        glm::vec3 rgb;
        readRgb(image, pixel, rgb);
        setPixel(planes, pixel, ycxczFromXyz(xyzFromLinear(linearFromEncoded(rgb))));
    });
    Plane grey = planes[0];
    for (float& value : grey.values) { value = (value + 16.0f) / 116.0f; }
    const FeatureKernels kernels = makeFeatureKernels(pixels_per_degree);
    seen.edges = magnitudeOf(grey, kernels.edge, kernels.smooth, threads);
    seen.points = magnitudeOf(grey, kernels.point, kernels.smooth, threads);

    const auto blur = [&](const Plane& plane, const SensitivityTerm& term) {
        const Weights kernel =
            gaussianKernel(sigmaOf(term, pixels_per_degree), sensitivityRadius(pixels_per_degree));
        return filterPlane(plane, kernel, kernel, Border::kClamp, threads);
    };
    const double wide = weightOf(kBlueYellow, pixels_per_degree),
                 narrow = weightOf(kBlueYellowNarrow, pixels_per_degree);
    const float share = static_cast<float>(wide / (wide + narrow));
    const Plane blue_narrow = blur(planes[2], kBlueYellowNarrow);
    planes = {blur(planes[0], kAchromatic), blur(planes[1], kRedGreen), blur(planes[2], kBlueYellow)};
    forPixels(image.pixelCount(), threads, [&](std::size_t pixel) {
        glm::vec3 ycxcz = pixelOf(planes, pixel);
        ycxcz.z = share * ycxcz.z + (1.0f - share) * blue_narrow.values[pixel];
        setPixel(planes, pixel, huntLab(linearFromXyz(xyzFromYcxcz(ycxcz))));
    });
    return seen;
}

}  // namespace

double pixelsPerDegree(double focal_px) { return focal_px * std::numbers::pi / 180.0; }

float flipColourDifference(const glm::vec3& linear_a, const glm::vec3& linear_b) {
    return colourScore(hyabPower(huntLab(linear_a), huntLab(linear_b)), largestDifference());
}

PixelScores flip(const Image& a, const Image& b, double pixels_per_degree, int threads) {
    requireComparable(a, b);
    check(pixels_per_degree >= kFlipLeastPixelsPerDegree && pixels_per_degree <= kFlipMostPixelsPerDegree,
          "FLIP: pixels per degree is {}, must be from {} to {}", pixels_per_degree,
          kFlipLeastPixelsPerDegree, kFlipMostPixelsPerDegree);
    const Seen seen_a = see(a, pixels_per_degree, threads), seen_b = see(b, pixels_per_degree, threads);
    const float largest = largestDifference();
    PixelScores scores{a.size_px, std::vector<float>(a.pixelCount())};
    forPixels(a.pixelCount(), threads, [&](std::size_t pixel) {
        glm::vec3 unused;
        const bool finite = readRgb(a, pixel, unused) && readRgb(b, pixel, unused);
        const float colour =
            colourScore(hyabPower(pixelOf(seen_a.lab, pixel), pixelOf(seen_b.lab, pixel)), largest);
        const float edge = std::abs(seen_a.edges.values[pixel] - seen_b.edges.values[pixel]);
        const float point = std::abs(seen_a.points.values[pixel] - seen_b.points.values[pixel]);
        const float feature =
            std::min(1.0f, std::pow(std::max(edge, point) / std::numbers::sqrt2_v<float>, kFeatureExponent));
        scores.values[pixel] = finite ? std::pow(colour, 1.0f - feature) : 1.0f;
    });
    return scores;
}

}  // namespace binosplat
