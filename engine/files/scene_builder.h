// From attributes as files store them to a Scene: activations, skipped splats, the order of axes, the SH bands worth keeping.
// A format fills blocks column by column and hands them over; all formats share the rest.
#pragma once

#include "engine/files/stored_block.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

class SceneBuilder {
public:
    // `splats` must already be known to be plausible: room for all of them is reserved here.
    SceneBuilder(std::string name, std::uint64_t splats, int sh_degree, bool three_scales);

    // Some of the splats to come, so that the bands they use have room from the start on: making it later means moving all that is there.
    void expect(const StoredBlock& some);

    void append(const StoredBlock& block);
    // The same in two steps; the first one may be taken on another thread.
    void activate(const StoredBlock& block, ActiveBlock& active) const;
    void append(const StoredBlock& block, const ActiveBlock& active);

    // The scene, with the findings added to `notes`.
    [[nodiscard]] Scene finish(LoadNotes& notes);

private:
    void growShTo(int sh_degree);
    void measureFlatness();
    void appendSh(const StoredBlock& block, const ActiveBlock& active);

    Scene scene_;
    LoadNotes notes_;
    ActiveBlock active_;
};

// The Scene::origin along an axis for positions about `middle` that a file has in more than float32: a whole number near it where float32
// has steps of a millimetre and more; otherwise 0.
double originAbout(double middle);

// For the positions that were read already; says so, unless it is 0.
void setOrigin(Scene& scene, const glm::dvec3& origin, LoadNotes& notes);

// For a file that says that its splats are discs, though it has a third scale for each: the shortest one has no meaning.
void takeAsDiscs(Scene& scene, LoadNotes& notes);

}  // namespace binosplat
