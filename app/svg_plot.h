// Panels of log-log lines as an SVG text: axes, ticks, labels, legend.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace binosplat {

struct PlotLine {
    std::string label;
    std::vector<std::pair<double, double>> points;  // x, y; those not greater than 0 cannot be shown and are left out
};

struct PlotPanel {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
};

// Panels in rows of two.
std::string drawPlot(const std::string& title, const std::vector<PlotPanel>& panels);

}  // namespace binosplat
