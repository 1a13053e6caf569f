// Facts about the library in a program's own device, command buffers and images. The layers watch, and any message fails a fact.
#include "tests/engine/library/foreign_program.h"

SUITE(foreign_device) {

constexpr auto kSize = ForeignProgram::kSize;
constexpr auto kColourUse = vk::ImageLayout::eColorAttachmentOptimal;
constexpr auto kDepthUse = vk::ImageLayout::eDepthStencilAttachmentOptimal;
constexpr float kNear = 0.2f;

// One eye before the splats of a scene, whose picture goes over what the program drew.
struct Asked {
    Asked(const ForeignProgram& program, const bsp::Scene& scene)
        : properties(scene.properties()), view(bsp::lookAt(properties.eye, properties.look, properties.up, 0.0, 1.2, kSize.x, kSize.y)[0]) {
        target.colour = *program.colour->image;
        target.colour_format = static_cast<VkFormat>(program.colour->format);
        target.colour_before = target.colour_after = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        target.depth = *program.depth->image;
        target.depth_before = target.depth_after = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        target.depth_scale = kNear;
        target.flags = BSP_TARGET_BLEND | BSP_TARGET_DEPTH_TEST;
        view.next = &target;
        frame.scene = scene.get();
        frame.views = &view;
        frame.view_count = 1;
        frame.flags = BSP_FRAME_DEPTH;
    }
    Asked(const Asked&) = delete;

    bsp_scene_properties properties;
    bsp_target target = bsp::make<bsp_target>(BSP_TYPE_TARGET);
    bsp_view view;
    bsp_frame_info frame = bsp::frame();
};

bsp::Scene load(const bsp::Device& device, const std::string& source) {
    bsp::Scene scene(device, source);
    scene.wait();
    return scene;
}

// The frame between the program's own draws, and what it says once the device is done.
bsp_frame_result drawBetween(const ForeignProgram& program, bsp::Renderer& renderer, const Asked& asked, float wall_depth) {
    const vk::raii::CommandBuffer commands = program.begin();
    program.drawWall(commands, wall_depth);
    std::uint64_t number = 0;
    bsp::check(bsp_record(renderer.get(), &asked.frame, *commands, &number));
    program.drawSign(commands);
    const vk::raii::Fence fence(program.device, vk::FenceCreateInfo());
    program.submit(commands, fence);
    (void)program.device.waitForFences(*fence, VK_TRUE, UINT64_MAX);
    auto result = bsp::make<bsp_frame_result>(BSP_TYPE_FRAME_RESULT);
    CHECK(bsp_collect(renderer.get(), number, &result) == BSP_SUCCESS);
    return result;
}

TEST_CASE("splats lie before and behind a wall that the program drew, over its picture, and its own draws go on after them") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = load(device, "builtin:atelier");
    bsp::Renderer renderer(device);
    const Asked asked(program, scene);
    bsp::check(bsp_prepare(renderer.get(), &asked.frame));
    // What is to be seen, by the picture and its depths.
    renderer.render(asked.frame);
    const std::vector<float> picture = renderer.colour(asked.view, 0).values, depths = renderer.depth(asked.view, 0).values;
    std::vector<float> middle;
    std::ranges::copy_if(depths, std::back_inserter(middle), [](float depth) { return depth > 0.0f; });
    std::ranges::nth_element(middle, middle.begin() + static_cast<std::ptrdiff_t>(middle.size() / 2));
    const float wall_z = 0.9999f * middle.at(middle.size() / 2);  // no pixel lies in it
    const bsp_frame_result result = drawBetween(program, renderer, asked, kNear / wall_z);
    CHECK(result.frames_cut_short == 0);
    CHECK(result.splats_visible > 1000);

    const std::vector<std::uint32_t> seen = program.readWords(*program.colour, kColourUse);
    const std::vector<float> seen_depths = program.readFloats(*program.depth, kDepthUse, 1);
    int before = 0, behind = 0, off = 0, depths_off = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t x = i % kSize.x, y = i / kSize.x;
        const bool is_wall = x < kSize.x / 2;
        const float* splats = &picture[4 * i];
        const bool is_hidden = !(depths[i] > 0.0f) || (is_wall && depths[i] > wall_z);
        (is_hidden ? behind : before) += is_wall ? 1 : 0;
        const std::array<float, 3> own = is_wall ? std::array{1.0f, 0.0f, 0.0f} : std::array{0.2f, 0.4f, 0.6f};
        const float share = is_hidden ? 0.0f : splats[3];
        for (std::size_t c = 0; c < 3; ++c) {
            float value = std::clamp((is_hidden ? 0.0f : std::clamp(splats[c], 0.0f, 1.0f)) + (1.0f - share) * own[c], 0.0f, 1.0f);
            if (x < 4 && y < 4) { value = 1.0f; }
            off += std::abs(static_cast<float>(seen[i] >> (8 * c) & 255) - 255.0f * value) > 1.01f ? 1 : 0;
        }
        const float depth = share >= 0.5f ? kNear / depths[i] : is_wall ? kNear / wall_z : 0.0f;
        depths_off += std::abs(seen_depths[i] - depth) > 1e-4f * depth ? 1 : 0;
    }
    CHECK(before > 100);
    CHECK(behind > 100);
    CHECK(off == 0);
    CHECK(depths_off == 0);
}

