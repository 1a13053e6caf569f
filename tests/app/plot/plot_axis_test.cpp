// Facts about plots: axes have round ends and few enough ticks for their labels, and names do not overlap.
#include "app/plot/plot_axis.h"
#include "app/plot/svg_plot.h"
#include "tests/suite.h"

SUITE(plot_axis) {

PlotAxis axisOver(Scale scale, double low, double high) {
    PlotAxis axis(scale);
    axis.include(high);
    axis.include(low);
    axis.round();
    return axis;
}

TEST_CASE("any range has three to ten ticks, in order, within an axis that holds the range") {
    for (const Scale scale : {Scale::kLog, Scale::kLinear}) {
        for (const double low : {1e-38, 1e-15, 3e-7, 0.02, 1.0, 7.0, 4e5}) {
            for (const double ratio : {3.0, 9.0, 40.0, 999.0, 1e4, 1e7, 1e12, 1e30, 1e60}) {
                if (scale == Scale::kLinear && low < 1e-3) { continue; }  // steps are at least 1e-6
                const PlotAxis axis = axisOver(scale, low, low * ratio);
                INFO("low ", low, ", ratio ", ratio);
                CHECK(axis.ticks().size() == within(3, 10));
                for (std::size_t i = 1; i < axis.ticks().size(); ++i) {
                    CHECK(axis.ticks()[i] > axis.ticks()[i - 1]);
                }
                for (const double value : {low, low * ratio, axis.ticks().front(), axis.ticks().back()}) {
                    CHECK(axis.share(value) == between(-1e-9, 1.0 + 1e-9));
                }
            }
        }
    }
}

TEST_CASE("what has no place, and short numbers") {
    CHECK_FALSE(PlotAxis(Scale::kLog).shows(0.0));
    CHECK_FALSE(PlotAxis(Scale::kLog).shows(std::nan("")));
    CHECK(PlotAxis(Scale::kLinear).shows(-1.0));
    CHECK_FALSE(PlotAxis(Scale::kLinear).shows(INFINITY));
    CHECK(these(shortNumber(1500.0), shortNumber(3e6), shortNumber(2e9), shortNumber(1e15),
                shortNumber(0.001)) == these("1.5k", "3M", "2G", "1e+15", "0.001"));
}

TEST_CASE("names stand beside their points where there is room, and never on each other") {
    const auto namesOf = [](const std::vector<std::pair<double, double>>& points, double right) {
        PlotPanel panel{.title = "panel",
                        .x_label = "x",
                        .y_label = "y",
                        .x_scale = Scale::kLinear,
                        .y_scale = Scale::kLinear};
        panel.lines.push_back({.label = "all", .points = {{0.0, 0.0}, {right, 10.0}}});
        panel.lines.push_back({.label = "named",
                               .points = points,
                               .names = std::vector<std::string>(points.size(), "a name"),
                               .joined = false});
        std::vector<std::string> places;
        const std::string svg = drawPlot("plot", {panel});
        for (std::size_t at = 0; (at = svg.find("class='name'", at)) != std::string::npos; ++at) {
            const std::size_t begin = svg.rfind("<text", at);
            places.push_back(svg.substr(begin, svg.find('>', at) - begin));
        }
        return places;
    };
    CHECK(namesOf({{2.0, 2.0}, {2.0, 8.0}, {8.0, 2.0}, {8.0, 8.0}}, 10.0).size() == 4);
    // A point has four sides, so four of six names find a place.
    const auto crowd = namesOf(std::vector(6, std::pair(5.0, 5.0)), 10.0);
    CHECK(std::set<std::string>(crowd.begin(), crowd.end()).size() == 4);
    CHECK(crowd.size() == 4);
    // In a corner, three sides are outside.
    CHECK(namesOf(std::vector(6, std::pair(0.0, 0.0)), 10.0).size() == 1);
}

}  // SUITE(plot_axis)
