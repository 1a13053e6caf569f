// Panels of log-log lines as an SVG text.
#include "app/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

// All lengths in SVG user units (pixels at 100 %).
constexpr double kPanelWidth = 620.0, kPanelHeight = 400.0, kTitleHeight = 46.0;
constexpr double kLeft = 70.0, kRight = 150.0, kTop = 34.0, kBottom = 54.0;

// Colours that the colour-blind tell apart (Okabe and Ito, 2008), and a dash for the second round.
constexpr std::array<const char*, 8> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};

std::string escape(const std::string& text) {
    std::string result;
    for (char c : text) { result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c); }
    return result;
}

// 1500 as 1.5k, 3000000 as 3M.
std::string shortNumber(double value) {
    if (value >= 1e9) { return fmt::format("{:.3g}G", value / 1e9); }
    if (value >= 1e6) { return fmt::format("{:.3g}M", value / 1e6); }
    if (value >= 1e3) { return fmt::format("{:.3g}k", value / 1e3); }
    return fmt::format("{:.3g}", value);
}

bool isShown(const std::pair<double, double>& point) {
    return std::isfinite(point.first) && std::isfinite(point.second) && point.first > 0.0 && point.second > 0.0;
}

// A logarithmic axis from one round number (1, 2 or 5 times a power of ten) to another.
class Axis {
public:
    void include(double value) {
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }
    // Call once all values are in.
    void round() {
        if (low_ > high_) { low_ = 1.0, high_ = 10.0; }
        const double least = low_, most = high_;
        std::vector<double> all;
        for (int decade = static_cast<int>(std::floor(std::log10(least))) - 1; decade <= static_cast<int>(std::ceil(std::log10(most))) + 1;
             ++decade) {
            for (double digit : {1.0, 2.0, 5.0}) { all.push_back(digit * std::pow(10.0, decade)); }
        }
        // The last tick below and the first above; a single value gets room on both sides.
        constexpr double kSlack = 1.0 + 1e-9;
        const auto above = std::ranges::find_if(all, [&](double tick) { return tick * kSlack >= most && tick > least; });
        auto below = above;
        while (*below > least * kSlack || below == above) { --below; }
        ticks_.assign(below, above + 1);
        low_ = ticks_.front(), high_ = ticks_.back();
        // Over three decades, powers of ten are enough.
        if (std::log10(high_ / low_) > 3.0) {
            std::erase_if(ticks_, [](double tick) { return std::abs(std::log10(tick) - std::round(std::log10(tick))) > 1e-6; });
        }
    }
    [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }
    // 0 at the low end, 1 at the high end.
    [[nodiscard]] double share(double value) const { return std::log(value / low_) / std::log(high_ / low_); }

private:
    double low_ = std::numeric_limits<double>::max(), high_ = 0.0;
    std::vector<double> ticks_;
};

// One panel with its top left corner at (left, top).
std::string drawPanel(const PlotPanel& panel, double left, double top) {
    Axis x_axis, y_axis;
    for (const PlotLine& line : panel.lines) {
        for (const auto& point : line.points) {
            if (!isShown(point)) { continue; }
            x_axis.include(point.first);
            y_axis.include(point.second);
        }
    }
    x_axis.round();
    y_axis.round();
    const double x0 = left + kLeft, x1 = left + kPanelWidth - kRight, y0 = top + kPanelHeight - kBottom, y1 = top + kTop;
    const auto toX = [&](double value) { return x0 + (x1 - x0) * x_axis.share(value); };
    const auto toY = [&](double value) { return y0 + (y1 - y0) * y_axis.share(value); };

    std::string svg = fmt::format("<text x='{:.1f}' y='{:.1f}' class='panel'>{}</text>\n", x0, top + 20.0, escape(panel.title));
    for (double tick : x_axis.ticks()) {
        svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{0:.1f}' y2='{2:.1f}' class='grid'/>", toX(tick), y0, y1);
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", toX(tick), y0 + 16.0, shortNumber(tick));
    }
    for (double tick : y_axis.ticks()) {
        svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{2:.1f}' y2='{1:.1f}' class='grid'/>", x0, toY(tick), x1);
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>\n", x0 - 6.0, toY(tick) + 4.0, shortNumber(tick));
    }
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' class='frame'/>\n", x0, y1, x1 - x0, y0 - y1);
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", 0.5 * (x0 + x1), y0 + 38.0, escape(panel.x_label));
    const double label_x = left + 18.0, label_y = 0.5 * (y0 + y1);
    svg += fmt::format("<text x='{0:.1f}' y='{1:.1f}' text-anchor='middle' transform='rotate(-90 {0:.1f} {1:.1f})'>{2}</text>\n", label_x,
                       label_y, escape(panel.y_label));
    for (std::size_t i = 0; i < panel.lines.size(); ++i) {
        const char* colour = kColours[i % kColours.size()];
        const char* dash = i < kColours.size() ? "" : " stroke-dasharray='6 3'";
        std::string corners;
        for (const auto& point : panel.lines[i].points) {
            if (!isShown(point)) { continue; }
            corners += fmt::format("{:.1f},{:.1f} ", toX(point.first), toY(point.second));
            svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'/>", toX(point.first), toY(point.second), colour);
        }
        svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='2'{}/>\n", corners, colour, dash);
        const double legend_y = y1 + 10.0 + 18.0 * static_cast<double>(i);
        svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{2:.1f}' y2='{1:.1f}' stroke='{3}' stroke-width='2'{4}/>", x1 + 12.0,
                           legend_y, x1 + 34.0, colour, dash);
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>\n", x1 + 40.0, legend_y + 4.0, escape(panel.lines[i].label));
    }
    return svg;
}

}  // namespace

std::string drawPlot(const std::string& title, const std::vector<PlotPanel>& panels) {
    const double columns = panels.size() > 1 ? 2.0 : 1.0;
    const double rows = static_cast<double>((panels.size() + 1) / 2);
    const double width = columns * kPanelWidth, height = kTitleHeight + rows * kPanelHeight;
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} {1:.0f}'>\n", width, height);
    svg +=
        "<style>text{font:12px sans-serif;fill:#222} .title{font-size:17px;font-weight:bold} .panel{font-size:14px;font-weight:bold} "
        ".grid{stroke:#ddd} .frame{fill:none;stroke:#444}</style>\n<rect width='100%' height='100%' fill='white'/>\n";
    svg += fmt::format("<text x='{:.1f}' y='30' class='title'>{}</text>\n", kLeft, escape(title));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        svg += drawPanel(panels[i], static_cast<double>(i % 2) * kPanelWidth, kTitleHeight + static_cast<double>(i / 2) * kPanelHeight);
    }
    return svg + "</svg>\n";
}

}  // namespace binosplat
