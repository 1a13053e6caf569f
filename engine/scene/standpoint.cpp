// Judged in axes of the wearer's own: right, up along the floor's normal, ahead.
#include "engine/scene/standpoint.h"

#include "engine/scene/floor_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kMostSamples = 32768, kMostForRoom = 8192, kFewForRoom = 256;
constexpr int kSectors = 24;
constexpr double kSurrounded = 0.6;  // of the sectors
constexpr double kTallest = 1.3;     // of its width: rooms are not taller
constexpr double kEyeHeightMetres = 1.6;
constexpr double kLeastRoomHeightMetres = 1.8, kHollow = 0.04;
constexpr int kGrid = 15;                           // places to stand that are tried, along either side
constexpr int kCells = 24;                          // of the longest side, to find what is dense
constexpr double kLookDown = 0.45, kLookUp = 0.25;  // tangents

// A sample in the wearer's axes.
struct Spot {
    double x, h, z;  // right, up, ahead
    double reach;
    bool is_floor;
};

struct Axes {
    glm::dvec3 right, up, ahead;
    [[nodiscard]] glm::dvec3 world(double x, double h, double z) const { return x * right + h * up + z * ahead; }
};

Axes axesOf(const glm::dvec3& up, bool y_up) {
    const double side = y_up ? -1.0 : 1.0;
    glm::dvec3 ahead = glm::dvec3(0.0, 0.0, side) - glm::dot(glm::dvec3(0.0, 0.0, side), up) * up;
    // The front of a scene whose z is up is towards -y.
    if (glm::length(ahead) < 0.2) { ahead = glm::dvec3(0.0, 1.0, 0.0) - up.y * up; }
    ahead = glm::normalize(ahead);
    return {glm::normalize(glm::cross(ahead, up)), up, ahead};
}

Axes turned(const Axes& axes, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * axes.right + s * axes.ahead, axes.up, c * axes.ahead - s * axes.right};
}

struct Range {
    double low, high;
    [[nodiscard]] double middle() const { return 0.5 * (low + high); }
    [[nodiscard]] double length() const { return high - low; }
};

template <typename Of>
std::vector<double> valuesOf(const std::vector<Spot>& spots, const Of& of) {
    std::vector<double> values;
    for (const Spot& spot : spots) {
        if (const std::optional<double> value = of(spot)) { values.push_back(*value); }
    }
    return values;
}

Range rangeOf(std::vector<double> values, double beyond) {
    if (values.empty()) { return {0.0, 0.0}; }
    std::ranges::sort(values);
    const std::size_t cut = static_cast<std::size_t>(beyond * static_cast<double>(values.size()));
    return {values[cut], values[values.size() - 1 - cut]};
}

// Without what lies far beyond the rest, such as hills and sky: a landscape has more of it than of what one stands in. Half of the splats
// stay at each step.
std::vector<SplatSample> coreOf(std::vector<SplatSample> samples) {
    if (samples.empty()) { return samples; }
    constexpr double kFar = 4.0, kCore = 3.0;  // times the median distance
    for (int i = 0; i < 4; ++i) {
        glm::dvec3 middle;
        std::vector<double> values(samples.size());
        for (int axis = 0; axis < 3; ++axis) {
            std::ranges::transform(samples, values.begin(), [&](const SplatSample& sample) { return sample.centre[axis]; });
            middle[axis] = findQuantile(values, 0.5);
        }
        const auto distanceOf = [&](const SplatSample& sample) { return glm::distance(sample.centre, middle); };
        std::ranges::transform(samples, values.begin(), distanceOf);
        const double half = findQuantile(values, 0.5);
        if (!(half > 0.0) || findQuantile(values, 0.95) <= kFar * half) { break; }
        std::erase_if(samples, [&](const SplatSample& sample) { return distanceOf(sample) > kCore * half; });
    }
    return samples;
}

