// Facts about the axes of plots: round ends, and few enough ticks for their labels.
#include "app/plot/plot_axis.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace binosplat;

namespace {

PlotAxis axisOver(Scale scale, double low, double high) {
    PlotAxis axis(scale);
    axis.include(high);
    axis.include(low);
    axis.round();
    return axis;
}

}  // namespace

TEST_CASE("any range has three to ten ticks, in order, within an axis that holds the range") {
    for (const Scale scale : {Scale::kLog, Scale::kLinear}) {
        for (const double low : {1e-38, 1e-15, 3e-7, 0.02, 1.0, 7.0, 4e5}) {
            for (const double ratio : {3.0, 9.0, 40.0, 999.0, 1e4, 1e7, 1e12, 1e30, 1e60}) {
                if (scale == Scale::kLinear && low < 1e-3) { continue; }  // steps of 1e-6 at least
                const PlotAxis axis = axisOver(scale, low, low * ratio);
                CAPTURE(low);
                CAPTURE(ratio);
                CHECK(axis.ticks().size() >= 3);
                CHECK(axis.ticks().size() <= 10);
                for (std::size_t i = 1; i < axis.ticks().size(); ++i) { CHECK(axis.ticks()[i] > axis.ticks()[i - 1]); }
                CHECK(axis.share(low) > -1e-9);
                CHECK(axis.share(low * ratio) < 1.0 + 1e-9);
                CHECK(axis.share(axis.ticks().front()) > -1e-9);
                CHECK(axis.share(axis.ticks().back()) < 1.0 + 1e-9);
            }
        }
    }
}

TEST_CASE("what has no place, and short numbers") {
    CHECK_FALSE(PlotAxis(Scale::kLog).shows(0.0));
    CHECK_FALSE(PlotAxis(Scale::kLog).shows(std::nan("")));
    CHECK(PlotAxis(Scale::kLinear).shows(-1.0));
    CHECK_FALSE(PlotAxis(Scale::kLinear).shows(INFINITY));
    CHECK(shortNumber(1500.0) == "1.5k");
    CHECK(shortNumber(3e6) == "3M");
    CHECK(shortNumber(2e9) == "2G");
    CHECK(shortNumber(1e15) == "1e+15");
    CHECK(shortNumber(0.001) == "0.001");
}
