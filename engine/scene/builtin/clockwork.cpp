// builtin:clockwork: still and moving parts put together at a frame, and where to look at them from.
#include "engine/scene/builtin/clockwork.h"

#include "engine/scene/builtin/builtin.h"

#include <cmath>
#include <memory>
#include <mutex>

namespace binosplat::builtin {

namespace {

// In the axes of lighting.h; the wall is at its least z, and the floor is the table top.
Room makeRoom() {
    Room room;
    room.min = {-2.2f, -2.3f, -2.8f};
    room.max = {2.2f, 0.8f, 1.4f};
    room.window_min = {-1.2f, -2.1f};
    room.window_max = {1.9f, 0.1f};
    room.window_panes = {1.0f, 1.0f};
    room.to_sun = {0.2f, -0.22f, 0.95f};
    room.lamp = {0.0f, -1.5f, 0.0f};
    return room;
}

// Appends `part`, its colours cut to their constant band. A still part has no placement, and keeps its very numbers.
void append(Scene& scene, const Scene& part, const glm::dvec3& pivot, const clockwork::Placement* placement) {
    constexpr glm::quat kHalfTurn(0.0f, 0.0f, 1.0f, 0.0f);
    const std::size_t stride = 3 * static_cast<std::size_t>(shCoefficientCount(part.sh_degree));
    for (std::size_t i = 0; i < part.size(); ++i) {
        glm::vec3 position = clockwork::turnAbout(part.positions[i]);
        glm::quat rotation = kHalfTurn * part.rotations[i];
        float opacity = part.opacities[i];
        if (placement != nullptr) {
            position = glm::vec3(pivot + placement->turn * (glm::dvec3(position) - pivot) + placement->shift);
            rotation = glm::quat(glm::normalize(placement->turn * glm::dquat(rotation)));
            opacity = static_cast<float>(placement->opacity * static_cast<double>(opacity));
        }
        scene.positions.push_back(position);
        scene.rotations.push_back(rotation);
        scene.scales.push_back(part.scales[i]);
        scene.opacities.push_back(opacity);
        const float* sh = part.sh.data() + i * stride;
        scene.sh.insert(scene.sh.end(), sh, sh + 3);
    }
}

// Shared by all frames: computing the light takes far longer than placing the things.
struct Parts {
    std::uint64_t splats = 0;
    Scene still;  // as in the scene
    struct Moving {
        Scene scene;  // as it was drafted
        glm::dvec3 pivot;
        std::function<clockwork::Placement(double frame)> placeAt;
    };
    std::vector<Moving> moving;
};

std::shared_ptr<const Parts> makeParts(std::uint64_t splats, const Progress& progress) {
    Draft still;
    clockwork::addRoom(still);
    std::vector<clockwork::Thing> things;
    clockwork::addWheels(things);
    clockwork::addClock(things);
    clockwork::addLamp(things);

    // All are in each other's light.
    std::vector<Occluder> occluders = still.occluders();
    for (clockwork::Thing& thing : things) {
        occluders.insert(occluders.end(), thing.draft.occluders().begin(), thing.draft.occluders().end());
    }
    still.occluders() = occluders;

    const Room room = makeRoom();
    const std::uint64_t still_splats = splats * 3 / 5, moving_splats = splats - still_splats;
    constexpr double kStillWork = 0.8;
    auto parts = std::make_shared<Parts>();
    parts->splats = splats;
    append(parts->still, still.make(still_splats, room, progress ? [&](double share) { progress(kStillWork * share); } : Progress{}), {},
           nullptr);

    double total = 0.0, running = 0.0;
    for (const clockwork::Thing& thing : things) { total += thing.draft.weight(room); }
    std::uint64_t done = 0;
    for (clockwork::Thing& thing : things) {
        thing.draft.occluders() = occluders;
        running += thing.draft.weight(room);
        const std::uint64_t end = &thing == &things.back()
                                      ? moving_splats
                                      : static_cast<std::uint64_t>(std::llround(running / total * static_cast<double>(moving_splats)));
        parts->moving.push_back({thing.draft.make(end - done, room, {}), thing.pivot, thing.placeAt});
        done = end;
        if (progress) { progress(kStillWork + (1.0 - kStillWork) * static_cast<double>(done) / static_cast<double>(moving_splats)); }
    }
    return parts;
}

// Made once, for as long as somebody holds them.
std::shared_ptr<const Parts> partsOf(std::uint64_t splats, const Progress& progress) {
    static std::mutex mutex;
    static std::weak_ptr<const Parts> last;
    const std::lock_guard lock(mutex);
    std::shared_ptr<const Parts> parts = last.lock();
    if (!parts || parts->splats != splats) {
        parts = makeParts(splats, progress);
        last = parts;
    }
    return parts;
}

}  // namespace

std::shared_ptr<const void> keepClockwork(std::uint64_t splats) { return partsOf(splats, {}); }

Scene makeClockwork(std::uint64_t splats, const Progress& progress, std::uint64_t frame) {
    const std::shared_ptr<const Parts> parts = partsOf(splats, progress);
    Scene scene = parts->still;
    for (const Parts::Moving& part : parts->moving) {
        const clockwork::Placement placement = part.placeAt(static_cast<double>(frame));
        append(scene, part.scene, part.pivot, &placement);
    }
    return scene;
}

// A little from the side: seen straight on, the splats of a wall are all as far away, and their order is anybody's.
View clockworkView() { return {{0.15, -0.1, -0.1}, {0.02, 0.0, 1.8}, {0.0, -1.0, 0.0}, 60.0}; }

}  // namespace binosplat::builtin
