// Facts about the library with a program's own device, images and command buffers; its layers say nothing.
#include "tests/engine/library/foreign_program.h"
#include "tests/engine/twin/reference_scenes.h"

SUITE(foreign_device) {

constexpr auto kSize = ForeignProgram::kSize;
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

std::uint64_t record(const bsp::Renderer& renderer, const Asked& asked,
                     const vk::raii::CommandBuffer& commands) {
    std::uint64_t number = 0;
    bsp::check(bsp_record(renderer.get(), &asked.frame, *commands, &number));
    return number;
}

// Records the frame between the program's own draws; returns its result once the device is done.
bsp_frame_result drawBetween(const ForeignProgram& program, bsp::Renderer& renderer, const Asked& asked,
                             float wall_depth) {
    const vk::raii::CommandBuffer commands = program.begin();
    program.drawWall(commands, wall_depth);
    const std::uint64_t number = record(renderer, asked, commands);
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
    const auto seen = program.read<std::uint32_t>(program.colour, 1);
    const auto seen_depths = program.read<float>(program.depth, 1);
    int off = 0, depths_off = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t x = i % kSize.x, y = i / kSize.x;
        const bool is_wall = x < kSize.x / 2, is_sign = x < 4 && y < 4;
        const auto& [splats, z] = splatsAt(i, is_wall);
        const auto own = is_wall ? std::array{1.0f, 0.0f, 0.0f} : std::array{0.2f, 0.4f, 0.6f};
        for (std::size_t c = 0; c < 3; ++c) {
            const float over = std::clamp(splats[c], 0.0f, 1.0f) + (1.0f - splats[3]) * own[c],
                        value = is_sign ? 1.0f : std::clamp(over, 0.0f, 1.0f);
            off += std::abs(static_cast<float>(seen[i] >> (8 * c) & 255) - 255.0f * value) > 1.01f ? 1 : 0;
        }
        const float depth = splats[3] >= 0.5f ? kNear / z : is_wall ? kNear / wall_z : 0.0f;
        depths_off += std::abs(seen_depths[i] - depth) > 1e-4f * depth ? 1 : 0;
    }
    CHECK(these(off, depths_off) == these(0, 0));
}

// A program and the library on its device.
struct OnForeign {
    [[nodiscard]] bsp::Scene load(const std::string& source) const { return loaded(device, source); }

    ForeignProgram program;
    const bsp::Device device = program.open();
    bsp::Renderer renderer{device}, other{device};
};

TEST_CASE_FIXTURE(OnForeign, "by pixel, splats lie before and behind a wall, and under later draws") {
    const bsp::Scene scene = load("builtin:atelier");
    Asked asked(program, scene);
    asked.target.flags |= BSP_TARGET_DEPTH_BY_PIXEL;
    bsp::check(bsp_prepare(renderer.get(), &asked.frame));
    // What must be visible, according to the picture and its depths.
    renderer.render(asked.frame);
    const std::vector<float> picture = renderer.colour(asked.view, 0).values,
                             depths = renderer.depth(asked.view, 0).values;
    std::vector<float> sorted = depths;
    std::erase_if(sorted, [](float depth) { return !(depth > 0.0f); });
    std::ranges::sort(sorted);
    const float wall_z = 0.9999f * sorted.at(sorted.size() / 2);  // no pixel lies in it
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
    std::vector<Splat> splats;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> aside(-1.0f, 1.0f), shade(0.2f, 0.8f);
    for (int i = 0; i < 600; ++i) {
        const float z = 1.0f + 0.01f * static_cast<float>(i);
        if (z >= end) { break; }
        splats.push_back({.position = {z * aside(random), z * aside(random), z},
                          .scale = {0.3f, 0.2f},
                          .opacity = 0.4f,
                          .colour = {shade(random), shade(random), shade(random)}});
    }
    return loaded(device, makeScene(splats));
}

