// Judges a place by what is around it, in the wearer's axes.
#include "engine/places/standpoint.h"

#include "engine/places/floor_choice.h"
#include "engine/places/lie.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kMostSamples = 32768, kMostForRoom = 8192, kFewForRoom = 256;
constexpr int kSectors = 24;
constexpr double kSurrounded = 0.6;  // of the sectors
constexpr double kTallest = 1.3;     // of its width: rooms are not taller
constexpr double kEyeHeightMetres = 1.6;
constexpr double kLeastRoomHeightMetres = 1.8, kHollow = 0.04;
constexpr double kMostDense = 0.25;  // around a head, relative to the density of evenly spread splats
constexpr std::size_t kFewInSector = 4;
constexpr int kGrid = 15;                           // places that are tried, along each side
constexpr int kCells = 24;                          // of the longest side, to find dense parts
constexpr double kLookDown = 0.45, kLookUp = 0.25;  // tangents

std::size_t sectorOf(double x, double z) {
    const double turn = (std::atan2(z, x) / 6.283185307179586 + 0.5) * kSectors;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kSectors - 1));
}

// The number of directions around the middle in which something stands where the floor ends or, without a
// floor, far from the middle.
int surroundingSectors(const Lie& lie) {
    struct Sector {
        std::vector<double> floor, standing;
    };
    std::array<Sector, kSectors> sectors;
    std::size_t standing = 0;
    const double middle_x = lie.x.middle(), middle_z = lie.z.middle();
    for (const Spot& spot : lie.spots) {
        const double x = spot.x - middle_x, z = spot.z - middle_z;
        Sector& sector = sectors[sectorOf(x, z)];
        const double distance = std::hypot(x, z);
        if (spot.is_floor) { sector.floor.push_back(distance); }
        if (!spot.is_floor && spot.h > lie.floor_h + 0.2 * lie.height) {
            sector.standing.push_back(distance), ++standing;
        }
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

// Of what stands on the floor, the share within the outermost quarter.
double furnishedShare(const Lie& lie) {
    std::size_t inside = 0, all = 0;
    for (const Spot& spot : lie.spots) {
        if (spot.is_floor) { continue; }
        ++all;
        inside += std::abs(spot.x - lie.x.middle()) < 0.375 * lie.x.length() &&
                  std::abs(spot.z - lie.z.middle()) < 0.375 * lie.z.length() &&
                  spot.h > lie.floor_h + 0.08 * lie.height && spot.h < lie.floor_h + 0.85 * lie.height;
    }
    return all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
}

// True if splats far from the middle are larger than those near it, as in scenes captured from inside.
bool growsOutwards(const Lie& lie) {
    const double radius = 0.5 * std::hypot(lie.x.length(), lie.z.length());
    const auto reachAt = [&](double from, double to) {
        return valuesOf(lie.spots, [&](const Spot& spot) -> std::optional<double> {
            const double distance = std::hypot(spot.x - lie.x.middle(), spot.z - lie.z.middle());
            return distance >= from * radius && distance < to * radius ? std::optional(spot.reach)
                                                                       : std::nullopt;
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
    if (sectors < kSurrounded * kSectors ||
        lie.height > kTallest * std::max(lie.x.length(), lie.z.length())) {
        return false;
    }
    if (!lie.has_floor) { return growsOutwards(lie); }
    // An empty room and a box differ only in size.
    return furnishedShare(lie) >= kHollow || lie.height * metres_per_unit >= kLeastRoomHeightMetres;
}

// The middle of the densest part of what stands on the floor.
std::optional<glm::dvec3> findDensest(const Lie& lie) {
    const Range h{lie.floor_h, lie.floor_h + lie.height};
    const double side = std::max({lie.x.length(), lie.z.length(), h.length()}) / kCells;
    if (!(side > 0.0)) { return std::nullopt; }
    const auto cellsOf = [&](const Range& range) {
        return std::max(1, static_cast<int>(std::ceil(range.length() / side)));
    };
    const std::array<int, 3> cells{cellsOf(lie.x), cellsOf(h), cellsOf(lie.z)};
    std::vector<int> counts(static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                            static_cast<std::size_t>(cells[2]));
    const auto indexOf = [&](int i, int j, int k) {
        return static_cast<std::size_t>((i * cells[1] + j) * cells[2] + k);
    };
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
    return glm::dvec3(lie.x.low + (found[0] + 0.5) * side, h.low + (found[1] + 0.5) * side,
                      lie.z.low + (found[2] + 0.5) * side);
}

// The distance from there to what is near, ignoring two splats in a thousand.
double clearanceAt(const std::vector<Spot>& spots, double x, double h, double z,
                   std::vector<double>& distances) {
    distances.clear();
    for (const Spot& spot : spots) {
        distances.push_back(std::hypot(spot.x - x, spot.h - h, spot.z - z) - spot.reach);
    }
    return findQuantile(distances, 0.002);
}

// True if a head has free space around it, and there is something at a distance on most sides; inside
// something solid, splats are as dense as anywhere.
bool hasRoom(const Lie& lie, const std::vector<Spot>& spots, const glm::dvec3& head, double radius) {
    std::array<std::vector<double>, kSectors> sectors;
    double near = 0.0;
    for (const Spot& spot : spots) {
        const double x = spot.x - head.x, z = spot.z - head.z;
        near += std::hypot(x, spot.h - head.y, z) < radius;
        if (!spot.is_floor) { sectors[sectorOf(x, z)].push_back(std::hypot(x, z)); }
    }
    const double sphere = 4.18879 * radius * radius * radius,
                 all = lie.x.length() * lie.z.length() * lie.height;
    const auto isFree = [&](std::vector<double>& sector) {
        return sector.size() >= kFewInSector && findQuantile(sector, 0.5) >= radius;
    };
    return near * all <= kMostDense * sphere * static_cast<double>(spots.size()) &&
           static_cast<double>(std::ranges::count_if(sectors, isFree)) >= kSurrounded * kSectors;
}

struct Place {
    glm::dvec3 eye{0.0}, look{0.0};  // right, up, ahead
    double clearance = 0.0;
};

// The best place inside that has space around it, if there is one.
std::optional<Place> findPlaceInside(const Lie& lie, double eye_height) {
    const std::optional<glm::dvec3> densest = findDensest(lie);
    if (!densest) { return std::nullopt; }
    const double h = lie.floor_h + eye_height, half = 0.5 * std::min(lie.x.length(), lie.z.length());
    std::vector<Spot> some;
    for (std::size_t i = 0; i < lie.spots.size(); i += lie.spots.size() / kMostForRoom + 1) {
        some.push_back(lie.spots[i]);
    }
    const auto medianOf = [&](double Spot::*along) {
        std::vector<double> values =
            valuesOf(some, [&](const Spot& spot) { return std::optional(spot.*along); });
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
        const double away = std::hypot(x - median_x, z - median_z) / half,
                     to_dense = std::hypot(x - densest->x, z - densest->z) / half;
        const double score = std::min(clearance / enough, 1.0) - 0.5 * away - std::max(0.0, 0.8 - to_dense);
        if (clearance > 0.15 * enough && score > best_score && hasRoom(lie, some, {x, h, z}, 0.9 * enough)) {
            best_score = score, best = Place{{x, h, z}, *densest, clearance};
        }
    }
    if (best) {
        const double level = std::hypot(best->look.x - best->eye.x, best->look.z - best->eye.z);
        best->look.y = std::clamp(best->look.y, h - kLookDown * level, h + kLookUp * level);
    }
    return best;
}

std::string explainUp(const StandpointWish& wish, const UpHints& hints,
                      const std::optional<FloorPlane>& floor) {
    if (wish.up) { return "given"; }
    if (floor) {
        return fmt::format("of the {}: {:.0f} % of the splats lie in it, {:.0f} % of the others {} it",
                           floor->is_ceiling ? "ceiling" : "floor", 100.0 * floor->share,
                           100.0 * (1.0 - floor->behind), floor->is_ceiling ? "below" : "above");
    }
    const char* const whose = hints.known == UpHints::Known::kNothing ? "by convention" : "as the file says";
    return fmt::format("{}, as no floor was found", whose);
}

// From the front, level, or from slightly above if things stand on a floor.
Standpoint standOutside(const Lie& lie, const Axes& axes, double fov_x_deg) {
    std::vector<Spot> object;
    std::ranges::copy_if(lie.spots, std::back_inserter(object),
                         [](const Spot& spot) { return !spot.is_floor; });
    const bool on_floor = lie.has_floor && 5 * object.size() >= lie.spots.size();
    if (!on_floor) { object = lie.spots; }
    const auto along = [&](double Spot::*axis) {
        return rangeOf(valuesOf(object, [&](const Spot& spot) { return std::optional(spot.*axis); }), 0.05);
    };
    const Range x = along(&Spot::x), h = along(&Spot::h), z = along(&Spot::z);
    // A sphere around the common box fills the picture's width; around a point it contains a usual splat, and
    // at least half a unit. If splats are spread evenly, the tenth that is ignored at the ends makes the box
    // a ninth longer.
    double radius = 0.5 / 0.9 * glm::length(glm::dvec3(x.length(), h.length(), z.length()));
    std::vector<double> reaches =
        valuesOf(object, [](const Spot& spot) { return std::optional(spot.reach); });
    const double usual = 0.5 * findQuantile(reaches, 0.5);
    if (radius <= usual) { radius = std::max(3.0 * usual, 0.5); }
    const double distance = radius / std::sin(glm::radians(0.5 * std::min(fov_x_deg, 120.0)));
    const double rise = lie.has_floor ? 0.26 : 0.0;  // 15 degrees
    const glm::dvec3 look = axes.world(x.middle(), h.middle(), z.middle());
    const glm::dvec3 eye = look + distance * (std::sin(rise) * axes.up - std::cos(rise) * axes.ahead);
    return {{eye, look, axes.up, fov_x_deg},
            fmt::format("outside: {:.3g} units from the middle of what is {:.3g} units across", distance,
                        2.0 * radius),
            {}};
}

}  // namespace

Standpoint judgeStandpoint(const Scene& scene, const StandpointWish& wish) {
    UpHints hints = hintsOf(scene);
    if (wish.up) {
        hints = {
            .usual = glm::normalize(*wish.up), .front = hints.front, .known = UpHints::Known::kDirection};
    }
    const std::vector<SplatSample> samples = coreOf(sampleSplats(scene, kMostSamples));
    if (samples.empty()) {
        const Axes axes = axesOf(hints.usual, scene.y_up);
        return {{-axes.ahead, {0.0, 0.0, 0.0}, axes.up, wish.fov_x_deg},
                "outside: there is nothing to be seen",
                explainUp(wish, hints, {})};
    }
    std::optional<FloorPlane> floor = chooseFloor(samples, hints);
    const glm::dvec3 up = floor && !wish.up ? floor->up : hints.usual;
    if (floor && glm::dot(floor->up, up) < 0.98) { floor.reset(); }
    const std::string up_why = explainUp(wish, hints, floor);
    const Axes axes = axesOf(up, scene.y_up);
    const Axes sides = alongSides(samples, axes);
    const Lie lie = lieOf(samples, sides, floor);
    const int sectors = surroundingSectors(lie);
    if (samples.size() >= kFewForRoom && surrounds(lie, sectors, wish.metres_per_unit)) {
        const double eye_height = eyeHeight(lie, wish.metres_per_unit);
        if (const std::optional<Place> place = findPlaceInside(lie, eye_height)) {
            const auto& [eye, look, clearance] = *place;
            return {
                {sides.world(eye.x, eye.y, eye.z), sides.world(look.x, look.y, look.z), up, wish.fov_x_deg},
                fmt::format("inside: the scene surrounds its middle in {} of {} directions; {:.3g} units "
                            "above the floor, {:.3g} "
                            "from the densest part, which is looked at",
                            sectors, kSectors, eye_height, glm::length(look - eye)),
                up_why,
                true};
        }
    }
    const Lie seen = lieOf(samples, axes, floor);
    Standpoint outside = standOutside(seen, axes, wish.fov_x_deg);
    outside.up_why = up_why;
    return outside;
}

SceneCore measureCore(const Scene& scene) {
    const std::vector<SplatSample> samples = coreOf(sampleSplats(scene, kMostSamples));
    SceneCore core;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const SplatSample& sample : samples) { values.push_back(sample.centre[axis]); }
        const Range range = rangeOf(std::move(values), 0.05);
        core.size = std::max(core.size, range.length());
        core.middle[axis] = range.middle();
    }
    return core;
}

double usualNear(const Scene& scene) {
    const double size = coreSize(scene);
    return size > 0.0 ? kUsualNear * std::min(size, 1.0) : kUsualNear;
}

std::optional<glm::dvec3> upBeneath(const Scene& scene, const glm::dvec3& cameras,
                                    const std::optional<glm::dvec3>& doubtful) {
    UpHints hints = hintsOf(scene);
    if (doubtful && hints.known == UpHints::Known::kNothing) {
        hints.usual = *doubtful, hints.is_doubtful = true;
    }
    hints.seen_from = cameras;
    const std::optional<FloorPlane> floor = chooseFloor(coreOf(sampleSplats(scene, kMostForRoom)), hints);
    return floor ? std::optional(floor->up) : std::nullopt;
}

std::optional<double> floorHeight(const Scene& scene, const glm::dvec3& up) {
    const std::optional<FloorPlane> floor = chooseFloor(coreOf(sampleSplats(scene, kMostForRoom)),
                                                        {.usual = up, .known = UpHints::Known::kDirection});
    if (!floor || floor->is_ceiling || glm::dot(floor->up, up) < 0.98) { return std::nullopt; }
    return floor->height;
}

}  // namespace binosplat
