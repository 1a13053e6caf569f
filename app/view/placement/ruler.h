// Two places of a scene whose distance somebody knows: then the scene can be shown in its true size.
#pragma once

#include <glm/glm.hpp>

#include <optional>

namespace binosplat {

class Ruler {
public:
    void open() { is_open_ = true, first_.reset(); }
    void close() { is_open_ = false; }
    [[nodiscard]] bool isOpen() const { return is_open_; }
    [[nodiscard]] bool hasFirst() const { return first_.has_value(); }

    // One of the two places, in scene units. With the second one the ruler closes, and the answer is their
    // distance.
    std::optional<double> add(const glm::dvec3& place) {
        if (!first_) {
            first_ = place;
            return std::nullopt;
        }
        close();
        return units_ = glm::distance(*first_, place);
    }
    // Of the two places measured last.
    [[nodiscard]] double units() const { return units_; }

private:
    bool is_open_ = false;
    std::optional<glm::dvec3> first_;
    double units_ = 0.0;
};

}  // namespace binosplat
