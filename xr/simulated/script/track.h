// Values over time: tracks that interpolate between keys, and steps that hold until the next change.
#pragma once

#include "xr/simulated/compose/geometry.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace simulated {

[[nodiscard]] inline glm::dvec2 interpolate(const glm::dvec2& from, const glm::dvec2& to, double share) {
    return from + share * (to - from);
}

// Keys with strictly increasing times; the value rests before the first and after the last.
template <typename Value>
class Track {
public:
    Track() = default;
    explicit Track(const Value& resting) : keys_{{0.0, resting}} {}

    [[nodiscard]] bool empty() const { return keys_.empty(); }
    [[nodiscard]] const std::vector<std::pair<double, Value>>& keys() const { return keys_; }
    [[nodiscard]] double lastTime() const { return keys_.back().first; }
    // False, and nothing is added, if `time_s` is not after the last key.
    bool add(double time_s, const Value& value) {
        if (!keys_.empty() && time_s <= keys_.back().first) { return false; }
        keys_.emplace_back(time_s, value);
        return true;
    }

    [[nodiscard]] Value at(double time_s) const {
        const auto after = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                            [](double t, const auto& key) { return t < key.first; });
        if (after == keys_.begin()) { return keys_.front().second; }
        if (after == keys_.end()) { return keys_.back().second; }
        const auto& [from_s, from] = *std::prev(after);
        return interpolate(from, after->second, (time_s - from_s) / (after->first - from_s));
    }

private:
    std::vector<std::pair<double, Value>> keys_;
};

// A value from the beginning on, and its changes by time.
template <typename Value>
class Steps {
public:
    Steps() = default;
    explicit Steps(const Value& initial) : initial_(initial) {}

    void setInitial(const Value& value) { initial_ = value; }
    [[nodiscard]] const Value& initial() const { return initial_; }
    [[nodiscard]] const std::vector<std::pair<double, Value>>& changes() const { return changes_; }
    // False, and nothing is added, if `time_s` is not after the last change.
    bool add(double time_s, const Value& value) {
        if (!changes_.empty() && time_s <= changes_.back().first) { return false; }
        changes_.emplace_back(time_s, value);
        return true;
    }

    [[nodiscard]] Value at(double time_s) const {
        const auto after = std::upper_bound(changes_.begin(), changes_.end(), time_s,
                                            [](double t, const auto& change) { return t < change.first; });
        return after == changes_.begin() ? initial_ : std::prev(after)->second;
    }

private:
    Value initial_{};
    std::vector<std::pair<double, Value>> changes_;
};

}  // namespace simulated
