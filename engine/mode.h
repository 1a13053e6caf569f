// The ways to make two eyes' pictures, and their names; and the order in which splats are blended.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace binosplat {

// docs/how-it-works.md explains each.
enum class Mode {
    kMono,       // one eye
    kTwoPass,    // both eyes in full, nothing shared: the paper's reference
    kShared,     // both eyes in full, culled once and sorted by depth once
    kReproject,  // the affiliated eye reprojected from the dominant one's picture, and nothing else
    kPaper,      // with its borders, and on request its holes, rendered again (the paper)
    kPredicted,  // with the tiles of the greatest expected error rendered again
    kAlternate,  // in each frame one eye in full, in turn; the other from its own last full picture
    // Both eyes from their histories, with the tiles of the greatest expected error rendered again.
    kTemporal,
};

// By Mode, as options, reports and panels write them.
inline constexpr std::array<std::string_view, 8> kModeNames{"mono",  "two-pass",  "shared",    "reproject",
                                                            "paper", "predicted", "alternate", "temporal"};

constexpr std::string_view nameOf(Mode mode) { return kModeNames[static_cast<std::size_t>(mode)]; }

// True if the affiliated eye is reprojected from the dominant one.
constexpr bool reprojects(Mode mode) {
    return mode == Mode::kReproject || mode == Mode::kPaper || mode == Mode::kPredicted;
}
// True if frames are made from previous ones. A frame without a following one is as in kPredicted or, for
// kAlternate, as in kShared.
constexpr bool hasHistory(Mode mode) { return mode == Mode::kAlternate || mode == Mode::kTemporal; }
// True if each eye is rendered in full.
constexpr bool rendersBothInFull(Mode mode) { return mode == Mode::kTwoPass || mode == Mode::kShared; }

// Which tiles are rendered in a picture that is made from another.
enum class TileChoice {
    kAll,        // all of them: nothing is warped
    kNone,       // none: only reprojection and interpolation
    kPaper,      // edge ROIs, and centre ROIs if asked for
    kPredicted,  // cheap ones, and those with the greatest expected error for their cost
    // Tiles of both eyes together with the greatest expected error for their cost and for each frame that
    // they have waited.
    kHistory,
};

// Of a frame that keeps no history.
constexpr TileChoice choiceOf(Mode mode) {
    return mode == Mode::kReproject                              ? TileChoice::kNone
           : mode == Mode::kPaper                                ? TileChoice::kPaper
           : mode == Mode::kPredicted || mode == Mode::kTemporal ? TileChoice::kPredicted
                                                                 : TileChoice::kAll;
}

// The order in which splats are blended, front to back.
enum class Order {
    // Camera z of the splats' centres, as scenes are trained: changes as an eye turns, and differs between
    // canted eyes.
    kDepth,
    // Distance of the splats' centres from the midpoint between the eyes: one order for both eyes, however
    // they turn.
    kDistance,
};

}  // namespace binosplat