TEST_CASE("an image of floats gets the picture to the last bit, recorded or submitted with semaphores, also where another renderer draws") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = load(device, "builtin:fence");
    bsp::Renderer renderer(device), other(device);
    Asked asked(program, scene);
    asked.target.colour = *program.floats->image;
    asked.target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT;
    asked.target.colour_before = VK_IMAGE_LAYOUT_UNDEFINED;
    asked.target.colour_after = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    asked.target.depth = VK_NULL_HANDLE;
    asked.target.flags = 0;
    asked.frame.background[2] = 0.25;
    other.render(asked.frame);
    const std::vector<float> expected = other.colour(asked.view, 0).values;
    bsp::check(bsp_prepare(renderer.get(), &asked.frame));

    const vk::raii::Semaphore between(program.device, vk::SemaphoreCreateInfo());
    auto first = bsp::make<bsp_submit_info>(BSP_TYPE_SUBMIT_INFO), second = first;
    first.signal = second.wait = *between;
    std::array<std::uint64_t, 2> numbers{};
    bsp::check(bsp_submit(renderer.get(), &asked.frame, &first, &numbers[0]));
    bsp::check(bsp_submit(other.get(), &asked.frame, &second, &numbers[1]));
    while (bsp_collect(other.get(), numbers[1], nullptr) == BSP_NOT_READY) { std::this_thread::yield(); }
    CHECK(bsp_collect(renderer.get(), numbers[0], nullptr) == BSP_SUCCESS);
    CHECK(bsp_collect(renderer.get(), numbers[0], nullptr) == BSP_ERROR_INPUT);
    CHECK(program.readFloats(*program.floats, vk::ImageLayout::eTransferDstOptimal, 4) == expected);
}

TEST_CASE("two frames are under way while the head moves, scenes come and go and lists grow, and nothing waits or is said by the layers") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene small = load(device, "builtin:one-splat");
    std::optional<bsp::Scene> large(std::in_place, device, "builtin:fence");
    bsp::Renderer renderer(device);
    const auto pair = small.startViews(0.063, 1.2, kSize.x, kSize.y);
    Asked asked(program, small);
    std::array<bsp_view, 2> views = pair;
    views[0].next = views[1].next = &asked.target;
    asked.frame.views = views.data();
    asked.frame.view_count = 2;
    asked.frame.mode = BSP_MODE_TEMPORAL;
    struct Flight {
        vk::raii::CommandBuffer commands;
        vk::raii::Fence fence;
        std::uint64_t number;
    };
    std::vector<Flight> flights;
    auto result = bsp::make<bsp_frame_result>(BSP_TYPE_FRAME_RESULT);
    std::uint64_t most_visible = 0;
    const auto land = [&] {
        (void)program.device.waitForFences(*flights.front().fence, VK_TRUE, UINT64_MAX);
        bsp::check(bsp_collect(renderer.get(), flights.front().number, &result));
        most_visible = std::max(most_visible, result.splats_visible);
        flights.erase(flights.begin());
    };
    for (int i = 0; i < 100; ++i) {
        asked.frame.scene = i >= 30 && i < 90 && large && large->isThere() ? large->get() : small.get();
        if (i == 95) { large.reset(); }
        for (bsp_view& view : views) { view.position[0] += 0.002; }
        if (flights.size() == 2) { land(); }
        Flight& flight = flights.emplace_back(Flight{program.begin(), {program.device, vk::FenceCreateInfo()}, 0});
        program.drawWall(flight.commands, 0.05f);
        bsp::check(bsp_record(renderer.get(), &asked.frame, *flight.commands, &flight.number));
        program.drawSign(flight.commands);
        program.submit(flight.commands, flight.fence);
        if (i == 29) { large->wait(); }
    }
    while (!flights.empty()) { land(); }
    CHECK(most_visible > 100);
    // A frame that nobody submits leaves the next ones as they were.
    const vk::raii::CommandBuffer unused = program.begin();
    std::uint64_t number = 0;
    bsp::check(bsp_record(renderer.get(), &asked.frame, *unused, &number));
    bsp::check(bsp_discard(renderer.get(), number));
}

TEST_CASE("a device without what is needed is refused by its name, and so is a target that makes no sense") {
    {
        ForeignProgram lacking(false);
        try {
            (void)lacking.open();
            FAIL_CHECK("it was opened");
        } catch (const bsp::Error& error) {
            CHECK(error.code() == BSP_ERROR_NO_DEVICE);
            CHECK(std::string(error.what()).find("bufferDeviceAddress and scalarBlockLayout") != std::string::npos);
        }
    }
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = load(device, "builtin:one-splat");
    bsp::Renderer renderer(device);
    const vk::raii::CommandBuffer commands = program.begin();
    const auto refused = [&](const std::function<void(Asked&)>& change, const std::string& part) {
        Asked asked(program, scene);
        change(asked);
        std::uint64_t number = 0;
        CHECK(bsp_record(renderer.get(), &asked.frame, *commands, &number) == BSP_ERROR_INPUT);
        CHECK_MESSAGE(std::string(bsp_error_text()).find(part) != std::string::npos, bsp_error_text());
    };
    refused([](Asked& asked) { asked.view.next = nullptr; }, "view 0 has no bsp_target");
    refused([](Asked& asked) { asked.frame.background[0] = 1.0; }, "background");
    refused([](Asked& asked) { asked.target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT; }, "R32G32B32A32Sfloat, to be blended over");
    refused([](Asked& asked) { asked.target.depth_scale = 0.0f; }, "depth_scale");
    refused([](Asked& asked) { asked.target.colour_after = VK_IMAGE_LAYOUT_UNDEFINED; }, "UNDEFINED");
}

}  // SUITE(foreign_device)
