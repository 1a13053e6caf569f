// Facts about the library with a program's own device, command buffers and images. The validation layers are
// on, and any message fails a test.
#include "tests/engine/library/foreign_program.h"

SUITE(foreign_device) {

constexpr auto kSize = ForeignProgram::kSize;
constexpr auto kColourUse = vk::ImageLayout::eColorAttachmentOptimal;
constexpr auto kDepthUse = vk::ImageLayout::eDepthStencilAttachmentOptimal;
constexpr float kNear = 0.2f;

// An eye in front of a scene's splats, whose picture is drawn over what the program drew.
struct Asked {
    Asked(const ForeignProgram& program, const bsp::Scene& scene)
        : properties(scene.properties()),
          view(bsp::lookAt(properties.eye, properties.look, properties.up, 0.0, 1.2, kSize.x, kSize.y)[0]) {
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
    // Into the program's image of floats instead, whatever it holds.
    void drawFloats(const ForeignProgram& program) {
        target.colour = *program.floats->image;
        target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT;
        target.colour_before = VK_IMAGE_LAYOUT_UNDEFINED;
        target.colour_after = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        target.depth = VK_NULL_HANDLE;
        target.flags = 0;
    }

    bsp_scene_properties properties;
    bsp_target target = bsp::make<bsp_target>(BSP_TYPE_TARGET);
    bsp_view view;
    bsp_frame_info frame = bsp::frame();
};

// Records the frame between the program's own draws; returns its result once the device is done.
bsp_frame_result drawBetween(const ForeignProgram& program, bsp::Renderer& renderer, const Asked& asked,
                             float wall_depth) {
    const vk::raii::CommandBuffer commands = program.begin();
    program.drawWall(commands, wall_depth);
    std::uint64_t number = 0;
    bsp::check(bsp_record(renderer.get(), &asked.frame, *commands, &number));
    program.drawSign(commands);
    program.finish(commands);
    auto result = bsp::make<bsp_frame_result>(BSP_TYPE_FRAME_RESULT);
    CHECK(bsp_collect(renderer.get(), number, &result) == BSP_SUCCESS);
    return result;
}

constexpr float kNothing[4]{};

// Every pixel must show the program's own draws behind its splats: their colour, and how far they are.
void checkOver(const ForeignProgram& program, float wall_z,
               const std::function<std::pair<const float*, float>(std::size_t i, bool is_wall)>& splatsAt) {
    const std::vector<std::uint32_t> seen = program.readWords(*program.colour, kColourUse);
    const std::vector<float> seen_depths = program.readFloats(*program.depth, kDepthUse, 1);
    int off = 0, depths_off = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t x = i % kSize.x, y = i / kSize.x;
        const bool is_wall = x < kSize.x / 2, is_sign = x < 4 && y < 4;
        const auto& [splats, z] = splatsAt(i, is_wall);
        const std::array<float, 3> own =
            is_wall ? std::array{1.0f, 0.0f, 0.0f} : std::array{0.2f, 0.4f, 0.6f};
        for (std::size_t c = 0; c < 3; ++c) {
            const float over = std::clamp(splats[c], 0.0f, 1.0f) + (1.0f - splats[3]) * own[c],
                        value = is_sign ? 1.0f : std::clamp(over, 0.0f, 1.0f);
            off += std::abs(static_cast<float>(seen[i] >> (8 * c) & 255) - 255.0f * value) > 1.01f ? 1 : 0;
        }
        const float depth = splats[3] >= 0.5f ? kNear / z : is_wall ? kNear / wall_z : 0.0f;
        depths_off += std::abs(seen_depths[i] - depth) > 1e-4f * depth ? 1 : 0;
    }
    CHECK(off == 0);
    CHECK(depths_off == 0);
}

TEST_CASE(
    "by pixel, splats lie before and behind a wall that the program drew, over its picture, and its own "
    "draws go on after them") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = loaded(device, "builtin:atelier");
    bsp::Renderer renderer(device);
    Asked asked(program, scene);
    asked.target.flags |= BSP_TARGET_DEPTH_BY_PIXEL;
    bsp::check(bsp_prepare(renderer.get(), &asked.frame));
    // What must be visible, according to the picture and its depths.
    renderer.render(asked.frame);
    const std::vector<float> picture = renderer.colour(asked.view, 0).values,
                             depths = renderer.depth(asked.view, 0).values;
    std::vector<float> middle;
    std::ranges::copy_if(depths, std::back_inserter(middle), [](float depth) { return depth > 0.0f; });
    std::ranges::nth_element(middle, middle.begin() + static_cast<std::ptrdiff_t>(middle.size() / 2));
    const float wall_z = 0.9999f * middle.at(middle.size() / 2);  // no pixel lies in it
    const bsp_frame_result result = drawBetween(program, renderer, asked, kNear / wall_z);
    CHECK(result.frames_cut_short == 0);
    CHECK(result.splats_visible > 1000);

    int before = 0, behind = 0;
    checkOver(program, wall_z, [&](std::size_t i, bool is_wall) {
        const bool is_hidden = !(depths[i] > 0.0f) || (is_wall && depths[i] > wall_z);
        (is_hidden ? behind : before) += is_wall ? 1 : 0;
        return std::pair(is_hidden ? kNothing : &picture[4 * i], depths[i]);
    });
    CHECK(before > 100);
    CHECK(behind > 100);
}

