// From attributes as files store them to a Scene: activations, skipped splats, the order of axes, the SH
// bands worth keeping. A format fills blocks column by column and hands them over; everything else is common
// to all formats.
#pragma once

#include "engine/files/stored_block.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace binosplat {

class SceneBuilder {
public:
    // `splats` must already be known to be plausible: memory for all of them is reserved here.
    SceneBuilder(std::string name, std::uint64_t splats, int sh_degree, bool three_scales);

    // A sample of the splats to come, so that there is space for the bands they use from the start: making it
    // later means moving everything.
    void expect(const StoredBlock& some);

    void append(const StoredBlock& block);
    // The same in two steps; the first may run on another thread.
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

// The Scene::origin along an axis, for positions around `middle` that a file stores in more than float32: a
// nearby whole number if steps of float32 there are a millimetre or more; otherwise 0.
double originAbout(double middle);

// For positions that have been read; adds a note unless it is 0.
void setOrigin(Scene& scene, const glm::dvec3& origin, LoadNotes& notes);

// For a file that says that its splats are discs, although each has a third scale: the shortest one is
// meaningless.
void takeAsDiscs(Scene& scene, LoadNotes& notes);

}  // namespace binosplat
