// Writes the arrays of each part as they are in memory, each preceded by its size.
#include "engine/files/scene_spill.h"

#include "engine/error.h"
#include "engine/scene/pick_splats.h"
#include "engine/temporary_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace binosplat {

namespace {

// All arrays of a scene, one after another.
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

std::string SceneSpill::fileOf(std::size_t scene) const {
    return (folder_ / fmt::format("{}", scene)).string();
}

void SceneSpill::add(std::size_t scene, const Scene& part) {
    std::ofstream file(fileOf(scene), std::ios::binary | std::ios::app);
    const auto write = [&](const void* data, std::size_t bytes) {
        file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    };
    forEachArray(part, [&](const auto& values) {
        const std::uint64_t size = values.size();
        write(&size, sizeof(size));
        write(values.data(), size * sizeof(values[0]));
    });
    file.close();
    check(file.good(), "{}: cannot be written: is the disk full?", fileOf(scene));
    if (parts_.size() <= scene) { parts_.resize(scene + 1); }
    parts_[scene].push_back(pickSplats(part, {}));
}

Scene SceneSpill::read(std::size_t scene) const {
    std::ifstream file(fileOf(scene), std::ios::binary);
    const auto fill = [&](void* to, std::size_t bytes) {
        file.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
        check(file.good(), "{}: ends early, expected {} bytes more", fileOf(scene), bytes);
    };
    Scene whole;
    for (const Scene& stored : parts_.at(scene)) {
        Scene part = stored;
        forEachArray(part, [&](auto& values) {
            std::uint64_t size = 0;
            fill(&size, sizeof(size));
            values.resize(size);
            fill(values.data(), size * sizeof(values[0]));
        });
        if (&stored == parts_[scene].data()) {
            whole = std::move(part);
        } else {
            appendSplats(whole, part);
        }
    }
    return whole;
}

}  // namespace binosplat
