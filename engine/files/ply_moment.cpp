// Spacetime Gaussians, section 4: opacity, position and rotation as functions of time.
#include "engine/files/ply_moment.h"

#include "engine/files/quantized.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace binosplat::ply {

namespace {

enum Field : std::size_t { kTime, kDuration, kMotion, kOmega = kMotion + 9 };  // the duration as a logarithm

std::vector<std::string> namesOf(std::size_t field) {
    if (field == kTime) { return {"trbf_center", "t"}; }
    if (field == kDuration) { return {"trbf_scale", "scale_t"}; }
    return {field < kOmega ? fmt::format("motion_{}", field - kMotion)
                           : fmt::format("omega_{}", field - kOmega)};
}

}  // namespace

Moment::Moment(const Element& element, int first_attribute, std::vector<Column>& columns) {
    attribute_of_.fill(-1);
    const bool has_room =
        static_cast<std::size_t>(first_attribute - kStoredRest0) + kFields <= StoredBlock::kRestStride;
    const auto find = [&](const std::string& name) {
        return std::ranges::find(element.properties, name, &Property::name);
    };
    const auto has = [&](const std::string& name) { return find(name) != element.properties.end(); };
    if (has("trbf_center") && !has("f_rest_0")) {
        colours_ = has("f_dc_3") ? Colours::kLogits : Colours::kPlain;
    }
    for (std::size_t field = 0; field < kFields; ++field) {
        for (const std::string& name : namesOf(field)) {
            const auto found = find(name);
            if (found == element.properties.end() || attribute_of_[field] >= 0) { continue; }
            fields_.push_back(name);
            if (!has_room) { continue; }
            attribute_of_[field] = first_attribute + static_cast<int>(field);
            columns.push_back(
                {static_cast<std::size_t>(found - element.properties.begin()), attribute_of_[field]});
            is_gaussian_ = is_gaussian_ || name == "scale_t";
            changes_ = changes_ || field != kTime;
        }
    }
}

void Moment::choose(const StoredBlock& some) {
    if (attribute_of_[kTime] >= 0) { time_ = medianOf(some, attribute_of_[kTime]); }
}

void Moment::apply(StoredBlock& block) const {
    for (std::size_t row = 0; row < block.rows; ++row) {
        std::array<float, kFields> fields{};
        for (std::size_t i = 0; i < kFields; ++i) {
            // The swap leaves 0.
            if (attribute_of_[i] >= 0) {
                std::swap(fields[i], block.rest(row)[attribute_of_[i] - kStoredRest0]);
            }
        }
        const float dt = time_ - fields[kTime];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float *speed = &fields[kMotion + axis], *square = speed + 3, *cube = speed + 6;
            block.column(kStoredX + static_cast<int>(axis))[row] +=
                dt * (*speed + dt * (*square + dt * *cube));
        }
        for (std::size_t i = 0; i < 4; ++i) {
            block.column(kStoredRot0 + static_cast<int>(i))[row] += dt * fields[kOmega + i];
        }
        for (int channel = 0; channel < 3 && colours_ != Colours::kHarmonics; ++channel) {
            float& colour = block.column(kStoredDc0 + channel)[row];
            colour = storedColour(colours_ == Colours::kPlain ? colour : 1.0f / (1.0f + std::exp(-colour)));
        }
        if (attribute_of_[kDuration] < 0) { continue; }
        const float distance = dt / std::exp(fields[kDuration]),
                    seen = std::exp(-distance * distance * (is_gaussian_ ? 0.5f : 1.0f));
        float& logit = block.column(kStoredOpacity)[row];
        logit = storedOpacity(seen / (1.0f + std::exp(-logit)));
    }
}

std::string Moment::describe() const {
    std::string said = fmt::format("its splats move or fade in time ({}): ", fmt::join(fields_, ", "));
    said += attribute_of_[kTime] < 0 || !changes_
                ? "all are shown at once, each as it is at its own moment"
                : fmt::format("shown as the still of one moment, {:.4g}", time_);
    if (colours_ == Colours::kLogits) { said += "; its colours lack what a network of its training adds"; }
    return said;
}

}  // namespace binosplat::ply