// Translucent discs that face an eye at the origin, in layers from near to far; only those nearer than `end`.
bsp::Scene loadLayers(const bsp::Device& device, float end) {
    std::vector<std::array<float, 3>> positions, colours;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> aside(-1.0f, 1.0f);
    for (int i = 0; i < 600; ++i) {
        const float z = 1.0f + 0.01f * static_cast<float>(i);
        const std::array<float, 3> position{z * aside(random), z * aside(random), z},
            colour{aside(random), aside(random), aside(random)};
        if (z >= end) { break; }
        positions.push_back(position);
        colours.push_back(colour);
    }
    const std::vector<std::array<float, 4>> rotations(positions.size(), {1, 0, 0, 0});
    const std::vector<std::array<float, 2>> scales(positions.size(), {0.3f, 0.2f});
    const std::vector<float> opacities(positions.size(), 0.4f);
    auto splats = bsp::make<bsp_splats>(BSP_TYPE_SPLATS);
    splats.count = positions.size();
    splats.positions.values = positions[0].data();
    splats.rotations.values = rotations[0].data();
    splats.scales.values = scales[0].data();
    splats.opacities.values = opacities.data();
    splats.sh.values = colours[0].data();
    splats.scale_count = 2;
    splats.activated = 1;
    bsp::Scene scene(device, splats);
    scene.wait();
    return scene;
}

TEST_CASE("a wall through a cloud hides at every pixel the splats behind it and none before it") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    constexpr float kWall = 3.505f;
    const bsp::Scene all = loadLayers(device, 100.0f), nearer = loadLayers(device, kWall);
    bsp::Renderer renderer(device);
    Asked asked(program, all);
    const double eye[]{0, 0, 0}, look[]{0, 0, 1}, up[]{0, -1, 0};
    asked.view = bsp::lookAt(eye, look, up, 0.0, 1.2, kSize.x, kSize.y)[0];
    asked.view.next = &asked.target;
    const auto draw = [&](const bsp::Scene& scene) {
        asked.frame.scene = scene.get();
        renderer.render(asked.frame);
        return std::pair(renderer.colour(asked.view, 0).values, renderer.depth(asked.view, 0).values);
    };
    const auto [of_nearer, nearer_depths] = draw(nearer);
    const auto [of_all, all_depths] = draw(all);
    bsp::check(bsp_prepare(renderer.get(), &asked.frame));
    (void)drawBetween(program, renderer, asked, kNear / kWall);
    int differ = 0;
    checkOver(program, kWall, [&](std::size_t i, bool is_wall) {
        differ += is_wall && std::abs(of_nearer[4 * i + 3] - of_all[4 * i + 3]) > 0.05f ? 1 : 0;
        return is_wall ? std::pair(&of_nearer[4 * i], nearer_depths[i])
                       : std::pair(&of_all[4 * i], all_depths[i]);
    });
    CHECK(differ > 100);  // pixels of the wall with splats in front of it and behind it
}

TEST_CASE(
    "an image of floats gets the picture to the last bit, recorded or submitted with semaphores, also where "
    "another renderer draws") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = loaded(device, "builtin:fence");
    bsp::Renderer renderer(device), other(device);
    Asked asked(program, scene);
    asked.drawFloats(program);
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

TEST_CASE(
    "a frame that is discarded takes nothing along: what moved before it is where it should be in the next") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = loaded(device, "builtin:fence"), other = loaded(device, "builtin:one-splat");
    bsp::Renderer renderer(device), exact(device);
    Asked asked(program, scene);
    std::array instances{bsp::make<bsp_instance>(BSP_TYPE_INSTANCE),
                         bsp::make<bsp_instance>(BSP_TYPE_INSTANCE)};
    instances[0].scene = scene.get();
    instances[1].scene = other.get();
    asked.frame.scene = nullptr;
    asked.frame.instances = instances.data();
    asked.frame.instance_count = 2;
    asked.drawFloats(program);
    std::uint64_t number = 0;
    for (const double x : {0.9, 0.3, 0.6, 0.9}) {
        instances[0].position[0] = x;
        if (x == 0.9) { bsp::check(bsp_prepare(renderer.get(), &asked.frame)); }
        const vk::raii::CommandBuffer unused = program.begin();
        bsp::check(bsp_record(renderer.get(), &asked.frame, *unused, &number));
        bsp::check(bsp_discard(renderer.get(), number));
    }
    exact.render(asked.frame);
    const vk::raii::CommandBuffer commands = program.begin();
    bsp::check(bsp_record(renderer.get(), &asked.frame, *commands, &number));
    program.finish(commands);
    bsp::check(bsp_collect(renderer.get(), number, nullptr));
    CHECK(program.readFloats(*program.floats, vk::ImageLayout::eTransferDstOptimal, 4) ==
          exact.colour(asked.view, 0).values);
}