// The scene's properties that do not depend on the standpoint.
struct Lie {
    std::vector<Spot> spots;
    Range x, z;              // nine tenths of all
    double floor_h, height;  // of the floor, and of nineteen in twenty of the rest above it
    bool has_floor;
};

Lie lieOf(const std::vector<SplatSample>& samples, const Axes& axes, const std::optional<FloorPlane>& floor) {
    Lie lie{{}, {}, {}, 0.0, 0.0, floor && !floor->is_ceiling};
    for (const SplatSample& sample : samples) {
        const double h = glm::dot(sample.centre, axes.up);
        const bool is_floor = lie.has_floor && std::abs(h - floor->height) < 2.0 * floor->thickness;
        lie.spots.push_back({glm::dot(sample.centre, axes.right), h, glm::dot(sample.centre, axes.ahead), sample.reach, is_floor});
    }
    lie.x = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.x); }), 0.05);
    lie.z = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.z); }), 0.05);
    const Range h = rangeOf(valuesOf(lie.spots, [](const Spot& s) { return std::optional(s.h); }), 0.04);
    lie.floor_h = lie.has_floor ? floor->height : h.low;
    lie.height = h.high - lie.floor_h;
    return lie;
}

// Along its own sides: those about the vertical with the smallest box.
Axes alongSides(const std::vector<SplatSample>& samples, const Axes& axes) {
    constexpr int kTurns = 18;
    const std::size_t step = samples.size() / 2048 + 1;
    Axes best = axes;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kTurns; ++i) {
        const Axes tried = turned(axes, 1.5707963267948966 * i / kTurns);
        std::vector<double> x, z;
        for (std::size_t j = 0; j < samples.size(); j += step) {
            x.push_back(glm::dot(samples[j].centre, tried.right)), z.push_back(glm::dot(samples[j].centre, tried.ahead));
        }
        const double area = rangeOf(std::move(x), 0.05).length() * rangeOf(std::move(z), 0.05).length();
        if (area < 0.98 * least) { least = area, best = tried; }
    }
    return best;
}

// Of the directions about the middle, in how many something stands where the floor ends, or, without a floor, far from the middle; and
// how many there are.
int surroundingSectors(const Lie& lie) {
    struct Sector {
        std::vector<double> floor, standing;
    };
    std::array<Sector, kSectors> sectors;
    std::size_t standing = 0;
    const double middle_x = lie.x.middle(), middle_z = lie.z.middle();
    for (const Spot& spot : lie.spots) {
        const double x = spot.x - middle_x, z = spot.z - middle_z;
        const double turn = (std::atan2(z, x) / 6.283185307179586 + 0.5) * kSectors;
        Sector& sector = sectors[static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kSectors - 1))];
        const double distance = std::hypot(x, z);
        if (spot.is_floor) { sector.floor.push_back(distance); }
        if (!spot.is_floor && spot.h > lie.floor_h + 0.2 * lie.height) { sector.standing.push_back(distance), ++standing; }
    }
    const double least_radius = 0.25 * std::min(lie.x.length(), lie.z.length());
    int surrounding = 0;
    for (Sector& sector : sectors) {
        if (sector.standing.size() * kSectors * 5 < standing || sector.standing.empty()) { continue; }
        const double stands = findQuantile(sector.standing, 0.8);
        const double ends = sector.floor.size() < 8 ? 0.0 : findQuantile(sector.floor, 0.9);
        surrounding += stands >= std::max(0.75 * ends, least_radius);
    }
    return surrounding;
}

// Of what stands on the floor the share that stands within the outermost quarter.
double furnishedShare(const Lie& lie) {
    std::size_t inside = 0, all = 0;
    for (const Spot& spot : lie.spots) {
        if (spot.is_floor) { continue; }
        ++all;
        inside += std::abs(spot.x - lie.x.middle()) < 0.375 * lie.x.length() &&
                  std::abs(spot.z - lie.z.middle()) < 0.375 * lie.z.length() && spot.h > lie.floor_h + 0.08 * lie.height &&
                  spot.h < lie.floor_h + 0.85 * lie.height;
    }
    return all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
}

