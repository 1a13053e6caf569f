// Panels of lines and points as an SVG text.
#include "app/plot/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace binosplat {

namespace {

// All lengths in SVG user units (pixels at 100 %).
constexpr double kPanelWidth = 680.0, kPanelHeight = 420.0, kTitleHeight = 46.0;
constexpr double kLeftMargin = 70.0, kRightMargin = 210.0, kTopMargin = 34.0, kBottomMargin = 54.0;

// Colours that the colour-blind tell apart (Okabe and Ito, 2008), and a dash for the second round.
constexpr std::array<const char*, 8> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};

std::string escape(const std::string& text) {
    std::string result;
    for (char c : text) {
        result += c == '&'   ? "&amp;"
                  : c == '<' ? "&lt;"
                  : c == '>' ? "&gt;"
                  : c == '"' ? "&quot;"
                             : std::string(1, c);
    }
    return result;
}

// Places of names beside their points: inside the panel, without overlap.
class NamePlaces {
public:
    struct Place {
        double x, y;
        bool on_left;
    };

    NamePlaces(double left, double right, double top, double bottom)
        : left_(left), right_(right), top_(top), bottom_(bottom) {}

    // Empty if there is no room.
    std::optional<Place> find(double x, double y, const std::string& name) {
        const double width = kNameCharacter * static_cast<double>(name.size());
        for (const double below : {-5.0, 13.0}) {
            for (const bool on_left : {x > 0.5 * (left_ + right_), x <= 0.5 * (left_ + right_)}) {
                const Place place{x + (on_left ? -6.0 : 6.0), y + below, on_left};
                const Box box{on_left ? place.x - width : place.x, on_left ? place.x : place.x + width,
                              place.y - 9.0, place.y + 2.0};
                const bool inside =
                    box.left >= left_ && box.right <= right_ && box.top >= top_ && box.bottom <= bottom_;
                if (!inside ||
                    std::ranges::any_of(taken_, [&](const Box& other) { return overlap(box, other); })) {
                    continue;
                }
                taken_.push_back(box);
                return place;
            }
        }
        return std::nullopt;
    }

private:
    struct Box {
        double left, right, top, bottom;
    };
    static constexpr double kNameCharacter = 5.6;  // approximate width of a letter at 10 px
    static bool overlap(const Box& a, const Box& b) {
        return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    }

    double left_, right_, top_, bottom_;
    std::vector<Box> taken_;
};

// One panel with its top left corner at (left, top).
class PanelDrawing {
public:
    PanelDrawing(const PlotPanel& panel, double left, double top)
        : panel_(panel),
          x_axis_(panel.x_scale),
          y_axis_(panel.y_scale),
          left_(left),
          top_(top),
          x0_(left + kLeftMargin),
          x1_(left + kPanelWidth - kRightMargin),
          y0_(top + kPanelHeight - kBottomMargin),
          y1_(top + kTopMargin) {
        for (const PlotLine& line : panel.lines) {
            for (const auto& point : line.points) {
                if (!isShown(point)) { continue; }
                x_axis_.include(point.first);
                y_axis_.include(point.second);
            }
        }
        for (const PlotMark& mark : panel.marks) {
            if (x_axis_.shows(mark.x)) { x_axis_.include(mark.x); }
        }
        x_axis_.round();
        y_axis_.round();
    }

    [[nodiscard]] std::string draw() const {
        std::string svg = drawAxes();
        for (const PlotMark& mark : panel_.marks) { svg += drawMark(mark); }
        NamePlaces places(x0_, x1_, y1_ - 12.0, y0_);
        for (std::size_t i = 0; i < panel_.lines.size(); ++i) { svg += drawLine(i, places); }
        return svg;
    }

private:
    [[nodiscard]] bool isShown(const std::pair<double, double>& point) const {
        return x_axis_.shows(point.first) && y_axis_.shows(point.second);
    }
    [[nodiscard]] double toX(double value) const { return x0_ + (x1_ - x0_) * x_axis_.share(value); }
    [[nodiscard]] double toY(double value) const { return y0_ + (y1_ - y0_) * y_axis_.share(value); }

