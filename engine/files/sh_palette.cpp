// Plain k-means, comparing every splat with every entry, would take hours. A tree of splits gives the first
// clusters; then each splat looks for a nearer entry among the neighbours of its own in the tree's order.
#include "engine/files/sh_palette.h"

#include "engine/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>
#include <span>
#include <thread>

namespace binosplat {

namespace {

constexpr std::size_t kMostNumbers = 45;
constexpr std::size_t kAxisSamples = 2048;  // of a cluster, for the axis along which it is split
constexpr std::size_t kNeighbours = 256;    // entries with which a splat is compared
constexpr int kRefinements = 6;
constexpr double kSplittingShare = 0.6;  // of the time

// The rows to cluster.
struct Rows {
    const float* first;
    std::size_t stride, width;

    [[nodiscard]] const float* operator[](std::uint32_t splat) const { return first + splat * stride; }
};

using Vector = std::array<double, kMostNumbers>;

// Splats order[begin] to order[end - 1].
struct Cluster {
    double error = 0.0;  // sum of squared distances from the mean
    std::size_t begin = 0, end = 0;
    Vector mean{};

    bool operator<(const Cluster& other) const { return error < other.error; }
};

Cluster measure(const Rows& rows, std::span<const std::uint32_t> order, std::size_t begin, std::size_t end) {
    Cluster cluster;
    cluster.begin = begin, cluster.end = end;
    Vector squares{};
    for (std::size_t i = begin; i < end; ++i) {
        const float* row = rows[order[i]];
        for (std::size_t k = 0; k < rows.width; ++k) {
            const auto value = static_cast<double>(row[k]);
            cluster.mean[k] += value;
            squares[k] += value * value;
        }
    }
    const auto count = static_cast<double>(end - begin);
    for (std::size_t k = 0; k < rows.width; ++k) {
        cluster.mean[k] /= count;
        cluster.error += std::max(squares[k] - count * cluster.mean[k] * cluster.mean[k], 0.0);
    }
    return cluster;
}

// The direction in which a cluster is longest: two steps of power iteration, starting with the number that
// varies most.
std::array<float, kMostNumbers> longestAxis(const Rows& rows, std::span<const std::uint32_t> order,
                                            const Cluster& cluster) {
    const std::size_t step = (cluster.end - cluster.begin + kAxisSamples - 1) / kAxisSamples;
    Vector spread{}, axis{};
    for (std::size_t i = cluster.begin; i < cluster.end; i += step) {
        const float* row = rows[order[i]];
        for (std::size_t k = 0; k < rows.width; ++k) {
            spread[k] += std::pow(static_cast<double>(row[k]) - cluster.mean[k], 2);
        }
    }
    axis[static_cast<std::size_t>(std::ranges::max_element(spread) - spread.begin())] = 1.0;
    for (int iteration = 0; iteration < 2; ++iteration) {
        Vector next{};
        for (std::size_t i = cluster.begin; i < cluster.end; i += step) {
            const float* row = rows[order[i]];
            double along = 0.0;
            for (std::size_t k = 0; k < rows.width; ++k) {
                along += (static_cast<double>(row[k]) - cluster.mean[k]) * axis[k];
            }
            for (std::size_t k = 0; k < rows.width; ++k) {
                next[k] += (static_cast<double>(row[k]) - cluster.mean[k]) * along;
            }
        }
        const double length = std::sqrt(std::inner_product(next.begin(), next.end(), next.begin(), 0.0));
        if (!(length > 0.0)) { break; }
        for (std::size_t k = 0; k < rows.width; ++k) { axis[k] = next[k] / length; }
    }
    std::array<float, kMostNumbers> rounded{};
    std::ranges::transform(axis, rounded.begin(), [](double value) { return static_cast<float>(value); });
    return rounded;
}

// Moves those below the mean to the front, and returns where the others begin.
std::size_t split(const Rows& rows, std::span<std::uint32_t> order, const Cluster& cluster) {
    const std::array<float, kMostNumbers> axis = longestAxis(rows, order, cluster);
    std::array<float, kMostNumbers> mean{};
    std::ranges::transform(cluster.mean, mean.begin(),
                           [](double value) { return static_cast<float>(value); });
    const auto isBefore = [&](std::uint32_t splat) {
        const float* row = rows[splat];
        float along = 0.0f;
        for (std::size_t k = 0; k < rows.width; ++k) { along += (row[k] - mean[k]) * axis[k]; }
        return along < 0.0f;
    };
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(cluster.begin),
               last = order.begin() + static_cast<std::ptrdiff_t>(cluster.end);
    return static_cast<std::size_t>(std::partition(first, last, isBefore) - order.begin());
}

// Splits the cluster with the largest error until there are `most`; in the splats' order.
std::vector<Cluster> grow(const Rows& rows, std::span<std::uint32_t> order, std::size_t most,
                          const Progress& progress) {
    std::priority_queue<Cluster> open;
    std::vector<Cluster> done;
    open.push(measure(rows, order, 0, order.size()));
    while (!open.empty() && open.size() + done.size() < most) {
        if (progress && open.size() % 512 == 0) {
            progress(kSplittingShare * static_cast<double>(open.size() + done.size()) /
                     static_cast<double>(most));
        }
        const Cluster cluster = open.top();
        open.pop();
        const std::size_t middle = cluster.error > 0.0 ? split(rows, order, cluster) : cluster.begin;
        if (middle == cluster.begin || middle == cluster.end) {
            done.push_back(cluster);  // all are equal
            continue;
        }
        open.push(measure(rows, order, cluster.begin, middle));
        open.push(measure(rows, order, middle, cluster.end));
    }
    for (; !open.empty(); open.pop()) { done.push_back(open.top()); }
    std::ranges::sort(done, {}, &Cluster::begin);
    return done;
}

// Which of at most kNeighbours entries, `first` to `end`, is nearest to a row; `columns` has the entries
// number by number.
std::size_t nearest(const float* row, std::size_t width, const std::vector<float>& columns,
                    std::size_t count) {
    std::array<float, kNeighbours> distances{};
    for (std::size_t k = 0; k < width; ++k) {
        const float* column = columns.data() + k * kNeighbours;
        const float value = row[k];
        for (std::size_t i = 0; i < kNeighbours; ++i) {
            const float difference = column[i] - value;
            distances[i] += difference * difference;
        }
    }
    return static_cast<std::size_t>(
        std::min_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count)) -
        distances.begin());
}

