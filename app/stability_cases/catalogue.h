// The stiff and extreme cases of docs/results/stability.md as data: a scene, eyes, and how close the device's
// pictures must come to those of the float64 twin.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace binosplat::stability {

// Over red, green, blue and alpha. A value is off if it differs by more than 2/255 of the peak. For an eye
// made from the other, over the tiles that both the device and the twin render again, or neither does.
struct Bound {
    // Lower bound; the peak is 1, or the twin's brightest value if that is more.
    double psnr_db;
    double share_off;                                          // of the values, at most
    double largest = std::numeric_limits<double>::infinity();  // difference, at most; of the peak
    // Upper bound of the share of tiles that only one of them renders again.
    double other_tiles = 0.0;
};

// A scene and its eyes.
struct Stage {
    Scene scene;
    Eye middle;
    std::array<Eye, 2> eyes;
    double near = 0.2;
};

struct Case {
    std::string family;     // cases of one family are points of one curve
    std::string parameter;  // what `value` is, with its unit; empty where the family has one case
    double value = 0.0;
    std::function<Stage()> make;
    Bound rendered;  // of an eye rendered in full
    Bound moved;     // of an eye made from the other
    std::string reason;
    bool beyond = false;  // single precision cannot resolve the question: the bounds say what is left
    bool large = false;   // takes longer than all others together

    [[nodiscard]] std::string name() const;
};

std::vector<Case> makeCatalogue();

// A moving eye: what changes from one frame to the next must not exceed what changes in the twin.
struct Path {
    std::string name;
    std::function<Stage()> make;
    glm::dvec3 step;  // of the eye in its camera's axes, from frame to frame
    int frames;
    double slack;  // how much more than the twin's greatest change a change may be
    std::string reason;
};

std::vector<Path> makePaths();

}  // namespace binosplat::stability
