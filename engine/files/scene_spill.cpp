// Arrays as they lie in memory, each behind its size.
#include "engine/files/scene_spill.h"

#include "engine/error.h"
#include "engine/files/input_file.h"
#include "engine/part_file.h"
#include "engine/scene/pick_splats.h"
#include "engine/temporary_folder.h"

#include <fmt/format.h>

#include <system_error>

namespace binosplat {

namespace {

// All arrays of a scene, one after the other.
void forEachArray(auto& scene, auto&& call) {
    call(scene.positions);
    call(scene.rotations);
    call(scene.scales);
    call(scene.thicknesses);
    call(scene.opacities);
    call(scene.sh);
}

}  // namespace

SceneSpill::SceneSpill(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directory(folder_, error);
    check(!error, "{}: cannot be written: {}", folder_.string(), error.message());
}

SceneSpill::~SceneSpill() { removeFolder(folder_); }

std::string SceneSpill::fileOf(std::size_t index) const { return (folder_ / fmt::format("{}", index)).string(); }

void SceneSpill::add(const Scene& scene) {
    PartFile file(fileOf(parts_.size()));
    forEachArray(scene, [&](const auto& values) {
        const std::uint64_t size = values.size();
        file.write(&size, sizeof(size));
        file.write(values.data(), size * sizeof(values[0]));
    });
    file.commit();
    parts_.push_back(pickSplats(scene, {}));
}

Scene SceneSpill::read(std::size_t index) const {
    Scene scene = parts_.at(index);
    InputFile file(fileOf(index));
    const auto fill = [&](void* to, std::size_t bytes) {
        const std::size_t got = file.read({static_cast<std::byte*>(to), bytes});
        check(got == bytes, "{}: ends early, expected {} bytes more", file.name(), bytes - got);
    };
    forEachArray(scene, [&](auto& values) {
        std::uint64_t size = 0;
        fill(&size, sizeof(size));
        values.resize(size);
        fill(values.data(), size * sizeof(values[0]));
    });
    return scene;
}

}  // namespace binosplat