    [[nodiscard]] std::string drawAxes() const {
        std::string svg = fmt::format("<text x='{:.1f}' y='{:.1f}' class='panel'>{}</text>\n", x0_,
                                      top_ + 20.0, escape(panel_.title));
        for (double tick : x_axis_.ticks()) {
            svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{0:.1f}' y2='{2:.1f}' class='grid'/>",
                               toX(tick), y0_, y1_);
            svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", toX(tick),
                               y0_ + 16.0, shortNumber(tick));
        }
        for (double tick : y_axis_.ticks()) {
            svg += fmt::format("<line x1='{0:.1f}' y1='{1:.1f}' x2='{2:.1f}' y2='{1:.1f}' class='grid'/>",
                               x0_, toY(tick), x1_);
            svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>\n", x0_ - 6.0,
                               toY(tick) + 4.0, shortNumber(tick));
        }
        svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' class='frame'/>\n",
                           x0_, y1_, x1_ - x0_, y0_ - y1_);
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", 0.5 * (x0_ + x1_),
                           y0_ + 38.0, escape(panel_.x_label));
        svg += fmt::format(
            "<text x='{0:.1f}' y='{1:.1f}' text-anchor='middle' transform='rotate(-90 {0:.1f} "
            "{1:.1f})'>{2}</text>\n",
            left_ + 18.0, 0.5 * (y0_ + y1_), escape(panel_.y_label));
        return svg;
    }

    [[nodiscard]] std::string drawMark(const PlotMark& mark) const {
        if (!x_axis_.shows(mark.x)) { return {}; }
        return fmt::format(
            "<line x1='{0:.1f}' y1='{1:.1f}' x2='{0:.1f}' y2='{2:.1f}' stroke='#444' stroke-dasharray='2 3'/>"
            "<text x='{3:.1f}' y='{4:.1f}' transform='rotate(-90 {3:.1f} {4:.1f})'>{5}</text>\n",
            toX(mark.x), y0_, y1_, toX(mark.x) - 4.0, y0_ - 8.0, escape(mark.name));
    }

    [[nodiscard]] std::string drawLine(std::size_t index, NamePlaces& places) const {
        const PlotLine& line = panel_.lines[index];
        const char* colour = kColours[index % kColours.size()];
        const char* dash = index < kColours.size() ? "" : " stroke-dasharray='6 3'";
        std::string svg, path;
        bool broken = true;  // the line starts again after a point without a place
        for (std::size_t i = 0; i < line.points.size(); ++i) {
            if (!isShown(line.points[i])) {
                broken = true;
                continue;
            }
            const double x = toX(line.points[i].first), y = toY(line.points[i].second);
            path += fmt::format("{}{:.1f},{:.1f} ", broken ? "M" : "L", x, y);
            broken = false;
            if (line.dots) {
                svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'/>", x, y, colour);
            }
            if (line.names.empty()) { continue; }
            if (const auto place = places.find(x, y, line.names[i])) {
                svg += fmt::format("<text x='{:.1f}' y='{:.1f}' class='name'{}>{}</text>", place->x, place->y,
                                   place->on_left ? " text-anchor='end'" : "", escape(line.names[i]));
            }
        }
        if (line.joined && !path.empty()) {
            svg += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.5'{}/>", path, colour,
                               dash);
        }
        const double legend_y = y1_ + 10.0 + 18.0 * static_cast<double>(index);
        if (line.joined) {
            svg += fmt::format(
                "<line x1='{0:.1f}' y1='{1:.1f}' x2='{2:.1f}' y2='{1:.1f}' stroke='{3}' "
                "stroke-width='2'{4}/>",
                x1_ + 12.0, legend_y, x1_ + 34.0, colour, dash);
        } else {
            svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'/>", x1_ + 23.0, legend_y,
                               colour);
        }
        return svg + fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>\n", x1_ + 40.0, legend_y + 4.0,
                                 escape(line.label));
    }

    const PlotPanel& panel_;
    PlotAxis x_axis_, y_axis_;
    double left_, top_, x0_, x1_, y0_, y1_;
};

}  // namespace

PlotLine& lineOf(PlotPanel& panel, const std::string& label) {
    const auto found = std::ranges::find(panel.lines, label, &PlotLine::label);
    if (found != panel.lines.end()) { return *found; }
    return panel.lines.emplace_back(PlotLine{.label = label});
}

std::string drawPlot(const std::string& title, const std::vector<PlotPanel>& panels) {
    const double columns = panels.size() > 1 ? 2.0 : 1.0;
    const double rows = static_cast<double>((panels.size() + 1) / 2);
    const double width = columns * kPanelWidth, height = kTitleHeight + rows * kPanelHeight;
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} "
        "{1:.0f}'>\n",
        width, height);
    svg +=
        "<style>text{font:12px sans-serif;fill:#222} .title{font-size:17px;font-weight:bold} "
        ".panel{font-size:13px;font-weight:bold} "
        ".name{font-size:10px} .grid{stroke:#ddd} .frame{fill:none;stroke:#444}</style>\n<rect width='100%' "
        "height='100%' fill='white'/>\n";
    svg += fmt::format("<text x='{:.1f}' y='30' class='title'>{}</text>\n", kLeftMargin, escape(title));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        svg += PanelDrawing(panels[i], static_cast<double>(i % 2) * kPanelWidth,
                            kTitleHeight + static_cast<double>(i / 2) * kPanelHeight)
                   .draw();
    }
    return svg + "</svg>\n";
}

}  // namespace binosplat
