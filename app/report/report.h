// report.json of `render`: the options, what ran, and how long it took.
#pragma once

#include "app/options/camera_options.h"
#include "app/options/options.h"
#include "engine/frame/stereo_frame.h"

#include <string>
#include <vector>

namespace binosplat {

struct FrameReport {
    std::string device;
    RenderOptions options;
    Cameras cameras;
    FrameResult frame;  // passes of the same name are added up
};

// One of many frames along a path.
struct PathFrame {
    double time_s;  // since the path's first pose
    Cameras cameras;
    FrameResult frame;
};

struct PathReport {
    std::string device;
    RenderOptions options;
    Cameras start;
    std::vector<PathFrame> frames;  // at least one
};

// Times by name; entries of the same name are added up, in order of first appearance.
PassTimes addUp(const PassTimes& times);

std::string reportJson(const FrameReport& report);

// The same on a terminal, a line per pass.
std::string reportTable(const FrameReport& report);

// The same for a path: the costs of each frame, and a summary in a line.
std::string reportJson(const PathReport& report);
std::string reportTable(const PathReport& report);

}  // namespace binosplat
