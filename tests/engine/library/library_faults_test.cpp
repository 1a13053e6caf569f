// Facts about Vulkan calls that fail while the library records a frame: each gives a code and a text and
// leaks nothing, and the next frame is drawn. A layer decides which call fails (tests/faults).
#include "tests/engine/library/foreign_program.h"

#include <dlfcn.h>

SUITE(library_faults) {

constexpr auto kSize = ForeignProgram::kSize;

// The layer's controls, in this process.
struct Faults {
    Faults() {
        setenv("VK_ADD_LAYER_PATH", BINOSPLAT_FAULT_LAYER, 1);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_BINOSPLAT_faults", 1);
        setenv("BINOSPLAT_FAULT_ANY", "1", 1);
        setenv("BINOSPLAT_FAULT_LIVE", "/dev/null", 1);
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
        for (const char* name :
             {"VK_ADD_LAYER_PATH", "VK_INSTANCE_LAYERS", "BINOSPLAT_FAULT_ANY", "BINOSPLAT_FAULT_LIVE"}) {
            unsetenv(name);
        }
    }

    std::optional<ForeignProgram> program;
    void (*arm)(int, int) = nullptr;
    const char* (*struck)() = nullptr;
    long long (*live)() = nullptr;
};

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

void waitFor(const bsp::Renderer& renderer, std::uint64_t frame) {
    while (bsp_collect(renderer.get(), frame, nullptr) == BSP_NOT_READY) { std::this_thread::yield(); }
}

// The right eye, which comes last.
std::vector<float> drawOnce(const ForeignProgram& program, const bsp::Renderer& renderer,
                            const Drawing& drawing) {
    std::uint64_t number = 0;
    bsp::check(bsp_submit(renderer.get(), &drawing.frame, nullptr, &number));
    waitFor(renderer, number);
    return program.readFloats(*program.floats, vk::ImageLayout::eTransferDstOptimal, 4);
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
        faults.arm(number, failed % 2 == 0 ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_ERROR_OUT_OF_DEVICE_MEMORY);
        const bsp_result result = bsp_submit(renderer.get(), &drawing.frame, nullptr, &frame);
        const char* const call = faults.struck();
        faults.arm(0, 0);
        INFO("call ", number, ": ", std::string(call != nullptr ? call : "none"), ": ",
             std::string(bsp_error_text()));
        if (call == nullptr) {
            CHECK(result == BSP_SUCCESS);
            waitFor(renderer, frame);
            return failed;
        }
        ++failed;
        // For a kernel, it is only known that the driver refused, not what it returned.
        const bool is_kernel = std::string(call) == "vkCreateComputePipelines";
        CHECK(result == (is_kernel ? BSP_ERROR_NO_DEVICE : BSP_ERROR_OUT_OF_MEMORY));
        CHECK(std::string(bsp_error_text()) != "");
        (void)drawOnce(program, renderer, drawing);
        CHECK(drawOnce(program, renderer, drawing) == expected);
        { const bsp::Renderer gone = std::move(renderer); }
        CHECK(faults.live() == alive);
    }
}

TEST_CASE(
    "where any call of Vulkan fails as a frame is recorded, it is a code and a text, the next frame is "
    "right, and nothing leaks") {
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
        faults.arm(call, VK_ERROR_DEVICE_LOST);
        const bsp_result result = bsp_submit(renderer.get(), &drawing.frame, nullptr, &number);
        const char* const struck = faults.struck();
        faults.arm(0, 0);
        if (struck == nullptr) { break; }
        INFO(std::string(struck), ": ", std::string(bsp_error_text()));
        if (std::string(struck) != "vkQueueSubmit") { continue; }
        CHECK(result == BSP_ERROR_DEVICE_LOST);
        CHECK(contains(bsp_error_text(), "lost"));
    }
    waitFor(renderer, number);
}

}  // SUITE(library_faults)
