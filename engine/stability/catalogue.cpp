// The table of cases.
#include "engine/stability/catalogue.h"

#include "engine/stability/extreme_scenes.h"

#include <fmt/format.h>

#include <cmath>

namespace binosplat::stability {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One curve: `make` takes the values of the parameter in turn.
struct Family {
    const char* name;
    const char* parameter;
    std::vector<double> values;
    Stage (*make)(double value);
    Bound rendered, moved;
    const char* reason;
    Bound beyond = {0.0, 1.0};   // what is left where the parameter
    double told_from = 0.0;      // is below this
    double told_to = kInfinity;  // or above this
};

// Pictures of ordinary scenes agree to 80 dB and more; a threshold that rounding moves a value across costs up to 1/255 of a value
// where alpha falls to 1/255, and few pixels lie so near to one.
constexpr Bound kRounding{65.0, 0.0005};
// Where a moved pixel's place rounds to the next pixel, or a tile is chosen in place of one that is expected to gain as much, single
// pixels differ by as much as their neighbours do.
constexpr Bound kPlaces{40.0, 0.01, kInfinity, 0.15};
// Discs that come through the near plane are bounded by boxes on the device: it takes some for seen that the twin knows to meet no
// pixel, and so expects errors elsewhere.
constexpr Bound kPlacesOfCut{40.0, 0.01, kInfinity, 0.35};

std::vector<Family> makeFamilies() {
    return {
        {"edge-on discs",
         "angle, rad",
         {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1},
         makeEdgeOn,
         {50.0, 0.001},
         kPlaces,
         "the sine between disc and sight is a difference of numbers of its centre's size, off by 1e-7: at 1e-7 rad nothing of it is left"},
        {"edge-on along a row of pixel centres",
         "angle, rad",
         {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1},
         makeHorizon,
         {50.0, 0.001},
         kPlaces,
         "likewise; under 1e-6 rad the disc is thinner than a pixel's distance from its line is known to: one row of pixels is the "
         "low-pass where the twin has the disc",
         {25.0, 0.03, kInfinity, 0.3},
         1e-6},
        {"aspect ratio",
         "longer over shorter scale",
         {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6},
         makeNeedles,
         {50.0, 0.001},
         kPlaces,
         "a needle's width on the screen is a small share of a pixel and its length a thousand pixels"},
        {"scale",
         "scene units",
         {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4},
         makeScales,
         kRounding,
         kPlaces,
         "specks are their low-pass alone; discs that hold the eye are cut by the near plane, at rounding's place"},
        {"disc through the eye",
         "distance of its plane, scene units",
         {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1},
         makeThroughEye,
         {50.0, 0.001},
         kPlacesOfCut,
         "the plane passes both eyes as near as that: what is seen of it beyond the near plane is edge-on; which tiles are rendered again "
         "hangs on bounds that differ for discs cut by that plane"},
        {"depth ratio",
         "farthest over nearest",
         {1e1, 1e3, 1e5, 1e7, 1e9},
         makeDepthRatio,
         kRounding,
         kPlaces,
         "splats at 0.001 to 1,000,000 units: nothing is rounded against another's depth"},
        {"unit",
         "of all lengths, the near plane's too",
         {1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12, 1e15},
         makeUnit,
         kRounding,
         kPlaces,
         "exponents of float32 end at 1e-38 and 1e38: products of three lengths have to fit in, and the square of a spread of depths",
         {30.0, 0.02, kInfinity, 0.5},
         1e-13,
         1e13},
        {"world offset",
         "scene units",
         {0.0, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6},
         makeFarOff,
         kRounding,
         kPlaces,
         "positions are subtracted from the eye's in 48 bits, so that only what the file's own float32 lost is lost"},
        {"two places",
         "distance, scene units",
         {1.0, 1e2, 1e3, 1e4, 1e5, 1e6},
         makeTwoPlaces,
         kRounding,
         kPlaces,
         "likewise, with most splats about the world's origin and the eyes far from it"},
        {"opacity",
         "opacity",
         {0.0, 1.0 / 255.0 - 1e-6, 1.0 / 255.0, 1.0 / 255.0 + 1e-6, 0.0045, 0.01, 0.1, 0.5, 0.99, 1.0},
         makeOpacity,
         kRounding,
         kPlaces,
         "at 1/255 a splat is its centre's pixel or nothing, which is 1/255 of a value"},
        {"layers of alpha 0.01",
         "layers",
         {1.0, 10.0, 100.0, 1000.0, 5000.0},
         makeLayers,
         {80.0, 0.0, 1e-4},
         kPlaces,
         "each layer rounds the transmittance by 6e-8 of itself, 1000 of them by 2e-6 if they add up at random and 6e-5 if not"},
        {"depths that are almost equal",
         "difference over depth",
         {0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3},
         makeSeparation,
         kRounding,
         kPlaces,
         "the order is that of the depths as float32: what differs by less than its last place may stand either way",
         {15.0, 1.0, kInfinity, 0.3},
         1e-7},
        {"quaternions",
         "length",
         {0.0, 1e-18, 1e-9, 1e-3, 1.0, 1e3, 1e9, 1e18},
         makeQuaternions,
         kRounding,
         kPlaces,
         "rotations are normalised in float64 on their way to the device; those of length zero are not shown"},
        {"broken attributes",
         "1: NaN, 2: infinity, 3: -infinity",
         {1.0, 2.0, 3.0},
         [](double value) {
             return makeBrokenAttributes(value == 1.0 ? kNan : value == 2.0 ? kInfinity : -kInfinity);
         },
         kRounding,
         kPlaces,
         "such a splat is not shown, whichever attribute it is"},
        {"SH amplitude",
         "coefficients up to",
         {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e10, 1e38},
         makeHarmonics,
         {50.0, 0.001},
         kPlaces,
         "coefficients and colours are half floats, which end at 65504, and are off by up to 2^-11 of themselves"},
        {"eye distance",
         "scene units",
         {0.0, 1e-6, 1e-4, 1e-2, 0.063, 0.25, 1.0},
         makeEyeDistance,
         kRounding,
         kPlaces,
         "at 0 nothing moves, at 1e-6 all by less than a pixel, and tiles whose errors are under 2^-20 are as good as right to the device "
         "alone"},
        {"canting",
         "degrees",
         {0.0, 1e-3, 1.0, 5.0, 10.0, 20.0},
         makeCanting,
         kRounding,
         kPlaces,
         "eyes that are turned have another depth order each, and move pixels between rows"},
        {"field of view",
         "degrees",
         {1.0, 5.0, 30.0, 60.0, 90.0, 120.0, 150.0, 170.0},
         makeFieldOfView,
         kRounding,
         kPlaces,
         "at 1 degree a pixel is 1e-4 of a unit's disc, at 170 one at the edge is 130 times as long as one in the middle"},
    };
}

Case standAlone(std::string family, std::function<Stage()> make, std::string reason) {
    return {std::move(family), "", 0.0, std::move(make), kRounding, kPlaces, std::move(reason)};
}

}  // namespace

