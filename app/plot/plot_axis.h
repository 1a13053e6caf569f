// An axis of a plot: a range between round numbers, its ticks, and positions of values along it.
#pragma once

#include <string>
#include <vector>

namespace binosplat {

enum class Scale { kLog, kLinear };

class PlotAxis {
public:
    explicit PlotAxis(Scale scale) : scale_(scale) {}

    // True if the value has a place: finite, and greater than 0 on a logarithmic axis.
    [[nodiscard]] bool shows(double value) const;
    // Extends the axis to a value that it can show.
    void include(double value);
    // Call once all values are in.
    void round();

    [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }
    // 0 at the low end, 1 at the high end.
    [[nodiscard]] double share(double value) const;

private:
    void roundLog();
    void roundLinear();

    Scale scale_;
    bool empty_ = true;
    double low_ = 0.0, high_ = 0.0;
    std::vector<double> ticks_;
};

// 1500 as 1.5k, 3000000 as 3M; from 1e12 on with an exponent.
std::string shortNumber(double value);

}  // namespace binosplat
