// The library as a program uses it: a device with a renderer, scenes, and calls that are refused.
#pragma once

#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "tests/run_program.h"

#include <binosplat.hpp>

namespace binosplat::test {

inline bsp::Scene loaded(const bsp::Device& device, const std::string& source, std::uint32_t live = 0) {
    auto info = bsp::make<bsp_scene_info>(BSP_TYPE_SCENE_INFO);
    info.source = source.c_str();
    info.live = live;
    info.rate_hz = 10.0;
    bsp::Scene scene(device, info);
    scene.wait();
    return scene;
}
// From a file that it does not need any more.
inline bsp::Scene loaded(const bsp::Device& device, const Scene& scene) {
    const Workplace place;
    writePly(scene, (place.path / "scene.ply").string());
    return loaded(device, (place.path / "scene.ply").string());
}

// For facts that use one, with a folder: TEST_CASE_FIXTURE(Opened, "...").
struct Opened : Workplace {
    Opened() {
        auto info = bsp::make<bsp_device_info>(BSP_TYPE_DEVICE_INFO);
        info.validation = BINOSPLAT_TEST_VALIDATION ? 1 : 0;
        info.log = [](void* user, const char* line) {
            static_cast<std::vector<std::string>*>(user)->emplace_back(line);
        };
        info.log_user = &lines;
        device.emplace(info);
        renderer.emplace(*device);
    }
    ~Opened() {
        renderer.reset();
        device.reset();
        std::erase_if(lines, [&](const std::string& line) { return !contains(line, unwanted); });
        CHECK(lines == std::vector<std::string>());
    }
    [[nodiscard]] bsp::Scene load(const std::string& source, std::uint32_t live = 0) const {
        return loaded(*device, source, live);
    }
    [[nodiscard]] bsp::Scene load(const Scene& scene) const { return loaded(*device, scene); }

    std::vector<std::string> lines;  // of the log
    std::string unwanted;            // lines with this fail the test: all, if it is empty
    std::optional<bsp::Device> device;
    std::optional<bsp::Renderer> renderer;
};

inline void checkRefusal(const std::function<void()>& action, bsp_result code, const std::string& part) {
    try {
        action();
        FAIL_CHECK("nothing was refused: " << part);
    } catch (const bsp::Error& error) {
        CHECK(error.code() == code);
        CHECK_MESSAGE(contains(error.what(), part), error.what());
    }
}

}  // namespace binosplat::test
