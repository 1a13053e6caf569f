// The ways to make two eyes' pictures, and their names; and in which order splats are blended.
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
    kReproject,  // the affiliated eye from the dominant one's picture alone
    kPaper,      // and its borders, on request also its holes, rendered again (the paper)
    kPredicted,  // and the tiles with the greatest expected error rendered again
    kAlternate,  // one eye in full in each frame, in turn; the other from its own last full picture
    kTemporal,   // both eyes from their own last pictures, the tiles with the greatest expected error rendered again
};

// By Mode, as options, reports and panels write them.
inline constexpr std::array<std::string_view, 8> kModeNames{"mono",  "two-pass",  "shared",    "reproject",
                                                            "paper", "predicted", "alternate", "temporal"};

constexpr std::string_view nameOf(Mode mode) { return kModeNames[static_cast<std::size_t>(mode)]; }

// True if the affiliated eye is made from the dominant one.
constexpr bool reprojects(Mode mode) { return mode == Mode::kReproject || mode == Mode::kPaper || mode == Mode::kPredicted; }
// True if frames are made from previous ones. Where none is to follow they are as in kPredicted, or, for kAlternate, as in kShared.
constexpr bool hasPast(Mode mode) { return mode == Mode::kAlternate || mode == Mode::kTemporal; }
// True if each eye is rendered in full.
constexpr bool rendersBothInFull(Mode mode) { return mode == Mode::kTwoPass || mode == Mode::kShared; }

// Which tiles of a picture are rendered where it is made from another.
enum class TileChoice {
    kAll,        // all of them: nothing is warped
    kNone,       // none: reprojection and interpolation alone
    kPaper,      // edge ROIs, and centre ROIs if asked for
    kPredicted,  // what is cheap to render, and those of the greatest expected error for their cost
    kPast,       // those of the greatest expected error for their cost and for each frame that they have waited, of both eyes together
};

// Of a frame that keeps no past.
constexpr TileChoice choiceOf(Mode mode) {
    return mode == Mode::kReproject                              ? TileChoice::kNone
           : mode == Mode::kPaper                                ? TileChoice::kPaper
           : mode == Mode::kPredicted || mode == Mode::kTemporal ? TileChoice::kPredicted
                                                                 : TileChoice::kAll;
}

// The order in which splats are blended, front to back.
enum class Order {
    kDepth,     // camera z of their centres, as scenes are trained: changes as an eye turns, and differs between canted eyes
    kDistance,  // distance of their centres from the middle between the eyes: one order for both eyes, however they turn
};

}  // namespace binosplat
