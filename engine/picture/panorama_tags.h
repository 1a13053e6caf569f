// What a file says about its picture, for galleries and headset players: GPano in the XMP of a PNG or a JPEG,
// and the boxes of Google's Spherical Video V2 (docs/spherical-video-v2-rfc.md in its spatial-media) in an
// MP4.
#pragma once

#include "engine/picture/panorama.h"

#include <optional>
#include <string>

namespace binosplat {

// A PNG or JPEG file whose picture is this panorama, with the tags.
std::string withPanoramaTags(const std::string& file, const Panorama& panorama);

// Numbered as in the box st3d; the left one first.
enum class FilmEyes : unsigned char { kOne = 0, kTopBottom = 1, kSideBySide = 2 };

struct FilmTags {
    FilmEyes eyes = FilmEyes::kOne;
    std::optional<double> width_rad;  // of a panorama
};

// The box moov of an MP4, with the tags in the descriptions of its pictures. It must come after the pictures,
// because it gives their places in the file. Throws Error if it is not such a box.
std::string withFilmTags(const std::string& moov, const FilmTags& tags);

}  // namespace binosplat
