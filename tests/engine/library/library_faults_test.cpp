// Facts about Vulkan calls that fail while the library records a frame: each gives a code and a text and
// leaks nothing, and the next frame is drawn. A layer decides which call fails (tests/faults).
#include "tests/engine/library/foreign_program.h"

#include <dlfcn.h>

SUITE(library_faults) {

constexpr auto kSize = ForeignProgram::kSize;

// A pair of views in the program's images, of one scene or of two instances of it.
struct Drawing {
    Drawing(const ForeignProgram& program, const bsp::Scene& scene)
        : views(scene.startViews(0.063, 1.2, kSize.x, kSize.y)) {
        target.colour = *program.floats->image;
        target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT;
        target.colour_after = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        for (bsp_view& view : views) { view.next = &target; }
        for (bsp_instance& instance : instances) { instance.scene = scene.get(); }
        instances[1].position[0] = 0.5;
        frame.instances = instances.data();
        frame.instance_count = 2;
        frame.views = views.data();
        frame.view_count = 2;
        frame.mode = BSP_MODE_SHARED;
    }
    Drawing(const Drawing&) = delete;

    bsp_target target = bsp::make<bsp_target>(BSP_TYPE_TARGET);
    std::array<bsp_instance, 2> instances{bsp::make<bsp_instance>(BSP_TYPE_INSTANCE),
                                          bsp::make<bsp_instance>(BSP_TYPE_INSTANCE)};
    bsp::Views views;
    bsp_frame_info frame = bsp::frame();
};

// The layer's controls, in this process.
struct Faults {
    Faults() {
        for (const auto& [name, value] : kEnvironment) { setenv(name, value, 1); }
        program.emplace();
        void* const layer = dlopen(BINOSPLAT_FAULT_LAYER "/libbinosplat_faults.so", RTLD_NOW | RTLD_NOLOAD);
        REQUIRE(layer != nullptr);
        arm = reinterpret_cast<void (*)(int, int)>(dlsym(layer, "binosplat_faults_arm"));
        struck = reinterpret_cast<const char* (*)()>(dlsym(layer, "binosplat_faults_struck"));
        live = reinterpret_cast<long long (*)()>(dlsym(layer, "binosplat_faults_live"));
        dlclose(layer);
    }
    ~Faults() {
        program.reset();
        for (const auto& [name, value] : kEnvironment) { unsetenv(name); }
    }
    // Submits a frame in which this call fails; returns the result and, if there were so many, the call.
    std::pair<bsp_result, std::string> submit(const bsp::Renderer& renderer, const Drawing& drawing, int call,
                                              VkResult error, std::uint64_t& frame) const {
        arm(call, error);
        const bsp_result result = bsp_submit(renderer.get(), &drawing.frame, nullptr, &frame);
        const char* const name = struck();
        arm(0, 0);
        return {result, name != nullptr ? name : ""};
    }

    static constexpr std::pair<const char*, const char*> kEnvironment[]{
        {"VK_ADD_LAYER_PATH", BINOSPLAT_FAULT_LAYER},
        {"VK_INSTANCE_LAYERS", "VK_LAYER_BINOSPLAT_faults"},
        {"BINOSPLAT_FAULT_ANY", "1"},
        {"BINOSPLAT_FAULT_LIVE", "/dev/null"}};
    std::optional<ForeignProgram> program;
    void (*arm)(int, int) = nullptr;
    const char* (*struck)() = nullptr;
    long long (*live)() = nullptr;
};

void waitFor(const bsp::Renderer& renderer, std::uint64_t frame) {
    while (bsp_collect(renderer.get(), frame, nullptr) == BSP_NOT_READY) { std::this_thread::yield(); }
}

// The right eye, which comes last.
std::vector<float> drawOnce(const ForeignProgram& program, const bsp::Renderer& renderer,
                            const Drawing& drawing) {
    std::uint64_t number = 0;
    bsp::check(bsp_submit(renderer.get(), &drawing.frame, nullptr, &number));
    waitFor(renderer, number);
    return program.readFloats();
}

// Makes every `step`th call of a first frame fail, and of the frame after it; returns how many there were.
int checkFailures(int step, int first = 1) {
    Faults faults;
    const ForeignProgram& program = *faults.program;
    const bsp::Device device = faults.program->open();
    const bsp::Scene scene = loaded(device, "builtin:fence");
    const Drawing drawing(program, scene);
    const auto drawAlone = [&] {
        bsp::Renderer renderer(device);
        (void)drawOnce(program, renderer, drawing);  // its lists grow
        return drawOnce(program, renderer, drawing);
    };
    const std::vector<float> expected = drawAlone();
    const long long alive = faults.live();
    int failed = 0;
    for (int number = first;; number += step) {
        bsp::Renderer renderer(device);
        std::uint64_t frame = 0;
        const auto [result, call] = faults.submit(
            renderer, drawing, number,
            failed % 2 == 0 ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_ERROR_OUT_OF_DEVICE_MEMORY, frame);
        INFO("call ", number, ": ", call, ": ", std::string(bsp_error_text()));
        if (call.empty()) {
            CHECK(result == BSP_SUCCESS);
            waitFor(renderer, frame);
            return failed;
        }
        ++failed;
        // For a kernel, it is only known that the driver refused, not what it returned.
        const bool is_kernel = call == "vkCreateComputePipelines";
        CHECK(result == (is_kernel ? BSP_ERROR_NO_DEVICE : BSP_ERROR_OUT_OF_MEMORY));
        CHECK(std::string(bsp_error_text()) != "");
        (void)drawOnce(program, renderer, drawing);
        CHECK(drawOnce(program, renderer, drawing) == expected);
        { const bsp::Renderer gone = std::move(renderer); }
        CHECK(faults.live() == alive);
    }
}

TEST_CASE("where any call of Vulkan fails in a frame, it is told, nothing leaks, and the next one is right") {
    CHECK(checkFailures(29, 28) >= 3);  // the first call ends the commands that upload placements
}

TEST_CASE("so is each" * nightly()) { CHECK(checkFailures(1) >= 90); }

TEST_CASE("of a device that is lost, every call says so of a submission") {
    Faults faults;
    const bsp::Device device = faults.program->open();
    const bsp::Scene scene = loaded(device, "builtin:one-splat");
    const Drawing drawing(*faults.program, scene);
    bsp::Renderer renderer(device);
    (void)drawOnce(*faults.program, renderer, drawing);
    std::uint64_t number = 0;
    for (int call = 1;; ++call) {
        const auto [result, struck] = faults.submit(renderer, drawing, call, VK_ERROR_DEVICE_LOST, number);
        if (struck.empty()) { break; }
        INFO(struck, ": ", std::string(bsp_error_text()));
        if (struck != "vkQueueSubmit") { continue; }
        CHECK(result == BSP_ERROR_DEVICE_LOST);
        CHECK(contains(bsp_error_text(), "lost"));
    }
    waitFor(renderer, number);
}

}  // SUITE(library_faults)
