// Panels of lines and points as an SVG text: axes, ticks, labels, legend.
#pragma once

#include "app/plot/plot_axis.h"

#include <string>
#include <utility>
#include <vector>

namespace binosplat {

struct PlotLine {
    std::string label;
    // Pairs of x and y; those without a place on the axes are skipped.
    std::vector<std::pair<double, double>> points = {};
    // Written next to the points if there is space; empty: none.
    std::vector<std::string> names = {};
    bool joined = true;  // a line through the points
    bool dots = true;
};

// A value of x without a y: a dashed vertical line with its name.
struct PlotMark {
    std::string name;
    double x;
};

struct PlotPanel {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines = {};
    std::vector<PlotMark> marks = {};
    Scale x_scale = Scale::kLog, y_scale = Scale::kLog;
};

// The line of a panel with that label, added if it is not there.
PlotLine& lineOf(PlotPanel& panel, const std::string& label);

// Panels in rows of two.
std::string drawPlot(const std::string& title, const std::vector<PlotPanel>& panels);

}  // namespace binosplat
