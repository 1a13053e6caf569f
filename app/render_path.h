// Frames along a recorded path of the head: numbered pictures of each eye, and each frame's costs.
#pragma once

#include "app/options/camera_options.h"
#include "app/options/options.h"
#include "app/panorama.h"
#include "app/report/report.h"
#include "engine/picture/image.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/output_files.h"
#include "engine/stream/live_scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

struct HeadPath {
    HeadMotion motion;
    std::vector<double> times_s;   // of the frames, since the motion's first pose
    std::size_t first = 0;         // the frame to begin with
    std::filesystem::path folder;  // that receives the frames
    PictureLayout layout;
    std::optional<Panorama> panorama;
    double rate_hz;            // for a film of the frames
    std::string film_pattern;  // of the names of their pictures, if there is one for each frame
};

// Pictures of eyes by the names of their files: mono, left and right, or stereo for both in one.
using NamedPictures = std::vector<std::pair<std::string_view, Image>>;
NamedPictures namedPictures(std::vector<Image> eyes, PictureLayout layout);
// Display-encoded, to `stem` plus the extension. If the format is PNG, a panorama of one eye is tagged for
// galleries.
void writeDisplay(const std::filesystem::path& stem, const Image& image,
                  const std::optional<Panorama>& panorama);
// A panorama of one eye as JPEG, too, with the tags: many galleries take no other. Nothing in a build that
// cannot write it.
void writeForGalleries(const std::filesystem::path& stem, const Image& image, const Panorama& panorama);

// Renders --path, at each of its poses or --rate times a second; with --resume, from the first frame that the
// output folder lacks. Throws Error if the file cannot be used, or if the folder holds numbered pictures that
// the new ones would not replace, since the two could not be told apart.
HeadPath readHeadPath(const RenderOptions& options);

// Renders every frame and stages its pictures in `files`; cameras begin at `start` and move with the head.
// Each frame waits until everything that it needs of a `live` scene is loaded (null: the scene is whole); a
// moving scene begins with its first frame. A signal ends it after the last whole frame; before there is one,
// it throws Interrupted.
std::vector<PathFrame> renderPath(StereoFrame& frame, LiveScene* live, const FrameSettings& settings,
                                  const Cameras& start, Axes kind, double units_per_metre,
                                  const HeadPath& path, OutputFiles& files);

}  // namespace binosplat