// True if splats far from the middle are larger than those near it, as they are in scenes captured from inside.
bool growsOutwards(const Lie& lie) {
    const double radius = 0.5 * std::hypot(lie.x.length(), lie.z.length());
    const auto reachAt = [&](double from, double to) {
        return valuesOf(lie.spots, [&](const Spot& spot) -> std::optional<double> {
            const double distance = std::hypot(spot.x - lie.x.middle(), spot.z - lie.z.middle());
            return distance >= from * radius && distance < to * radius ? std::optional(spot.reach) : std::nullopt;
        });
    };
    std::vector<double> near = reachAt(0.0, 0.35), far = reachAt(0.7, 1.5);
    return near.size() > 50 && far.size() > 50 && findQuantile(far, 0.5) > 2.0 * findQuantile(near, 0.5);
}

double eyeHeight(const Lie& lie, double metres_per_unit) {
    const double usual = kEyeHeightMetres / metres_per_unit;
    return usual >= 0.1 * lie.height && usual <= 0.75 * lie.height ? usual : 0.55 * lie.height;
}

bool surrounds(const Lie& lie, int sectors, double metres_per_unit) {
    if (sectors < kSurrounded * kSectors || lie.height > kTallest * std::max(lie.x.length(), lie.z.length())) { return false; }
    if (!lie.has_floor) { return growsOutwards(lie); }
    // An empty room and a box look alike but for their size.
    return furnishedShare(lie) >= kHollow || lie.height * metres_per_unit >= kLeastRoomHeightMetres;
}

// The middle of the densest part of what stands on the floor.
std::optional<glm::dvec3> findDensest(const Lie& lie) {
    const Range h{lie.floor_h, lie.floor_h + lie.height};
    const double side = std::max({lie.x.length(), lie.z.length(), h.length()}) / kCells;
    if (!(side > 0.0)) { return std::nullopt; }
    const auto cellsOf = [&](const Range& range) { return std::max(1, static_cast<int>(std::ceil(range.length() / side))); };
    const std::array<int, 3> cells{cellsOf(lie.x), cellsOf(h), cellsOf(lie.z)};
    std::vector<int> counts(static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]));
    const auto indexOf = [&](int i, int j, int k) { return static_cast<std::size_t>((i * cells[1] + j) * cells[2] + k); };
    const auto cellOf = [&](const Spot& spot) {
        return std::array<int, 3>{static_cast<int>(std::floor((spot.x - lie.x.low) / side)),
                                  static_cast<int>(std::floor((spot.h - h.low) / side)),
                                  static_cast<int>(std::floor((spot.z - lie.z.low) / side))};
    };
    const auto isWithin = [&](const std::array<int, 3>& cell) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (cell[axis] < 0 || cell[axis] >= cells[axis]) { return false; }
        }
        return true;
    };
    for (const Spot& spot : lie.spots) {
        const std::array<int, 3> cell = cellOf(spot);
        if (!spot.is_floor && isWithin(cell)) { ++counts[indexOf(cell[0], cell[1], cell[2])]; }
    }
    int most = 0;
    std::array<int, 3> found{};
    for (int i = 0; i < cells[0]; ++i) {
        for (int j = 0; j < cells[1]; ++j) {
            for (int k = 0; k < cells[2]; ++k) {
                int sum = 0;
                for (int n = 0; n < 27; ++n) {
                    const std::array<int, 3> cell{i + n / 9 - 1, j + n / 3 % 3 - 1, k + n % 3 - 1};
                    if (isWithin(cell)) { sum += counts[indexOf(cell[0], cell[1], cell[2])]; }
                }
                if (sum > most) { most = sum, found = {i, j, k}; }
            }
        }
    }
    if (most == 0) { return std::nullopt; }
    return glm::dvec3(lie.x.low + (found[0] + 0.5) * side, h.low + (found[1] + 0.5) * side, lie.z.low + (found[2] + 0.5) * side);
}

