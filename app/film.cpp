// Makes a film from numbered pictures.
#include "app/film.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"
#include "engine/temporary_folder.h"

#include <cstdint>
#include <fstream>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFfmpeg = "ffmpeg";

// The last box of an MP4, as ffmpeg leaves it, is the index.
void tagFilm(const fs::path& path, const FilmTags& tags) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const std::uint64_t end = fs::file_size(path);
    std::uint64_t begin = 0, size = 0;
    for (; begin < end; begin += size) {
        unsigned char header[16]{};
        file.seekg(static_cast<std::streamoff>(begin));
        file.read(reinterpret_cast<char*>(header), sizeof header);
        const auto number = [&](std::size_t from, std::size_t bytes) {
            std::uint64_t value = 0;
            for (std::size_t i = from; i < from + bytes; ++i) { value = value << 8 | header[i]; }
            return value;
        };
        size = number(0, 4);
        if (size == 1) { size = number(8, 8); }  // too long for four bytes
        check(file.good() && size >= 8 && size <= end - begin, "{}: cannot be read, must be an MP4",
              path.string());
        if (begin + size == end) { break; }
    }
    std::string moov(size, '\0');
    file.seekg(static_cast<std::streamoff>(begin));
    file.read(moov.data(), static_cast<std::streamsize>(moov.size()));
    const std::string tagged = withFilmTags(moov, tags);
    file.seekp(static_cast<std::streamoff>(begin));
    file.write(tagged.data(), static_cast<std::streamsize>(tagged.size()));
    file.close();
    check(file.good(), "{}: cannot be written", path.string());
}

std::string lastLine(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n');
    if (end == std::string::npos) { return "without a message"; }
    const std::size_t before = text.rfind('\n', end);
    return text.substr(before + 1, end - before);
}

}  // namespace

void requireFfmpeg() {
    const TemporaryFolder folder("binosplat-film-", "asking ffmpeg for its version");
    bool runs = false;
    try {
        runs = runProgram({kFfmpeg, "-version"}, folder.path() / "log");
    } catch (const Error&) {}
    check(
        runs,
        "--video needs the program ffmpeg, which cannot be run: install it (on Debian: apt install ffmpeg)");
}

FilmTags filmTags(const RenderOptions& options) {
    const std::optional<Panorama> panorama = askedPanorama(options);
    return {options.layout == PictureLayout::kSideBySide  ? FilmEyes::kSideBySide
            : options.layout == PictureLayout::kTopBottom ? FilmEyes::kTopBottom
                                                          : FilmEyes::kOne,
            panorama ? std::optional(panorama->width_rad) : std::nullopt};
}

void writeFilm(const fs::path& folder, const std::string& pattern, const fs::path& film, double rate_hz,
               const FilmTags& tags) {
    const fs::path log = film.parent_path() / ".ffmpeg";
    // The colours of high-definition television; a quality close to what a careful eye can distinguish;
    // colour at half resolution, as players expect.
    const bool made = runProgram({kFfmpeg,
                                  "-loglevel",
                                  "error",
                                  "-y",
                                  "-framerate",
                                  fmt::format("{}", rate_hz),
                                  "-i",
                                  (folder / pattern).string(),
                                  "-vf",
                                  "scale=out_color_matrix=bt709",
                                  "-colorspace",
                                  "bt709",
                                  "-color_primaries",
                                  "bt709",
                                  "-color_trc",
                                  "bt709",
                                  "-c:v",
                                  "libx264",
                                  "-crf",
                                  "17",
                                  "-pix_fmt",
                                  "yuv420p",
                                  film.string()},
                                 log);
    check(made, "ffmpeg made no film: {}", lastLine(readTextFile(log, "what ffmpeg says")));
    fs::remove(log);
    if (tags.eyes != FilmEyes::kOne || tags.width_rad) { tagFilm(film, tags); }
}

}  // namespace binosplat
