// Numbered pictures as a film, through ffmpeg.
#pragma once

#include "app/panorama.h"
#include "engine/picture/panorama_tags.h"

#include <filesystem>
#include <string>

namespace binosplat {

// Throws Error unless ffmpeg can be run.
void requireFfmpeg();

// What galleries and players are told about the pictures.
FilmTags filmTags(const RenderOptions& options);

// Makes `film`, an MP4, from the pictures `pattern` in `folder`, in which %06d stands for their numbers from
// 0 on. Throws Error with ffmpeg's own message.
void writeFilm(const std::filesystem::path& folder, const std::string& pattern,
               const std::filesystem::path& film, double rate_hz, const FilmTags& tags);

}  // namespace binosplat
