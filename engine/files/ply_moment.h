// Dynamic PLY scenes, whose splats move, appear and fade: the still of one moment.
#pragma once

#include "engine/files/ply_header.h"
#include "engine/files/ply_rows.h"
#include "engine/files/stored_block.h"

#include <array>
#include <string>
#include <vector>

namespace binosplat::ply {

// Fields as Spacetime Gaussians (Li et al. 2024) have them: a splat's own time, how long it is seen, the polynomial of its motion up to the
// cube, and the speed of its rotation. Each may be missing. Other methods name the first two t and scale_t. Where that method has no
// harmonics, f_dc is the colour itself, or, of its larger model, a number whose sigmoid a network changes; that is left out.
class Moment {
public:
    // Adds a column for each field that the element has; they use room of a block's f_rest values, from `first_attribute` on. Without such
    // room the splats stay as they are.
    Moment(const Element& element, int first_attribute, std::vector<Column>& columns);

    [[nodiscard]] bool isDynamic() const { return !fields_.empty(); }
    // The median of some splats' times.
    void choose(const StoredBlock& some);
    // Puts a block's splats where and how they are then.
    void apply(StoredBlock& block) const;
    // Which fields, and which moment.
    [[nodiscard]] std::string describe() const;

private:
    static constexpr std::size_t kFields = 15;
    std::array<int, kFields> attribute_of_;  // -1: the file does not have it
    std::vector<std::string> fields_;
    enum class Colours { kHarmonics, kPlain, kLogits } colours_ = Colours::kHarmonics;
    bool changes_ = false;      // by more than its time: then it is known how
    bool is_gaussian_ = false;  // seen as exp(-d^2/2) of the distance in time, not as exp(-d^2)
    float time_ = 0.0f;
};

}  // namespace binosplat::ply