std::string Case::name() const { return parameter.empty() ? family : fmt::format("{} {:.9g}", family, value); }

std::vector<Case> makeCatalogue() {
    std::vector<Case> cases;
    for (const Family& family : makeFamilies()) {
        for (const double value : family.values) {
            const bool beyond = value < family.told_from || value > family.told_to;
            cases.push_back({family.name, family.parameter, value, [value, make = family.make] { return make(value); },
                             beyond ? family.beyond : family.rendered, beyond ? family.beyond : family.moved, family.reason, beyond});
        }
    }
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(1, 700), glm::uvec2(4096, 4096)}) {
        cases.push_back(standAlone(
            fmt::format("image of {}x{}", size_px.x, size_px.y), [size_px] { return makeImage(size_px); },
            "sizes from one pixel to more than a headset's, odd ones with tiles that are cut"));
        cases.back().large = size_px.x >= 4096;
    }
    cases.push_back(
        standAlone("equal depths", makeEqualDepths, "ties are broken by the order of the scene, so that nothing is left to rounding"));
    cases.push_back(standAlone("empty scene", makeEmpty, "nothing is seen but the background"));
    cases.push_back(standAlone("every tile covered", makeCovered, "a hundred discs meet every tile"));
    cases.push_back(
        standAlone("eye inside a cloud", makeCloud, "discs of all sizes around the eye, through it and through the near plane"));
    cases.back().moved = kPlacesOfCut;
    return cases;
}

}  // namespace binosplat::stability