// One step of Lloyd's algorithm within each window of adjacent entries; windows begin at `offset`.
void refine(const Rows& rows, std::span<const std::uint32_t> splats, std::size_t first_entry,
            std::size_t offset, int threads, ShPalette& palette) {
    const std::size_t entries = palette.size() - first_entry;
    const auto windowOf = [&](std::uint32_t splat) {
        return (palette.labels[splat] - first_entry + offset) / kNeighbours;
    };
    const std::size_t windows = (entries + offset + kNeighbours - 1) / kNeighbours;
    std::vector<std::uint32_t> order(splats.size());
    sortByBucket(splats, std::span(order), windows, threads, windowOf);
    std::vector<std::size_t> starts(windows + 1, 0);
    for (const std::uint32_t splat : order) { ++starts[windowOf(splat) + 1]; }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());

    forBlocks(windows, 1, threads, [&](std::size_t window, std::size_t) {
        const std::size_t begin = first_entry + (window == 0 ? 0 : window * kNeighbours - offset),
                          end = first_entry + std::min(entries, (window + 1) * kNeighbours - offset);
        std::vector<float> columns(rows.width * kNeighbours, 0.0f);
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < rows.width; ++k) {
                columns[k * kNeighbours + i - begin] = palette.entries[i * rows.width + k];
            }
        }
        std::vector<Vector> sums(end - begin, Vector{});
        std::vector<std::uint32_t> counts(end - begin, 0);
        for (std::size_t i = starts[window]; i < starts[window + 1]; ++i) {
            const float* row = rows[order[i]];
            const std::size_t entry = nearest(row, rows.width, columns, end - begin);
            palette.labels[order[i]] = static_cast<std::uint16_t>(begin + entry);
            ++counts[entry];
            for (std::size_t k = 0; k < rows.width; ++k) { sums[entry][k] += static_cast<double>(row[k]); }
        }
        for (std::size_t i = begin; i < end; ++i) {
            if (counts[i - begin] == 0) { continue; }
            for (std::size_t k = 0; k < rows.width; ++k) {
                palette.entries[i * rows.width + k] =
                    static_cast<float>(sums[i - begin][k] / counts[i - begin]);
            }
        }
    });
}

}  // namespace

ShPalette makeShPalette(const Scene& scene, std::size_t most_entries, const Progress& progress) {
    const auto stride = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
    const Rows rows{scene.sh.data() + 3, stride, stride - 3};
    const int threads = static_cast<int>(std::thread::hardware_concurrency());
    ShPalette palette;
    palette.coefficients = rows.width / 3;
    palette.labels.resize(scene.size(), 0);

    std::vector<std::uint32_t> splats;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
        if (std::any_of(rows[i], rows[i] + rows.width, [](float value) { return value != 0.0f; })) {
            splats.push_back(i);
        }
    }
    const std::size_t zeros = splats.size() < scene.size() && most_entries > 1 ? 1 : 0;
    palette.entries.resize(zeros * rows.width, 0.0f);
    if (splats.empty()) {
        palette.entries.resize(rows.width, 0.0f);
        return palette;
    }
    for (const Cluster& cluster : grow(rows, splats, most_entries - zeros, progress)) {
        const std::size_t entry = palette.size();
        for (std::size_t i = cluster.begin; i < cluster.end; ++i) {
            palette.labels[splats[i]] = static_cast<std::uint16_t>(entry);
        }
        std::transform(cluster.mean.begin(), cluster.mean.begin() + static_cast<std::ptrdiff_t>(rows.width),
                       std::back_inserter(palette.entries),
                       [](double value) { return static_cast<float>(value); });
    }
    for (int i = 0; i < kRefinements; ++i) {
        if (progress) { progress(kSplittingShare + (1.0 - kSplittingShare) * i / kRefinements); }
        refine(rows, splats, zeros, i % 2 == 0 ? 0 : kNeighbours / 2, threads, palette);
    }
    return palette;
}

}  // namespace binosplat
