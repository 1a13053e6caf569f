// Dynamic PLY scenes, whose splats move, appear and fade: the still of one moment.
#pragma once

#include "engine/files/ply_header.h"
#include "engine/files/ply_rows.h"
#include "engine/files/stored_block.h"

#include <array>
#include <string>
#include <vector>

namespace binosplat::ply {

// Fields as Spacetime Gaussians (Li et al. 2024) have them: a splat's own time, how long it is visible, the
// cubic polynomial of its motion, and the speed of its rotation. Any may be missing. Other methods call the
// first two t and scale_t. If that method has no harmonics, f_dc is the colour itself or, in its larger
// model, a number whose sigmoid a network changes; the network is left out.
class Moment {
public:
    // Adds a column for each field of the element, in a block's f_rest values from `first_attribute` on. If
    // these are not free, the splats stay as they are.
    Moment(const Element& element, int first_attribute, std::vector<Column>& columns);

    [[nodiscard]] bool isDynamic() const { return !fields_.empty(); }
    // The median of these splats' times.
    void choose(const StoredBlock& some);
    // Moves and fades a block's splats to that moment.
    void apply(StoredBlock& block) const;
    // Which fields there are, and which moment is shown.
    [[nodiscard]] std::string describe() const;

private:
    static constexpr std::size_t kFields = 15;
    std::array<int, kFields> attribute_of_;  // -1: not in the file
    std::vector<std::string> fields_;
    enum class Colours { kHarmonics, kPlain, kLogits } colours_ = Colours::kHarmonics;
    bool changes_ = false;      // by more than its time, in a way that is known
    bool is_gaussian_ = false;  // visible as exp(-d^2/2) of the distance d in time, not as exp(-d^2)
    float time_ = 0.0f;
};

}  // namespace binosplat::ply