// How far it is from there to what is near, two in a thousand left out.
double clearanceAt(const std::vector<Spot>& spots, double x, double h, double z, std::vector<double>& distances) {
    distances.clear();
    for (const Spot& spot : spots) { distances.push_back(std::hypot(spot.x - x, spot.h - h, spot.z - z) - spot.reach); }
    return findQuantile(distances, 0.002);
}

struct Place {
    glm::dvec3 eye{0.0}, look{0.0};  // right, up, ahead
    double clearance = 0.0;
};

// The best place inside, if there is one with room about it.
std::optional<Place> findPlaceInside(const Lie& lie, double eye_height) {
    const std::optional<glm::dvec3> densest = findDensest(lie);
    if (!densest) { return std::nullopt; }
    const double h = lie.floor_h + eye_height, half = 0.5 * std::min(lie.x.length(), lie.z.length());
    std::vector<Spot> some;
    for (std::size_t i = 0; i < lie.spots.size(); i += lie.spots.size() / kMostForRoom + 1) { some.push_back(lie.spots[i]); }
    const auto medianOf = [&](double Spot::*along) {
        std::vector<double> values = valuesOf(some, [&](const Spot& spot) { return std::optional(spot.*along); });
        return findQuantile(values, 0.5);
    };
    const double median_x = medianOf(&Spot::x), median_z = medianOf(&Spot::z);
    const double enough = std::min(0.35 * half, eye_height);
    std::vector<double> scratch;
    std::optional<Place> best;
    double best_score = -1e300;
    for (int i = 0; i < kGrid * kGrid; ++i) {
        const double x = lie.x.low + lie.x.length() * (i % kGrid + 1) / (kGrid + 1),
                     z = lie.z.low + lie.z.length() * (i / kGrid + 1) / (kGrid + 1);
        const double clearance = clearanceAt(some, x, h, z, scratch);
        const double away = std::hypot(x - median_x, z - median_z) / half, to_dense = std::hypot(x - densest->x, z - densest->z) / half;
        const double score = std::min(clearance / enough, 1.0) - 0.5 * away - std::max(0.0, 0.8 - to_dense);
        if (clearance > 0.15 * enough && score > best_score) { best_score = score, best = Place{{x, h, z}, *densest, clearance}; }
    }
    if (best) {
        const double level = std::hypot(best->look.x - best->eye.x, best->look.z - best->eye.z);
        best->look.y = std::clamp(best->look.y, h - kLookDown * level, h + kLookUp * level);
    }
    return best;
}

std::string nameUp(const StandpointWish& wish, const std::optional<FloorPlane>& floor, bool y_up) {
    if (wish.up) { return ""; }
    if (floor) {
        return fmt::format("; up from the {} that {:.0f} % of the splats lie in", floor->is_ceiling ? "ceiling" : "floor",
                           100.0 * floor->share);
    }
    return fmt::format("; up is {}y, as no floor was found", y_up ? '+' : '-');
}

