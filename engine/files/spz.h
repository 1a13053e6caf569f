// SPZ: 24-bit positions and bytes, one attribute after the other: in a gzip stream or bare (versions 2 and 3), or each in a Zstandard
// stream of its own behind a table (version 4). All three are read, 3 is written.
//
// SPZ's axes are right, up, back unless an extension names others; those of trained PLY scenes are right, down, forward. Reading and
// writing turn between them, as the format's own converters to and from PLY do: y, z and everything that depends on their signs change
// sign.
#pragma once

#include "engine/files/input_file.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace binosplat {

// True if the file holds, within gzip or bare, the mark NGSP.
bool isSpz(InputFile& file);

// Of SH of degree 4, degree 3 is kept. Of the extensions, the one that names axes is read; the others, and bytes after the last stream,
// are ignored.
Scene readSpz(InputFile& file, LoadNotes& notes, const Progress& progress);

// Positions get as many fractional bits, 16 at most, as the scene's extent leaves; SH keep eight bits in every band; the third scale of
// discs is the smallest there is. The file appears whole or not at all. Throws Error for positions beyond 2^23 units.
void writeSpz(const Scene& scene, const std::string& path, const Progress& progress = {});
// Of the positions as written.
int spzFractionalBits(const Scene& scene);

namespace spz {

inline constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"
inline constexpr std::size_t kHeaderBytes = 16;      // magic, version, count; one byte each: SH degree, fractional bits, flags, reserved
inline constexpr int kAntialiased = 1;               // of the flags
inline constexpr int kHasExtensions = 2;             // the same
inline constexpr float kColourScale = 0.15f;         // a colour byte is 255 * (0.5 + kColourScale * f_dc)

// True if SH coefficient k, from 1 on, changes sign with y and z, i.e. if its polynomial is odd in them together.
inline constexpr bool kShChangesSign[16] = {false, true, true,  false, true, false, false, true,
                                            false, true, false, true,  true, false, true,  false};

}  // namespace spz

}  // namespace binosplat
