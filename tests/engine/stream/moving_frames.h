// Films: numbered files in a folder, and the scenes in them.
#pragma once

#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "tests/suite.h"

namespace binosplat::test {

// The atelier, with the things in front of the walls sliding to the right and turning.
inline Scene slidingAtelier(double frame, std::uint64_t splats = 8'000) {
    static std::map<std::uint64_t, Scene> made;  // baking its light takes longer than many tests
    auto found = made.find(splats);
    if (found == made.end()) { found = made.emplace(splats, makeBuiltin("builtin:atelier", splats)).first; }
    Scene scene = found->second;
    const auto angle = static_cast<float>(0.02 * frame);
    const glm::quat turn(std::cos(angle), 0.0f, std::sin(angle), 0.0f);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        glm::vec3& p = scene.positions[i];
        if (!(std::abs(p.x) < 0.8f && p.z > 1.5f && p.z < 3.5f && p.y > -1.4f)) { continue; }
        p.x += static_cast<float>(0.02 * frame);
        scene.rotations[i] = turn * scene.rotations[i];
    }
    return scene;
}

// The atelier with a small part that slides; from frame `first` on, everything moves up and down in turn.
inline Scene shakenAtelier(int frame, int first) {
    Scene scene = slidingAtelier(0);
    const bool is_up = frame >= first && (frame - first) % 2 == 0;
    for (glm::vec3& p : scene.positions) {
        if (glm::distance(p, {0.0f, -0.8f, 2.5f}) < 0.4f) { p.x += 0.02f * static_cast<float>(frame); }
        p.y -= is_up ? 0.01f : 0.0f;
    }
    return scene;
}

// Frames 0 to `count` - 1 as FOLDER/frame_0001.ply and so on.
inline void writeFilm(const std::string& folder, int count, const std::function<Scene(int frame)>& frameAt) {
    std::filesystem::create_directories(folder);
    for (int frame = 0; frame < count; ++frame) {
        writePly(frameAt(frame),
                 (std::filesystem::path(folder) / fmt::format("frame_{:04}.ply", frame + 1)).string());
    }
}

inline void writeSliding(const std::string& folder, int count, std::uint64_t splats = 8'000) {
    writeFilm(folder, count, [&](int frame) { return slidingAtelier(frame, splats); });
}

}  // namespace binosplat::test