// From in front, level, or a little from above what stands on a floor.
Standpoint standOutside(const Lie& lie, const Axes& axes, const Scene& scene, double fov_x_deg) {
    std::vector<Spot> object;
    std::ranges::copy_if(lie.spots, std::back_inserter(object), [](const Spot& spot) { return !spot.is_floor; });
    const bool on_floor = lie.has_floor && 5 * object.size() >= lie.spots.size();
    if (!on_floor) { object = lie.spots; }
    const auto along = [&](double Spot::*axis) {
        return rangeOf(valuesOf(object, [&](const Spot& spot) { return std::optional(spot.*axis); }), 0.05);
    };
    const Range x = along(&Spot::x), h = along(&Spot::h), z = along(&Spot::z);
    // A sphere about the common box fills the picture's width; about a point it holds the first splat, and half a unit at least.
    // Where splats lie evenly the tenth that is left out at its ends makes it a ninth longer.
    double radius = 0.5 / 0.9 * glm::length(glm::dvec3(x.length(), h.length(), z.length()));
    const glm::vec2 scale = scene.scales.empty() ? glm::vec2(0.0f) : scene.scales.front();
    const auto first = static_cast<double>(std::max(scale.x, scale.y));
    if (radius <= first) { radius = std::max(3.0 * first, 0.5); }
    const double distance = radius / std::sin(glm::radians(0.5 * std::min(fov_x_deg, 120.0)));
    const double rise = lie.has_floor ? 0.26 : 0.0;  // 15 degrees
    const glm::dvec3 look = axes.world(x.middle(), h.middle(), z.middle());
    const glm::dvec3 eye = look + distance * (std::sin(rise) * axes.up - std::cos(rise) * axes.ahead);
    return {{eye, look, axes.up, fov_x_deg},
            fmt::format("outside: {:.3g} units from the middle of what is {:.3g} units across", distance, 2.0 * radius)};
}

}  // namespace

Standpoint judgeStandpoint(const Scene& scene, const StandpointWish& wish) {
    const glm::dvec3 usual(0.0, scene.y_up ? 1.0 : -1.0, 0.0);
    const std::vector<SplatSample> samples = coreOf(sampleSplats(scene, kMostSamples));
    if (samples.empty()) {
        const glm::dvec3 up = wish.up ? glm::normalize(*wish.up) : usual;
        return {{-axesOf(up, scene.y_up).ahead, {0.0, 0.0, 0.0}, up, wish.fov_x_deg}, "outside: there is nothing to be seen"};
    }
    std::optional<FloorPlane> floor = findFloorPlane(samples, wish.up ? glm::normalize(*wish.up) : usual);
    const glm::dvec3 up = wish.up ? glm::normalize(*wish.up) : floor ? floor->up : usual;
    if (floor && glm::dot(floor->up, up) < 0.98) { floor.reset(); }
    const Axes axes = axesOf(up, scene.y_up);
    const Axes sides = alongSides(samples, axes);
    const Lie lie = lieOf(samples, sides, floor);
    const std::string up_said = nameUp(wish, floor, scene.y_up);
    const int sectors = surroundingSectors(lie);
    if (samples.size() >= kFewForRoom && surrounds(lie, sectors, wish.metres_per_unit)) {
        const double eye_height = eyeHeight(lie, wish.metres_per_unit);
        if (const std::optional<Place> place = findPlaceInside(lie, eye_height)) {
            const auto& [eye, look, clearance] = *place;
            return {
                {sides.world(eye.x, eye.y, eye.z), sides.world(look.x, look.y, look.z), up, wish.fov_x_deg},
                fmt::format("inside: what stands there surrounds its middle in {} of {} directions; {:.3g} units above the floor, {:.3g} "
                            "from the densest part, which is looked at{}",
                            sectors, kSectors, eye_height, glm::length(look - eye), up_said)};
        }
    }
    Standpoint outside = standOutside(lieOf(samples, axes, floor), axes, scene, wish.fov_x_deg);
    outside.why += up_said;
    return outside;
}

double coreSize(const Scene& scene) {
    const std::vector<SplatSample> core = coreOf(sampleSplats(scene, kMostSamples));
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const SplatSample& sample : core) { values.push_back(sample.centre[axis]); }
        size = std::max(size, rangeOf(std::move(values), 0.05).length());
    }
    return size;
}

std::optional<double> floorHeight(const Scene& scene, const glm::dvec3& up) {
    const std::optional<FloorPlane> floor = findFloorPlane(coreOf(sampleSplats(scene, kMostForRoom)), up);
    if (!floor || floor->is_ceiling || glm::dot(floor->up, up) < 0.98) { return std::nullopt; }
    return floor->height;
}

}  // namespace binosplat
