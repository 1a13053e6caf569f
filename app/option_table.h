// Every option of `render` and its likes, once: the command line, the config files and their checks are made from these rows.
#pragma once

#include <cstddef>

namespace binosplat {

struct OptionRow {
    const char* key;    // --key on the command line, key in a config
    const char* table;  // the config table it may stand in; it may also stand at the top
    const char* value;  // placeholder for the help; "" for a flag
    const char* help;
};

inline constexpr OptionRow kCameraRows[] = {
    {"eye", "camera", "x,y,z", "middle of the eyes (default: a view of the whole scene)"},
    {"look", "camera", "x,y,z", "point looked at"},
    {"up", "camera", "x,y,z", "direction that is up in the picture (default 0,-1,0, or the built-in scene's)"},
    {"fov-x", "camera", "DEG", "horizontal field of view (default 60, or the built-in scene's view)"},
    {"size", "camera", "WxH", "pixels per eye (default 1024x1024, or what --cameras or --headset says)"},
    {"cameras", "camera", "FILE", "cameras.json of a 3DGS or 2DGS training"},
    {"view", "camera", "N", "which camera of --cameras, from 0 (default 0)"},
    {"headset", "camera", "NAME", "angles, size and eye distance from configs/headsets/NAME.toml"},
    {"near", "camera", "Z", "nearest depth that is drawn, scene units (default 0.2)"},
    {"background", "camera", "r,g,b", "colour behind the scene, 0 to 1 (default 0,0,0)"},
};

inline constexpr OptionRow kStereoRows[] = {
    {"mode", "stereo", "MODE", "mono, two-pass, shared, reproject, paper or predicted (default predicted)"},
    {"dominant", "stereo", "SIDE", "eye that is rendered in full, left or right (default left)"},
    {"ipd", "stereo", "METRES", "distance of the eyes (default 0.063, or the headset's)"},
    {"center-roi", "stereo", "", "paper mode: also render again what is still unfilled inside the picture"},
    {"margin", "stereo", "PX", "paper mode: pixels added around what is rendered again (default 32)"},
    {"budget", "stereo", "FRACTION", "predicted mode: share of an eye's work that is spent on what moving gets wrong (default 0.22)"},
    {"move-cost", "stereo", "PAIRS",
     "predicted mode: tiles with at most so many pairs of tile and splat are rendered, not moved (default 32)"},
    {"depth", "stereo", "KIND", "depth that reprojects a pixel: sum, mean or inverse (default inverse)"},
    {"order", "stereo", "KIND", "splats are blended by their depth, or by their distance from the middle between the eyes (default depth)"},
    {"resampling", "stereo", "KIND",
     "reproject and paper modes: cubic, or forward as the paper moves colours: copied, gaps interpolated (default cubic)"},
    {"per-eye", "stereo", "", "paper mode: cull, sort and project for each eye by itself, as two-pass does"},
    {"gap-px", "stereo", "PX", "runs of uncovered pixels up to this long are interpolated, longer ones are holes (default 2)"},
    {"edge-samples", "stereo", "N", "paper mode: samples along each edge of the picture (default 64)"},
    {"edge-bounds", "stereo", "KIND", "paper mode: paper, or tight: at the edges also what near content uncovers (default paper)"},
    {"hole-error", "stereo", "E", "predicted mode: weight of the difference expected of a hole's pixel (default 1)"},
    {"newcomer-error", "stereo", "E",
     "predicted mode: error of a pixel that splats cover which the dominant eye does not see (default 0.3)"},
};

// The first of the following: those of every command that loads a scene.
inline constexpr std::size_t kLoadRows = 3;
inline constexpr OptionRow kRunRows[] = {
    {"lod", "scene", "N", "level of detail of a streamed SOG scene, 0 the finest (default: the finest within --memory-limit)"},
    {"flatten", "scene", "", "draw 3D Gaussians as discs, without the shortest axis of each"},
    {"antialiased", "scene", "", "dim small 3D Gaussians, as scenes trained with antialiasing want it (default: what the file says)"},
    {"metres-per-unit", "scene", "M", "metres in one scene unit (default 1)"},
    {"memory-limit", "run", "MIB", "device memory that may be used (default: all there is)"},
    {"device", "run", "NAME|INDEX", "GPU to use: part of its name, or its number (default: the most capable)"},
};

}  // namespace binosplat
