// Copies a few pixels of a frame, and reads them later.
#include "app/view/room/scene_probe.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace binosplat {

namespace {

// From the hand to the end of a large room.
constexpr double kNearestMetres = 0.2, kFarthestMetres = 30.0;
// For each point: a colour of up to four floats, then a word or a float of depth.
constexpr std::uint64_t kPointBytes = 32, kDepthByte = 16;
// What is this far behind a surface may pass behind it; anything nearer hits it.
constexpr double kThickMetres = 0.25, kThickShare = 0.15;

}  // namespace

double probeMetres(double point) {
    return kNearestMetres *
           std::pow(kFarthestMetres / kNearestMetres, point / static_cast<double>(kProbePoints - 1));
}

ProbePath probeRay(const Pose& room_from_aim) {
    ProbePath path;
    for (std::size_t i = 0; i < path.size(); ++i) {
        path[i] = transform(room_from_aim, glm::dvec3(0.0, 0.0, probeMetres(static_cast<double>(i))));
    }
    return path;
}

glm::dvec3 pointAlong(std::span<const glm::dvec3> way, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(way.size() - 1);
    const std::size_t from = std::min(static_cast<std::size_t>(at), std::max<std::size_t>(way.size(), 2) - 2);
    return glm::mix(way[from], way[std::min(from + 1, way.size() - 1)], at - static_cast<double>(from));
}

PathSeen followPath(const std::array<std::optional<double>, kProbePoints>& points_m,
                    const std::array<std::optional<double>, kProbePoints>& seen_m) {
    PathSeen path;
    std::optional<double> before_m;  // how far the point is in front of what is seen there
    for (std::size_t i = 0; i < kProbePoints; ++i) {
        if (!points_m[i] || !seen_m[i]) {
            before_m.reset();
            continue;
        }
        const double behind_m = *points_m[i] - *seen_m[i];
        if (behind_m > std::max(kThickMetres, kThickShare * *points_m[i]) && !before_m) {
            path.is_hidden = true;
        } else if (behind_m > 0.0) {
            path.meets = static_cast<double>(i) - (before_m ? behind_m / (behind_m + *before_m) : 0.0);
            return path;
        } else {
            before_m = -behind_m;
        }
    }
    return path;
}

SceneProbe::Asked::Asked(const Context& context)
    : found(context, "depth where hands point", kProbePaths * kProbePoints * kPointBytes,
            MemoryKind::kReadback) {}

SceneProbe::SceneProbe(const Context& context)
    : asked_{Asked(context), Asked(context), Asked(context), Asked(context)} {}

void SceneProbe::forget() {
    for (Asked& asked : asked_) { asked.is_recorded = false; }
}

ProbesSeen SceneProbe::ask(const std::array<std::optional<ProbePath>, kProbePaths>& paths) {
    turn_ = (turn_ + 1) % asked_.size();
    asked_[turn_].paths = paths;
    asked_[turn_].is_recorded = false;
    // A frame waits for the frame before the previous one.
    const Asked& done = asked_[(turn_ + 1) % asked_.size()];
    ProbesSeen seen;
    for (std::size_t p = 0; p < kProbePaths && done.is_recorded; ++p) {
        std::array<std::optional<double>, kProbePoints> points_m, seen_m;
        for (std::size_t i = 0; i < kProbePoints; ++i) {
            points_m[i] = done.depths_m[p * kProbePoints + i];
            if (points_m[i]) { seen_m[i] = depthIn(done, p * kProbePoints + i); }
            if (p != kGroundPath || !seen_m[i]) { continue; }
            const glm::dvec3& eye = done.scene_from_eye.position;
            seen.ground.push_back(eye + *seen_m[i] / *points_m[i] *
                                            (transform(done.scene_from_room, (*done.paths[p])[i]) - eye));
        }
        if (p != kGroundPath) { seen.hands[p] = followPath(points_m, seen_m); }
    }
    return seen;
}

void SceneProbe::record(Commands& commands, const Picture& picture, const Eye& eye,
                        const Similarity& scene_from_room) {
    Asked& asked = asked_[turn_];
    asked.half_floats = picture.half_floats;
    asked.has_words = picture.words.bytes() > 0;
    asked.scene_from_eye = eye.world_from_camera;
    asked.scene_from_room = scene_from_room;
    asked.depths_m = {};
    const Buffer& depths = asked.has_words ? picture.words : picture.depths;
    std::vector<vk::BufferCopy> colours_of, depths_of;
    const std::uint64_t colour_bytes = asked.half_floats ? 8 : 16;
    for (std::size_t p = 0; p < asked.depths_m.size(); ++p) {
        const std::optional<ProbePath>& path = asked.paths[p / kProbePoints];
        if (!path) { continue; }
        const glm::dvec3 at =
            transform(inverse(eye.world_from_camera), transform(scene_from_room, (*path)[p % kProbePoints]));
        if (!isInPicture(eye, at)) { continue; }
        const glm::uvec2 pixel(eye.intrinsics.fx * at.x / at.z + eye.intrinsics.cx,
                               eye.intrinsics.fy * at.y / at.z + eye.intrinsics.cy);
        if (glm::any(glm::greaterThanEqual(pixel, picture.size_px))) { continue; }
        asked.depths_m[p] = at.z / scene_from_room.scale;
        const std::uint64_t index = std::uint64_t{pixel.y} * picture.size_px.x + pixel.x;
        colours_of.emplace_back(index * colour_bytes, p * kPointBytes, colour_bytes);
        depths_of.emplace_back(index * sizeof(gpu::uint), p * kPointBytes + kDepthByte, sizeof(gpu::uint));
    }
    asked.is_recorded = depths.bytes() > 0 && !depths_of.empty();
    if (!asked.is_recorded) { return; }
    commands.copy(picture.colours, asked.found, colours_of);
    commands.copy(depths, asked.found, depths_of);
}

std::optional<double> SceneProbe::depthIn(const Asked& asked, std::size_t point) {
    const auto words = asked.found.mapped<gpu::uint>().subspan(point * kPointBytes / sizeof(gpu::uint),
                                                               kPointBytes / sizeof(gpu::uint));
    const float alpha = asked.half_floats ? glm::unpackHalf2x16(words[1]).y : std::bit_cast<float>(words[3]);
    const gpu::uint word = words[kDepthByte / sizeof(gpu::uint)];
    if (alpha < 0.5f || word == 0) { return std::nullopt; }
    // See lib/moving_pixel.glsl.
    const double units = asked.has_words
                             ? 1.0 / static_cast<double>(std::bit_cast<float>(((word >> 6) - 1) << 5))
                             : static_cast<double>(std::bit_cast<float>(word)) / static_cast<double>(alpha);
    return units / asked.scene_from_room.scale;
}

}  // namespace binosplat