TEST_CASE_FIXTURE(OnForeign, "a wall through a cloud hides at every pixel the splats behind it, no other") {
    constexpr float kWall = 3.505f;
    const bsp::Scene all = loadLayers(device, 100.0f), nearer = loadLayers(device, kWall);
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

TEST_CASE_FIXTURE(OnForeign, "an image of floats gets the picture to the last bit, after a semaphore") {
    const bsp::Scene scene = load("builtin:fence");
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
    CHECK(program.readFloats() == expected);
}

TEST_CASE_FIXTURE(OnForeign, "what moved before a discarded frame is where it should be in the next") {
    const bsp::Scene fence = load("builtin:fence"), splat = load("builtin:one-splat");
    Asked asked(program, fence);
    std::array<bsp_instance, 2> instances;
    instances.fill(bsp::make<bsp_instance>(BSP_TYPE_INSTANCE));
    instances[0].scene = fence.get();
    instances[1].scene = splat.get();
    asked.frame.scene = nullptr;
    asked.frame.instances = instances.data();
    asked.frame.instance_count = 2;
    asked.drawFloats(program);
    for (const double x : {0.9, 0.3, 0.6, 0.9}) {
        instances[0].position[0] = x;
        if (x == 0.9) { bsp::check(bsp_prepare(renderer.get(), &asked.frame)); }
        const vk::raii::CommandBuffer unused = program.begin();
        bsp::check(bsp_discard(renderer.get(), record(renderer, asked, unused)));
    }
    other.render(asked.frame);
    const vk::raii::CommandBuffer commands = program.begin();
    const std::uint64_t number = record(renderer, asked, commands);
    program.finish(commands);
    bsp::check(bsp_collect(renderer.get(), number, nullptr));
    CHECK(program.readFloats() == other.colour(asked.view, 0).values);
}

TEST_CASE_FIXTURE(OnForeign, "two library devices on one device draw each what it draws alone") {
    const bsp::Device second = program.open();
    const bsp::Scene splat = load("builtin:one-splat"), fence = loaded(second, "builtin:fence");
    const bsp::Renderer of_second(second);
    Asked asked(program, splat), asked_second(program, fence);
    asked_second.view = asked.view;
    asked_second.view.next = &asked_second.target;
    using Drawer = std::pair<const bsp::Renderer*, Asked*>;
    const Drawer drawer(&renderer, &asked), second_drawer(&of_second, &asked_second);
    for (const auto& [drawn_by, what] : {drawer, second_drawer}) {
        what->target.flags = BSP_TARGET_BLEND;
        what->target.depth = VK_NULL_HANDLE;
        what->frame.flags = 0;
        bsp::check(bsp_prepare(drawn_by->get(), &what->frame));
    }
    const auto draw = [&](const std::vector<Drawer>& drawers) {
        const vk::raii::CommandBuffer commands = program.begin();
        program.drawWall(commands, 0.05f);
        std::vector<std::uint64_t> numbers;
        for (const auto& [drawn_by, what] : drawers) {
            numbers.push_back(record(*drawn_by, *what, commands));
        }
        program.drawSign(commands);
        program.finish(commands);
        for (std::size_t i = 0; i < drawers.size(); ++i) {
            bsp::check(bsp_collect(drawers[i].first->get(), numbers[i], nullptr));
        }
        return program.read<std::uint32_t>(program.colour, 1);
    };
    const auto none = draw({}), one = draw({drawer}), two = draw({second_drawer}),
               both = draw({drawer, second_drawer});
    CHECK(one != none);
    CHECK(two != none);
    CHECK(one != two);
    for (std::size_t i = 0; i < both.size(); ++i) {
        // Where only one of them shows anything.
        if (one[i] == none[i]) { REQUIRE(both[i] == two[i]); }
        if (two[i] == none[i]) { REQUIRE(both[i] == one[i]); }
    }
}

TEST_CASE_FIXTURE(OnForeign, "two frames are under way while heads move, scenes come and go and lists grow") {
    const bsp::Scene small = load("builtin:one-splat");
    std::optional<bsp::Scene> large(std::in_place, device, "builtin:fence");
    Asked asked(program, small);
    std::array<bsp_view, 2> views = small.startViews(0.063, 1.2, kSize.x, kSize.y);
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
        flight.number = record(renderer, asked, flight.commands);
        program.drawSign(flight.commands);
        program.submit(flight.commands, flight.fence);
        if (i == 29) { large->wait(); }
    }
    while (!flights.empty()) { land(); }
    CHECK(most_visible > 100);
    // A frame that is never submitted does not affect the next ones.
    const vk::raii::CommandBuffer unused = program.begin();
    bsp::check(bsp_discard(renderer.get(), record(renderer, asked, unused)));
}

TEST_CASE("a device without what is needed is refused by its name") {
    ForeignProgram lacking(false);
    checkRefusal([&] { (void)lacking.open(); }, BSP_ERROR_NO_DEVICE,
                 "bufferDeviceAddress and scalarBlockLayout");
}

TEST_CASE_FIXTURE(OnForeign, "a target that makes no sense is refused") {
    const bsp::Scene scene = load("builtin:one-splat");
    const vk::raii::CommandBuffer commands = program.begin();
    const auto refused = [&](const std::function<void(Asked&)>& change, const std::string& part) {
        Asked asked(program, scene);
        change(asked);
        checkRefusal([&] { (void)record(renderer, asked, commands); }, BSP_ERROR_INPUT, part);
    };
    refused([](Asked& asked) { asked.view.next = nullptr; }, "view 0 has no bsp_target");
    refused([](Asked& asked) { asked.frame.background[0] = 1.0; }, "background");
    refused([](Asked& asked) { asked.target.colour_format = VK_FORMAT_R32G32B32A32_SFLOAT; },
            "R32G32B32A32Sfloat, to be blended over");
    refused([](Asked& asked) { asked.target.depth_scale = 0.0f; }, "depth_scale");
    refused([](Asked& asked) { asked.target.colour_after = VK_IMAGE_LAYOUT_UNDEFINED; }, "UNDEFINED");
}

}  // SUITE(foreign_device)
