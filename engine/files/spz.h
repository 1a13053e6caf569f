// SPZ: 24-bit positions, and bytes for the rest, one attribute after the other, in a gzip stream or bare
// (versions 2 and 3), or each in its own Zstandard stream after a table (version 4). All three are read, 3 is
// written.
//
// SPZ's axes are right, up, back unless an extension names others; those of trained PLY scenes are right,
// down, forward. Reading and writing convert between them, as the format's own converters to and from PLY do:
// y, z and everything that depends on their signs change sign.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace binosplat {

// True if the file holds, within gzip or bare, the mark NGSP.
bool isSpz(InputFile& file);

// SH of degree 4 are cut to degree 3. Only the extension that names axes is read; other extensions, and bytes
// after the last stream, are ignored.
Scene readSpz(InputFile& file, LoadNotes& notes, const Progress& progress);

// Positions get as many fractional bits, up to 16, as the scene's extent allows; SH keep eight bits in every
// band; the third scale of discs is the smallest possible. The file appears whole or not at all. Throws Error
// for positions beyond 2^23 units.
void writeSpz(const Scene& scene, const std::string& path, const Progress& progress = {});
// For the positions as written.
int spzFractionalBits(const Scene& scene);

namespace spz {

inline constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"
// Magic, version, count; one byte each: SH degree, fractional bits, flags, reserved.
inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr int kAntialiased = 1;        // of the flags
inline constexpr int kHasExtensions = 2;      // the same
inline constexpr float kColourScale = 0.15f;  // a colour byte is 255 * (0.5 + kColourScale * f_dc)

// True if SH coefficient k, from 1 on, changes sign with y and z, that is if its polynomial is odd in the two
// together.
inline constexpr bool kShChangesSign[16] = {false, true, true,  false, true, false, false, true,
                                            false, true, false, true,  true, false, true,  false};

}  // namespace spz

}  // namespace binosplat