TEST_CASE(
    "two of the library's devices on one device of the program draw into one command buffer, each what it "
    "would draw alone") {
    ForeignProgram program;
    const bsp::Device first = program.open(), second = program.open();
    const bsp::Scene of_first = loaded(first, "builtin:one-splat"),
                     of_second = loaded(second, "builtin:fence");
    bsp::Renderer renderer(first), other(second);
    Asked asked(program, of_first), asked_other(program, of_second);
    asked_other.view = asked.view;
    asked_other.view.next = &asked_other.target;
    for (Asked* each : {&asked, &asked_other}) {
        each->target.flags = BSP_TARGET_BLEND;
        each->target.depth = VK_NULL_HANDLE;
        each->frame.flags = 0;
        bsp::check(bsp_prepare((each == &asked ? renderer : other).get(), &each->frame));
    }
    const auto draw = [&](bool of_one, bool of_other) {
        const vk::raii::CommandBuffer commands = program.begin();
        program.drawWall(commands, 0.05f);
        std::array<std::uint64_t, 2> numbers{};
        if (of_one) { bsp::check(bsp_record(renderer.get(), &asked.frame, *commands, &numbers[0])); }
        if (of_other) { bsp::check(bsp_record(other.get(), &asked_other.frame, *commands, &numbers[1])); }
        program.drawSign(commands);
        program.finish(commands);
        if (of_one) { bsp::check(bsp_collect(renderer.get(), numbers[0], nullptr)); }
        if (of_other) { bsp::check(bsp_collect(other.get(), numbers[1], nullptr)); }
        return program.readWords(*program.colour, kColourUse);
    };
    const std::vector<std::uint32_t> none = draw(false, false), one = draw(true, false),
                                     two = draw(false, true), both = draw(true, true);
    CHECK(one != none);
    CHECK(two != none);
    CHECK(one != two);
    int unlike = 0;
    for (std::size_t i = 0; i < both.size(); ++i) {
        // Where only one of them shows anything.
        if (one[i] == none[i] && both[i] != two[i]) { ++unlike; }
        if (two[i] == none[i] && both[i] != one[i]) { ++unlike; }
    }
    CHECK(unlike == 0);
}

TEST_CASE(
    "two frames are under way while the head moves, scenes come and go and lists grow, and nothing waits or "
    "is said by the layers") {
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene small = loaded(device, "builtin:one-splat");
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
        Flight& flight =
            flights.emplace_back(Flight{program.begin(), {program.device, vk::FenceCreateInfo()}, 0});
        program.drawWall(flight.commands, 0.05f);
        bsp::check(bsp_record(renderer.get(), &asked.frame, *flight.commands, &flight.number));
        program.drawSign(flight.commands);
        program.submit(flight.commands, flight.fence);
        if (i == 29) { large->wait(); }
    }
    while (!flights.empty()) { land(); }
    CHECK(most_visible > 100);
    // A frame that is never submitted does not affect the next ones.
    const vk::raii::CommandBuffer unused = program.begin();
    std::uint64_t number = 0;
    bsp::check(bsp_record(renderer.get(), &asked.frame, *unused, &number));
    bsp::check(bsp_discard(renderer.get(), number));
}

TEST_CASE("a device without what is needed is refused by its name, and so is a target that makes no sense") {
    {
        ForeignProgram lacking(false);
        checkRefusal([&] { (void)lacking.open(); }, BSP_ERROR_NO_DEVICE,
                     "bufferDeviceAddress and scalarBlockLayout");
    }
    ForeignProgram program;
    const bsp::Device device = program.open();
    const bsp::Scene scene = loaded(device, "builtin:one-splat");
    bsp::Renderer renderer(device);
    const vk::raii::CommandBuffer commands = program.begin();
    const auto refused = [&](const std::function<void(Asked&)>& change, const std::string& part) {
        Asked asked(program, scene);
        change(asked);
        std::uint64_t number = 0;
        CHECK(bsp_record(renderer.get(), &asked.frame, *commands, &number) == BSP_ERROR_INPUT);
        CHECK_MESSAGE(contains(bsp_error_text(), part), bsp_error_text());
    };
    refused([](Asked& asked) { asked.view.next = nullptr; }, "view 0 has no bsp_target");
    refused([](Asked& asked) { asked.frame.background[0] = 1.0; }, "background");
    refused([](Asked& asked) { asked.target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT; },
            "R32G32B32A32Sfloat, to be blended over");
    refused([](Asked& asked) { asked.target.depth_scale = 0.0f; }, "depth_scale");
    refused([](Asked& asked) { asked.target.colour_after = VK_IMAGE_LAYOUT_UNDEFINED; }, "UNDEFINED");
}

}  // SUITE(foreign_device)
