// Order statistics along axes, and a grid as a sorted list of cells.
#include "app/summary/survey.h"

#include "app/summary/describe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace binosplat {

namespace {

constexpr std::array<double, 3> kShares{0.05, 0.5, 0.95};
constexpr std::int64_t kFurthestCell = std::int64_t{1} << 20;  // 21 bits along each axis

void findExtent(const Scene& scene, SceneSurvey& survey) {
    std::vector<float> values(scene.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(scene.positions, values.begin(),
                               [&](const glm::vec3& position) { return position[axis]; });
        const auto [low, median, high] = findQuantiles(values, kShares);
        survey.middle[axis] = static_cast<double>(median);
        survey.size = std::max(survey.size, static_cast<double>(high) - static_cast<double>(low));
    }
    std::ranges::transform(scene.positions, values.begin(), [&](const glm::vec3& position) {
        return static_cast<float>(glm::distance(glm::dvec3(position), survey.middle));
    });
    survey.half_radius = static_cast<double>(findQuantiles(values, kShares)[1]);
}

float longestAxis(const Scene& scene, std::size_t i) {
    return std::max(scene.scales[i].x, scene.scales[i].y);
}

bool canBeSeen(const Scene& scene, std::size_t i) { return scene.opacities[i] >= 1.0f / 255.0f; }

using Cell = std::array<std::int64_t, 3>;

std::uint64_t keyOf(const Cell& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t along : cell) {
        key = key << 21 | static_cast<std::uint64_t>(along + kFurthestCell);
    }
    return key;
}

// Which cells are in use, and by how many visible splats.
class Grid {
public:
    Grid(const Scene& scene, const SceneSurvey& survey)
        : middle_(survey.middle), side_(kCellShare * survey.size) {
        std::vector<std::uint64_t> keys;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            if (canBeSeen(scene, i)) { keys.push_back(keyOf(cellOf(scene.positions[i]))); }
        }
        std::ranges::sort(keys);
        for (const std::uint64_t key : keys) {
            if (keys_.empty() || keys_.back() != key) { keys_.push_back(key), counts_.push_back(0); }
            ++counts_.back();
        }
    }

    [[nodiscard]] Cell cellOf(const glm::vec3& position) const {
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis) {
            // Leaves space for its neighbours' cells.
            constexpr auto kFurthest = static_cast<double>(kFurthestCell - 2);
            const double along = (static_cast<double>(position[axis]) - middle_[axis]) / side_;
            cell[static_cast<std::size_t>(axis)] =
                static_cast<std::int64_t>(std::floor(std::clamp(along, -kFurthest, kFurthest)));
        }
        return cell;
    }
    [[nodiscard]] std::uint64_t countIn(const Cell& cell) const {
        const std::uint64_t key = keyOf(cell);
        const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
        return found != keys_.end() && *found == key
                   ? counts_[static_cast<std::size_t>(found - keys_.begin())]
                   : 0;
    }

private:
    glm::dvec3 middle_;
    double side_;
    std::vector<std::uint64_t> keys_, counts_;
};

bool isLonely(const Grid& grid, const Cell& cell) {
    std::uint64_t near = grid.countIn(cell);
    for (int i = 0; i < 27 && near < kFewNeighbours; ++i) {
        if (i != 13) {
            near += grid.countIn({cell[0] + i / 9 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i % 3 - 1});
        }
    }
    return near < kFewNeighbours;
}

}  // namespace

SceneSurvey surveyScene(const Scene& scene, double metres_per_unit) {
    SceneSurvey survey;
    if (scene.size() == 0) { return survey; }
    findExtent(scene, survey);
    const auto thin = static_cast<float>(kThinMetres / metres_per_unit),
               large = static_cast<float>(kLargeShare * survey.size),
               cell = static_cast<float>(kCellShare * survey.size);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const float shortest =
            scene.isGaussian3d() ? scene.thicknesses[i] : std::min(scene.scales[i].x, scene.scales[i].y);
        survey.transparent += !canBeSeen(scene, i);
        survey.opaque += scene.opacities[i] > 0.99f;
        survey.thin += shortest < thin;
        survey.large += survey.size > 0.0 && longestAxis(scene, i) > large;
    }
    if (!(survey.size > 0.0)) { return survey; }  // all in one place
    const Grid grid(scene, survey);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        survey.floaters += canBeSeen(scene, i) && longestAxis(scene, i) <= cell &&
                           isLonely(grid, grid.cellOf(scene.positions[i]));
    }
    return survey;
}

}  // namespace binosplat
