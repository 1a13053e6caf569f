// The table of cases of 3D Gaussians: what is stiff about them, and the scenes of discs again with a
// thickness.
#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/families.h"

#include <fmt/format.h>

namespace binosplat::stability {
namespace {

template <Stage (*kMake)(double)>
Stage makeThick(double value) {
    return asGaussians(kMake(value));
}

template <Stage (*kMake)(double)>
Stage makeDimmed(double value) {
    return asDimmed(kMake(value));
}

}  // namespace

std::vector<Family> makeGaussianFamilies() {
    return {
        {"3D needles along the sight",
         "longer over shorter scale",
         {1e2, 1e4, 1e6},
         makeNeedlesAlongSight,
         kRounding,
         kPlaces,
         "the length that projection leaves is a difference, off by 1e-7 of the whole"},
        {"3D needles along rows and columns",
         "longer over shorter scale",
         {1e2, 1e6},
         makeNeedlesAcross,
         kRounding,
         kPlaces,
         "as wide as the low-pass, and longer than the picture"},
        {"3D needles along diagonals",
         "longer over shorter scale",
         {1e2, 1e6},
         makeNeedlesDiagonal,
         kRounding,
         kPlaces,
         "likewise; both axes share nearly everything, and the determinant is a sum of squares"},
        {"3D sheets edge-on",
         "angle, rad",
         {0.0, 1e-7, 1e-4, 1e-2},
         makeSheetsEdgeOn,
         kRounding,
         kPlaces,
         "a line as wide as the low-pass: the visible area does not matter while it is less than the length "
         "in pixels"},
        {"3D sheets at 1e-7 rad",
         "length, scene units",
         {1.0, 1e2, 1e4},
         makeLongSheets,
         {50.0, 0.005},
         kPlaces,
         "from 1e5 pixels on the area that rounding sees of them counts beside the low-pass, and so does the "
         "depth it takes them to slope "
         "by",
         {40.0, 0.05, kInfinity, 0.1},
         -kInfinity,
         2e3},
        {"3D centres beyond the near plane",
         "share of its distance",
         {-1e-5, 1e-5, 1e-2},
         makeBeyondNear,
         kRounding,
         kPlaces,
         "shown in full beyond the plane, not at all in front of it; the linear projection makes them as "
         "large as they are there"},
        {"3D beside the eye",
         "slope of their centres",
         {1.0, 3.0, 10.0, 100.0, 1e4},
         makeBesideEye,
         kRounding,
         kPlaces,
         "centres up to ten thousand pictures away, with the derivative taken at the picture's border"},
        {"3D scale",
         "scene units",
         {1e-6, 1e-3, 1.0, 1e4, 1e10, 1e38},
         makeGaussianScales,
         kRounding,
         kPlaces,
         "specks are their low-pass; those around the eye cover the picture, even at 1e38 units"},
        {"3D axes of length 0",
         "of three",
         {1.0, 2.0, 3.0},
         makeFlatAxes,
         kRounding,
         kPlaces,
         "sheets, lines and points get their extent from the low-pass alone"},
        {"3D opacity",
         "opacity",
         {0.0, 1.0 / 255.0, 1.0},
         makeGaussianOpacity,
         kRounding,
         kPlaces,
         "at 1/255 a splat is its centre's pixel or nothing"},
        {"dimmed needles along the sight",
         "longer over shorter scale",
         {1e2, 1e6},
         makeDimmed<makeNeedlesAlongSight>,
         kRounding,
         kPlaces,
         "they dim by the area left on the screen, which is off by 1e-7 of their length"},
        {"dimmed sheets edge-on",
         "angle, rad",
         {0.0, 1e-7, 1e-4, 1e-2, 1e-1},
         makeDimmed<makeSheetsEdgeOn>,
         kRounding,
         kPlaces,
         "likewise: edge-on they dim to nothing"},
        {"dimmed sheets at 1e-7 rad",
         "length, scene units",
         {1e2, 1e3, 1e4},
         makeDimmed<makeLongSheets>,
         {50.0, 0.001},
         kPlaces,
         "what rounding sees of them dims a sheet of 1e5 pixels to 1/100 and not to nothing",
         {25.0, 0.2, kInfinity, 0.15},
         -kInfinity,
         2e3},
        {"dimmed scale",
         "scene units",
         {0.0, 1e-6, 3e-3, 1e-2, 1e4, 1e38},
         makeDimmed<makeGaussianScales>,
         kRounding,
         kPlaces,
         "specks dim below 1/255, which rounding makes some reach a little earlier or later"},
        {"dimmed axes of length 0",
         "of three",
         {1.0, 2.0, 3.0},
         makeDimmed<makeFlatAxes>,
         kRounding,
         kPlaces,
         "with two axes or more, exactly nothing is left"},
        {"dimmed beside the eye",
         "slope of their centres",
         {3.0, 100.0},
         makeDimmed<makeBesideEye>,
         kRounding,
         kPlaces,
         "as without dimming"},
        {"3D unit",
         "of all lengths, the near plane's too",
         {1e-15, 1e-3, 1e6, 1e15},
         makeThick<makeUnit>,
         kRounding,
         kPlaces,
         "lengths are first multiplied by the focal length over the depth, so all later products are in "
         "pixels: no unit is too small or "
         "too large"},
        {"dimmed depth ratio",
         "farthest over nearest",
         {1e3, 1e9},
         makeDimmed<makeDepthRatio>,
         kRounding,
         kPlaces,
         "no splat is rounded relative to another's depth"},
        {"3D world offset",
         "scene units",
         {1e5},
         makeThick<makeFarOff>,
         kRounding,
         kPlaces,
         "positions are subtracted from the eye's in 48 bits"},
        {"3D layers of alpha 0.01",
         "layers",
         {1000.0},
         makeThick<makeLayers>,
         {80.0, 0.0, 1e-4},
         kPlaces,
         "each layer rounds the transmittance by 6e-8 of itself"},
        {"3D quaternions",
         "length",
         {0.0, 1e-18, 1e18},
         makeThick<makeQuaternions>,
         kRounding,
         kPlaces,
         "rotations are normalised in float64 before upload; those of length zero are not shown"},
        {"3D broken attributes",
         "1: NaN, 2: infinity, 3: -infinity",
         {1.0, 2.0, 3.0},
         [](double value) {
             return makeBrokenGaussians(value == 1.0 ? kNan : value == 2.0 ? kInfinity : -kInfinity);
         },
         kRounding,
         kPlaces,
         "such a splat is not shown, whichever attribute is broken, including its thickness"},
        {"3D eye distance",
         "scene units",
         {0.0, 1e-6, 1.0},
         makeThick<makeEyeDistance>,
         kRounding,
         kPlaces,
         "as of discs"},
        {"3D canting", "degrees", {1e-3, 20.0}, makeThick<makeCanting>, kRounding, kPlaces, "as of discs"},
        {"dimmed field of view",
         "degrees",
         {1.0, 60.0, 120.0, 170.0},
         makeDimmed<makeFieldOfView>,
         kRounding,
         kPlaces,
         "slopes are limited to the picture, which ends at 11 at 170 degrees"},
    };
}

void addGaussianCases(std::vector<Case>& cases) {
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 33)}) {
        cases.push_back(standAlone(
            fmt::format("3D image of {}x{}", size_px.x, size_px.y),
            [size_px] { return asGaussians(makeImage(size_px)); },
            "the border of the derivative is a share of the picture's size"));
    }
    cases.push_back(standAlone(
        "3D equal depths", [] { return asGaussians(makeEqualDepths()); },
        "ties are broken by the order of the scene"));
    cases.push_back(standAlone(
        "3D every tile covered", [] { return asGaussians(makeCovered()); },
        "a hundred 3D Gaussians touch every tile"));
    cases.push_back(standAlone(
        "3D eye inside a cloud", [] { return asGaussians(makeCloud()); },
        "of all sizes, around the eye, its near plane and beside it"));
    cases.push_back(standAlone(
        "dimmed eye inside a cloud", [] { return asDimmed(makeCloud()); }, "likewise, with dimmed specks"));
}

}  // namespace binosplat::stability
