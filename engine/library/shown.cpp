// What a renderer shows, one scene or several placed ones, and how they change from frame to frame.
#include "engine/library/objects.h"
#include "engine/library/structures.h"

#include <algorithm>
#include <cmath>

using namespace binosplat;

namespace {

constexpr std::uint32_t kMostInstances = 4096;
// For a frame after a long pause.
constexpr double kLongestStep = 0.1;

PlacedScene placedOf(const bsp_instance& instance) {
    const auto& [w, x, y, z] = instance.orientation;
    const bool turns = w != 0.0 || x != 0.0 || y != 0.0 || z != 0.0;
    const glm::dquat orientation = turns ? glm::dquat(w, x, y, z) : glm::dquat(1.0, 0.0, 0.0, 0.0);
    const glm::dvec3 position(instance.position[0], instance.position[1], instance.position[2]);
    const double length = glm::length(orientation), scale = instance.scale == 0.0 ? 1.0 : instance.scale;
    check(std::isfinite(length), "orientation of an instance is not finite");
    check(std::isfinite(position.x + position.y + position.z), "position of an instance is not finite");
    check(std::isfinite(scale) && scale > 0.0, "scale of an instance is {}, must be more than 0", scale);
    return {.scene = &instance.scene->onDevice(),
            .origin = instance.scene->origin,
            .world_from_scene = {orientation / length, position, scale},
            .is_shown = instance.hidden == 0};
}

// All views as they see a scene, from each place where it is shown.
std::vector<Eye> eyesIn(const AskedFrame& asked, const bsp_scene_t* scene) {
    if (asked.placed.empty()) { return asked.eyes; }
    std::vector<Eye> eyes;
    for (std::size_t i = 0; i < asked.scenes.size(); ++i) {
        if (asked.scenes[i] != scene || !asked.placed[i].is_shown) { continue; }
        const Similarity scene_from_world = inverse(asked.placed[i].world_from_scene);
        for (Eye eye : asked.eyes) {
            eye.world_from_camera.position += asked.origin;
            eye.world_from_camera = transform(scene_from_world, eye.world_from_camera);
            eye.world_from_camera.position -= scene->origin;
            eyes.push_back(eye);
        }
    }
    return eyes;
}

}  // namespace

void ChangeUploads::bring(const GpuScene& scene) {
    auto idle = std::ranges::find_if(commands_, [](const auto& commands) { return commands->isDone(); });
    if (idle == commands_.end()) { idle = commands_.insert(idle, std::make_unique<Commands>(context_)); }
    Commands& commands = **idle;
    commands.wait();
    commands.begin(false);
    try {
        scene.recordChanges(commands);
    } catch (...) {
        commands.drop();
        throw;
    }
    if (commands.count() == 0) {
        commands.drop();
        return;
    }
    has_lost_ = true;
    commands.submit();
    has_lost_ = false;
}

void bsp_scene_t::advance(std::span<const Eye> eyes, double time_s, bool settles) {
    if (!live) { return; }
    const auto now = std::chrono::steady_clock::now();
    const double step = advanced_ ? std::chrono::duration<double>(now - *advanced_).count() : 0.0;
    advanced_ = now;
    live->setTime(time_s);
    if (settles) {
        live->settle(eyes);
    } else {
        live->update(eyes, std::min(step, kLongestStep));
    }
    try {
        uploads_.bring(live->scene());
    } catch (...) {
        if (uploads_.hasLost()) {
            const std::lock_guard lock(mutex_);
            failure_ = failureNow();
        }
        throw;
    }
    for (const std::string& line : live->takeLines(settles ? Waits::kBriefly : Waits::kNever)) {
        device.log(line);
    }
}

void bsp_renderer_t::readScenes(const bsp_frame_info& frame, AskedFrame& asked) const {
    check(frame.scene == nullptr || frame.instance_count == 0,
          "a frame has a scene and {} instances, must have one of the two", frame.instance_count);
    const auto add = [&](bsp_scene_t* scene) {
        check(scene != nullptr, "the scene of an instance is null");
        check(&scene->device == &device, "the scene and the renderer belong to different devices");
        scene->requireThere();
        asked.scenes.push_back(scene);
    };
    if (frame.scene != nullptr) {
        add(frame.scene);
        asked.origin = frame.scene->origin;
        return;
    }
    if (frame.instance_count == 0) { return; }
    check(frame.instance_count <= kMostInstances, "there are {} instances, must be at most {}",
          frame.instance_count, kMostInstances);
    constexpr std::size_t kFirstSize = offsetof(bsp_instance, hidden) + sizeof(std::uint32_t);
    checkHeader(frame.instances, BSP_TYPE_INSTANCE, kFirstSize, "bsp_instance");
    for (std::size_t i = 0; i < frame.instance_count; ++i) {
        const auto* instance = reinterpret_cast<const bsp_instance*>(
            reinterpret_cast<const unsigned char*>(frame.instances) + i * frame.instances->size);
        const auto known = readStructure(instance, BSP_TYPE_INSTANCE, kFirstSize, "bsp_instance");
        add(known.scene);
        asked.placed.push_back(placedOf(known));
    }
    const PlacedScene& first = asked.placed[0];
    asked.origin = group_ && group_->isOf(asked.placed) ? group_->origin()
                                                        : transform(first.world_from_scene, first.origin);
}

bool bsp_renderer_t::shows(const bsp_scene_t* scene) {
    const std::lock_guard lock(shown_mutex_);
    return std::ranges::find(shown_, scene) != shown_.end();
}

void bsp_renderer_t::showOnDevice(const GpuScene& scene) {
    part(0);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        try {
            parts_[p]->show(scene);
        } catch (...) {
            while (p-- > 0) { parts_[p]->show(*on_device_); }
            throw;
        }
    }
    on_device_ = &scene;
}

void bsp_renderer_t::show(const AskedFrame& asked) {
    if (asked.scenes == shown_ && (group_ != nullptr) == !asked.placed.empty()) { return; }
    auto group =
        asked.placed.empty() ? nullptr : std::make_unique<PlacedScenes>(device.context, asked.placed);
    showOnDevice(group ? group->scene() : asked.scenes.empty() ? device.empty : asked.scenes[0]->onDevice());
    group_ = std::move(group);
    views_read_ = 0;
    const std::lock_guard lock(shown_mutex_);
    shown_ = asked.scenes;
}

void bsp_renderer_t::forget() noexcept {
    try {
        show({});
    } catch (...) { dropAll(); }
}

void bsp_renderer_t::begin(AskedFrame& asked) {
    show(asked);
    views_read_ = 0;
    share_there_ = 1.0;
    for (std::size_t s = 0; s < asked.scenes.size(); ++s) {
        bsp_scene_t* const scene = asked.scenes[s];
        const auto is_first =
            std::ranges::find(asked.scenes, scene) == asked.scenes.begin() + static_cast<std::ptrdiff_t>(s);
        if (!scene->live || !is_first) { continue; }
        const std::vector<Eye> eyes = eyesIn(asked, scene);
        if (eyes.empty()) { continue; }
        scene->advance(eyes, asked.time_s, asked.settles);
        share_there_ = std::min(share_there_, scene->live->share());
    }
    if (group_) {
        group_->place(asked.placed);
        try {
            uploads_.bring(group_->scene());
        } catch (...) {
            forget();  // the next frame starts afresh
            throw;
        }
    }
    asked.settings.order = on_device_->usualOrder();
    if (!asked.is_cut) { return; }
    for (const auto& part : parts_) { part->forgetHistory(); }
}
