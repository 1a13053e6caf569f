// The scenes of the catalogue: each takes the one number that makes it stiff.
#pragma once

#include "app/stability_cases/catalogue.h"

namespace binosplat::stability {

// Discs.
Stage makeEdgeOn(double angle_rad);     // discs whose planes all but hold both eyes
Stage makeHorizon(double angle_rad);    // the same, with planes that project onto a row of pixel centres
Stage makeNeedles(double aspect);       // scales s sqrt(aspect) and s / sqrt(aspect)
Stage makeScales(double scale);         // from specks to discs that hold the eye
Stage makeThroughEye(double distance);  // large discs whose planes pass the eye at this distance
Stage makeDepthRatio(double ratio);     // discs of one apparent size at depths 0.001 to 0.001 ratio
Stage makeOpacity(double opacity);
Stage makeLayers(double count);            // discs of opacity 0.01 over the whole view
Stage makeSeparation(double separation);   // overlapping discs whose depths differ by this share
Stage makeEqualDepths();                   // exactly, before an eye along the world axes
Stage makeBrokenAttributes(double value);  // a scene with a splat for each attribute that has this value
Stage makeQuaternions(double length);      // rotations of this length
Stage makeHarmonics(double amplitude);     // SH of degree 3

// 3D Gaussians.
Stage makeNeedlesAlongSight(double aspect);  // scales s sqrt(aspect), s / sqrt(aspect) twice
Stage makeNeedlesAcross(double aspect);      // the same, along rows and columns of pixels
Stage makeNeedlesDiagonal(double aspect);    // the same, along the diagonals of the screen
Stage makeSheetsEdgeOn(double angle_rad);    // no thickness, all but holding both eyes
Stage makeLongSheets(double length);         // no thickness, at 1e-7 rad, up to this long
// Large splats whose centres are beyond the near plane by this share of it.
Stage makeBeyondNear(double share);
Stage makeBesideEye(double slope);       // centres at this x/z or y/z
Stage makeGaussianScales(double scale);  // from specks to those that hold the eye
Stage makeFlatAxes(double count);        // this many of the three scales are 0
Stage makeGaussianOpacity(double opacity);
Stage makeBrokenGaussians(double value);  // makeBrokenAttributes, and a thickness
Stage asGaussians(Stage stage);           // discs given thicknesses of 0 to their shorter scale
Stage asDimmed(Stage stage);              // with these thicknesses unless they have some; antialiased

// Worlds and views.
// Scales all lengths of an ordinary scene, including the eyes' distance and the near plane.
Stage makeUnit(double unit);
// Moves a scene and the eyes this far from the world's origin along every axis.
Stage makeFarOff(double offset);
Stage makeTwoPlaces(double distance);  // the eyes at a few splats, most splats this far away
Stage makeEyeDistance(double distance);
Stage makeCanting(double degrees);
Stage makeFieldOfView(double degrees);
Stage makeImage(glm::uvec2 size_px);
Stage makeEmpty();
Stage makeCovered();  // a hundred discs, each over every tile
Stage makeCloud();    // the eye inside

}  // namespace binosplat::stability
