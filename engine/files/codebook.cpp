// Works on sorted numbers: a cluster is a range of them, and its mean comes from the difference of two sums.
#include "engine/files/codebook.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kSize = 256;
constexpr std::size_t kMostSamples = std::size_t{1} << 22;
constexpr std::size_t kStartCells = 4096;
// How many values a cell may have at first, so that an outlier does not take them all.
constexpr double kMostPerCell = 4.0;
constexpr int kIterations = 100;

// Evenly picked, in ascending order, including the least and the largest.
std::vector<float> sortedSamples(std::span<const float> numbers) {
    std::vector<float> samples;
    if (numbers.size() <= kMostSamples) {
        samples.assign(numbers.begin(), numbers.end());
    } else {
        samples.reserve(kMostSamples + 2);
        const auto [least, largest] = std::ranges::minmax(numbers);
        samples = {least, largest};
        for (std::size_t i = 0; i < kMostSamples; ++i) {
            samples.push_back(numbers[i * numbers.size() / kMostSamples]);
        }
    }
    std::ranges::sort(samples);
    return samples;
}

// Where clusters end at first. The best quantizer's values are as dense as the cube root of the numbers'
// density (Panter and Dite 1951); over cells with equally many numbers, that is each cell's width to the
// power of two thirds.
std::vector<std::size_t> startEnds(const std::vector<float>& sorted, std::size_t size) {
    const std::size_t cells = std::min(kStartCells, sorted.size());
    const auto edge = [&](std::size_t cell) { return cell * (sorted.size() - 1) / cells; };
    std::vector<double> weights(cells);
    for (std::size_t i = 0; i < cells; ++i) {
        const double width = static_cast<double>(sorted[edge(i + 1)]) - static_cast<double>(sorted[edge(i)]);
        weights[i] = std::cbrt(width * width);
    }
    for (int round = 0; round < 30; ++round) {
        const double most =
            std::accumulate(weights.begin(), weights.end(), 0.0) * kMostPerCell / static_cast<double>(size);
        for (double& weight : weights) { weight = std::min(weight, most); }
    }
    std::vector<double> sums(cells + 1, 0.0);
    std::partial_sum(weights.begin(), weights.end(), sums.begin() + 1);
    std::vector<std::size_t> ends(size, sorted.size());
    for (std::size_t k = 0, cell = 0; k + 1 < size; ++k) {
        while (cell < cells &&
               sums[cell] * static_cast<double>(size) < sums[cells] * static_cast<double>(k + 1)) {
            ++cell;
        }
        ends[k] = edge(cell);
    }
    return ends;
}

// At most `size` values, ascending.
std::vector<float> findValues(std::span<const float> numbers, std::size_t size) {
    const std::vector<float> sorted = sortedSamples(numbers);
    std::vector<float> values = sorted;
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.size() <= size && numbers.size() <= kMostSamples) { return values; }

    values.assign(size, 0.0f);
    std::vector<double> sums(sorted.size() + 1, 0.0);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        sums[i + 1] = sums[i] + static_cast<double>(sorted[i]);
    }
    std::vector<std::size_t> ends = startEnds(sorted, size);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        for (std::size_t k = 0, begin = 0; k < size; begin = std::max(begin, ends[k]), ++k) {
            // A cluster without numbers stays where the next one begins.
            values[k] =
                begin < ends[k]
                    ? static_cast<float>((sums[ends[k]] - sums[begin]) / static_cast<double>(ends[k] - begin))
                    : sorted[std::min(begin, sorted.size() - 1)];
        }
        bool moved = false;
        for (std::size_t k = 0; k + 1 < size; ++k) {
            const float border = 0.5f * values[k] + 0.5f * values[k + 1];
            const auto end = static_cast<std::size_t>(std::upper_bound(sorted.begin(), sorted.end(), border) -
                                                      sorted.begin());
            moved = moved || end != ends[k];
            ends[k] = end;
        }
        if (!moved) { break; }
    }
    std::ranges::sort(values);
    return values;
}

}  // namespace

Codebook::Codebook(std::span<const float> numbers, std::optional<float> apart) {
    std::vector<float> values = numbers.empty() ? std::vector<float>{apart.value_or(0.0f)}
                                                : findValues(numbers, apart ? kSize - 1 : kSize);
    if (apart && !numbers.empty()) { values.insert(values.begin(), *apart); }
    values.resize(kSize, values.back());
    std::ranges::copy(values, values_.begin());
    for (std::size_t k = 0; k + 1 < kSize; ++k) { borders_[k] = 0.5f * values_[k] + 0.5f * values_[k + 1]; }
}

std::uint8_t Codebook::nearest(float number) const {
    return static_cast<std::uint8_t>(std::lower_bound(borders_.begin(), borders_.end(), number) -
                                     borders_.begin());
}

}  // namespace binosplat
