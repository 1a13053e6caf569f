// Facts about scenes whose parts come and go: they look like a scene that stays, and no frame waits for them.
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/scene_pages.h"

SUITE(resident_scene) {

// In Morton's order.
ViewedScene inOrder(ViewedScene view) {
    view.scene = inMortonOrder(view.scene);
    return view;
}

struct Atelier : Gpu {
    const ViewedScene view = inOrder(viewAtelier({96, 80}));
    const std::vector<Eye> eye{view.eye};
};

std::vector<Eye> eyesFor(Mode mode, const Eye& middle, double cant = 0.0) {
    if (mode == Mode::kMono) { return {middle}; }
    const std::array<Eye, 2> eyes = stereoPair(middle, 0.063);
    return {eyes[0], turned(eyes[1], cant)};
}

// The values of each eye's picture.
std::vector<std::vector<float>> render(StereoFrame& frame, const std::vector<Eye>& eyes,
                                       const FrameSettings& settings = makeSettings(Mode::kMono)) {
    frame.render(eyes, settings);
    std::vector<std::vector<float>> pictures;
    for (int e = 0; e < static_cast<int>(eyes.size()); ++e) {
        pictures.push_back(frame.readPicture(e).values);
    }
    return pictures;
}

// A scene in `parts` parts of about equal size, each along Morton's curve.
std::vector<Scene> inParts(const Scene& scene, std::size_t parts) {
    std::vector<Scene> some;
    for (std::size_t p = 0; p < parts; ++p) {
        const std::size_t first = p * scene.size() / parts, end = (p + 1) * scene.size() / parts;
        std::vector<std::uint32_t> splats(end - first);
        std::iota(splats.begin(), splats.end(), static_cast<std::uint32_t>(first));
        some.push_back(pickSplats(scene, splats));
    }
    return some;
}

// Room for a scene and some more pages, to which parts of it come.
struct Room : ResidentScene {
    Room(const Context& context, const Scene& whole, std::uint32_t more = 0)
        : ResidentScene(context, traitsOf(whole), {.capacity_pages = pagesOf(whole.size()) + more}) {}

    std::optional<Part> add(const Scene& part, float fade = 1.0f) {
        return ResidentScene::add(PackedPages(part, traits()), fade);
    }
    std::vector<Part> addAll(const std::vector<Scene>& scenes) {
        std::vector<Part> parts;
        for (const Scene& scene : scenes) { parts.push_back(add(scene).value()); }
        return parts;
    }
};

void checkPagesAreTheScene(const Context& context, const ViewedScene& view, Mode mode, double cant = 0.0) {
    INFO(view.name, ", ", nameOf(mode), ", cant ", cant);
    const WholeInPages pages(context, view.scene, 7);
    KeptFrame frame(context, pages.resident.scene()), other(context, view.scene);
    FrameSettings settings = makeSettings(mode);
    settings.order = cant > 0.0 ? Order::kDistance : Order::kDepth;
    for (int step = 0; step < 3; ++step) {
        Eye eye = view.eye;
        eye.world_from_camera.position.x += 0.004 * step;
        const std::vector<Eye> eyes = eyesFor(mode, eye, cant);
        CHECK(render(frame, eyes, settings) == render(other, eyes, settings));
    }
}

TEST_CASE_FIXTURE(Atelier, "all of a scene in pages is the scene that stays, byte for byte") {
    checkPagesAreTheScene(context(), view, Mode::kPaper);
    checkPagesAreTheScene(context(), view, Mode::kTemporal, 0.05);
    checkPagesAreTheScene(context(), inOrder(viewGaussians({96, 80}, true)), Mode::kMono);
}

TEST_CASE_FIXTURE(Atelier, "all of a scene in pages is the scene that stays, in every mode" * nightly()) {
    for (const Mode mode : {Mode::kMono, Mode::kTwoPass, Mode::kShared, Mode::kPaper, Mode::kPredicted,
                            Mode::kAlternate, Mode::kTemporal}) {
        for (const double cant : {0.0, 0.05}) { checkPagesAreTheScene(context(), view, mode, cant); }
        checkPagesAreTheScene(context(), inOrder(viewGaussians({96, 80}, true)), mode);
    }
}

TEST_CASE_FIXTURE(Gpu, "what is there is seen, and nothing else, and hundreds of changes take no memory") {
    const ViewedScene view = inOrder(viewAtelier({160, 144}));
    constexpr std::uint32_t kParts = 16;
    const std::vector<Scene> parts = inParts(view.scene, kParts);
    Room room(context(), view.scene, kParts);
    KeptFrame frame(context(), room.scene());
    std::vector<std::optional<ResidentScene::Part>> there(kParts);
    std::mt19937 random(5);
    const std::vector<Eye> eyes = eyesFor(Mode::kShared, view.eye);
    const FrameSettings settings = makeSettings(Mode::kShared);
    std::uint64_t bytes = 0;
    for (int step = 0; step < 50; ++step) {
        for (std::size_t p = 0; p < kParts; ++p) {
            if (random() % 2 == 0) { continue; }
            if (there[p]) {
                room.remove(*std::exchange(there[p], std::nullopt));
            } else {
                there[p] = room.add(parts[p]).value();
            }
        }
        frame.renderAhead(eyes, settings);
        if (step == 10) { bytes = room.scene().bytes(); }
        if (step % 10 != 9) { continue; }
        const auto pictures = picturesOf(frame);
        Scene scene = pickSplats(view.scene, {});
        for (std::size_t p = 0; p < kParts; ++p) {
            if (there[p]) { appendSplats(scene, parts[p]); }
        }
        CHECK(room.splatsShown() == scene.size());
        KeptFrame other(context(), scene);
        other.render(eyes, settings);
        // Splats of equal depth are ordered by their places in memory, which differ.
        CHECK(psnrDb(pictures, picturesOf(other)) >= 100.0);
    }
    frame.finish();
    CHECK(room.scene().bytes() == bytes);
    for (const auto& part : there) {
        if (part) { room.remove(*part); }
    }
    CHECK(room.freePages() == room.capacityPages());
    CHECK(countOf(frame.render(eyes, settings), "splats_visible_left") == 0);
}

TEST_CASE_FIXTURE(Atelier, "a fade multiplies opacities, and at 0 nothing is seen or culled") {
    WholeInPages pages(context(), view.scene);
    KeptFrame frame(context(), pages.resident.scene());
    for (const float fade : {1.0f, 0.37f, 0.0f, 0.9f}) {
        CAPTURE(fade);
        pages.resident.setFade(pages.part, fade);
        Scene scene = view.scene;
        for (float& opacity : scene.opacities) { opacity *= fade; }
        KeptFrame other(context(), scene);
        CHECK(render(frame, eye) == render(other, eye));
    }
}

TEST_CASE_FIXTURE(Atelier, "a part that is longer than what a frame brings is seen once all of it is there") {
    const std::uint32_t pages = pagesOf(view.scene.size());
    ResidentScene resident(context(), traitsOf(view.scene),
                           {.capacity_pages = pages, .most_bytes_a_frame = 1});
    const auto add = [&] { return resident.add(PackedPages(view.scene, resident.traits())).value(); };
    const ResidentScene::Part part = add();
    KeptFrame frame(context(), resident.scene());
    const auto countVisible = [&] {
        return countOf(frame.render(eye, makeSettings(Mode::kMono)), "splats_visible");
    };
    for (std::uint32_t page = 1; page <= pages; ++page) {
        CHECK((countVisible() > 0) == (page == pages));
        CHECK(resident.isInPlace(part) == (page == pages));
    }
    CHECK(resident.splatsShown() == view.scene.size());
    CHECK_FALSE(resident.hasChanges());
    // A part that is removed before that was never there.
    resident.remove(part);
    const ResidentScene::Part other = add();
    (void)countVisible();
    resident.remove(other);
    CHECK(countVisible() == 0);
    CHECK(these(resident.splatsAdded(), resident.freePages()) == these(0, pages));
}

TEST_CASE_FIXTURE(Atelier, "what has no room, or is of another kind, is refused, and the rest stays") {
    const SceneTraits traits = traitsOf(view.scene);
    CHECK_THROWS_AS(ResidentScene(context(), traits, {.capacity_pages = 0}), Error);
    ResidentScene resident(context(), traits, {.capacity_pages = pagesOf(view.scene.size()) + 1});
    const ResidentScene::Part part = resident.add(PackedPages(view.scene, traits)).value();
    PackedPages more(view.scene, 0, gpu::kPageSplats + 1, traits);
    CHECK_FALSE(resident.add(std::move(more)).has_value());
    CHECK(these(more.pageCount(), resident.freePages()) == these(2, 1));  // unchanged
    CHECK(resident.add(PackedPages(view.scene, 0, gpu::kPageSplats, traits)).has_value());
    resident.remove(part);
    CHECK(resident.add(std::move(more)).has_value());
    CHECK_THROWS_AS(PackedPages(viewGaussians({16, 16}, false).scene, traits), Error);
}

TEST_CASE_FIXTURE(Gpu, "colours with fewer SH bands than the scene's stay, those with more lose them") {
    ViewedScene view = viewBuiltin("builtin:atelier", {96, 80}, 4000);
    REQUIRE(view.scene.sh_degree > 0);
    Scene flat = view.scene;
    LoadNotes notes;
    limitShDegree(flat, 0, notes);
    KeptFrame other(context(), flat);
    const auto wanted = render(other, {view.eye});
    for (const auto& [scene, traits] :
         {std::pair(&flat, traitsOf(view.scene)), std::pair(&view.scene, traitsOf(flat))}) {
        ResidentScene resident(context(), traits, {.capacity_pages = pagesOf(scene->size())});
        REQUIRE(resident.add(PackedPages(*scene, traits)).has_value());
        other.show(resident.scene());
        CHECK(render(other, {view.eye}) == wanted);
    }
}

TEST_CASE_FIXTURE(Atelier, "kernels that are made ahead leave what has come to the frame that is drawn") {
    const WholeInPages pages(context(), view.scene);
    KeptFrame frame(context(), pages.resident.scene());
    const std::vector<Eye> eyes = eyesFor(Mode::kTemporal, view.eye);
    frame.makeKernels(eyes, makeSettings(Mode::kTemporal));
    CHECK(pages.resident.hasChanges());
    const FrameResult first = frame.render(eyes, makeSettings(Mode::kShared));
    CHECK(countOf(first, "splats_visible_left") > 0);
    CHECK_FALSE(pages.resident.hasChanges());
    // If nothing arrives, nothing is recorded.
    CHECK(countOf(frame.render(eyes, makeSettings(Mode::kShared)), "commands") < countOf(first, "commands"));
}

TEST_CASE("frames go on while parts come and go, though the device has not begun") {
    vk::PhysicalDeviceTimelineSemaphoreFeatures waits_for_host(VK_TRUE);
    const Context context(
        {.device = {}, .validation = true, .max_allocation_bytes = 0, .device_features = &waits_for_host});
    const ViewedScene view = inOrder(viewAtelier({96, 80}));
    const std::vector<Scene> parts = inParts(view.scene, 4);
    Room room(context, view.scene, 4);
    const std::vector<ResidentScene::Part> there = room.addAll(parts);
    StereoFrame frame(context, room.scene());
    const std::vector<Eye> eyes = eyesFor(Mode::kShared, view.eye);
    const FrameSettings settings = makeSettings(Mode::kShared);
    frame.renderAhead(eyes, settings);
    // Everything submitted from now on waits for the host. If this waited for a frame, with changes or
    // without, it would wait for ever.
    const vk::SemaphoreTypeCreateInfo timeline(vk::SemaphoreType::eTimeline, 0);
    const vk::raii::Semaphore gate = context.device().createSemaphore(vk::SemaphoreCreateInfo({}, &timeline));
    constexpr std::uint64_t kOpen = 1;
    const auto values = vk::TimelineSemaphoreSubmitInfo().setWaitSemaphoreValues(kOpen);
    const vk::PipelineStageFlags stages = vk::PipelineStageFlagBits::eAllCommands;
    const vk::raii::CommandPool pool = context.device().createCommandPool({{}, context.queueFamily()});
    const vk::raii::CommandBuffers hold(
        context.device(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
    hold[0].begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    hold[0].pipelineBarrier(stages, stages, {}, {}, {}, {});
    hold[0].end();
    context.queue().submit(vk::SubmitInfo(*gate, stages, *hold[0], {}, &values));
    room.remove(there[0]);
    room.setFade(there[1], 0.5f);
    CHECK_FALSE(frame.renderAhead(eyes, settings).has_value());
    // Into the place of the first part, which the frame in flight still reads.
    REQUIRE(room.add(parts[0]).has_value());
    room.remove(there[2]);
    CHECK_FALSE(frame.renderAhead(eyes, settings).has_value());
    context.device().signalSemaphore(vk::SemaphoreSignalInfo(*gate, kOpen));
    const FrameResult last = frame.finish().value();
    CHECK(countOf(last, "frames_cut_short") == 0);
    CHECK(countOf(last, "splats_visible_left") > 0);
    context.device().waitIdle();
    CHECK(context.validationMessages().empty());
}

TEST_CASE_FIXTURE(Atelier, "lists have room for what comes, so that no frame is cut short for it") {
    const std::vector<Scene> parts = inParts(view.scene, 8);
    Room room(context(), view.scene, 8);
    KeptFrame frame(context(), room.scene(), {.first_capacity = {1, 1}, .threads_per_cell = 0});
    for (std::size_t step = 0; step < 24; ++step) {
        if (step % 3 == 0) { REQUIRE(room.add(parts[step / 3]).has_value()); }
        frame.renderAhead(eyesFor(Mode::kShared, view.eye), makeSettings(Mode::kShared));
    }
    CHECK(countOf(*frame.finish(), "frames_cut_short") == 0);
}

TEST_CASE_FIXTURE(Gpu, "where a part is exchanged, pictures from histories are right within some frames") {
    const ViewedScene view = inOrder(viewAtelier({160, 144}));
    // What is in front of the walls is replaced by the same in other colours.
    const std::vector<Scene> parts = inParts(view.scene, 12);
    Scene other = parts[5];
    for (float& value : other.sh) { value = -value; }
    for (const bool fades : {false, true}) {
        CAPTURE(fades);
        Room room(context(), view.scene, 24);
        const std::vector<ResidentScene::Part> there = room.addAll(parts);
        // The other frames are recorded after the first, which brings the changes.
        KeptFrame first(context(), room.scene());
        const auto second = StereoFrame::beside(first), full = StereoFrame::beside(first);
        Eye eye = view.eye;
        int step = 0;
        const auto go = [&](StereoFrame& frame, Mode mode) {
            frame.render(eyesFor(mode, eye), makeSettings(mode));
            return picturesOf(frame);
        };
        const auto psnrs = [&] {
            eye.world_from_camera.position.x = view.eye.world_from_camera.position.x + 0.002 * ++step;
            const auto shown = go(first, Mode::kTemporal), too = go(*second, Mode::kTemporal),
                       wanted = go(*full, Mode::kShared);
            return std::array{psnrDb(shown, wanted), psnrDb(too, wanted)};
        };
        std::array<double, 2> before{}, after{};
        for (int frame = 0; frame < 12; ++frame) { before = psnrs(); }
        const ResidentScene::Part come = room.add(other, fades ? 0.0f : 1.0f).value();
        if (fades) {
            for (const float share : {0.25f, 0.5f, 0.75f, 1.0f}) {
                room.setFade(come, share);
                room.setFade(there[5], 1.0f - share);
                psnrs();
            }
        } else {
            room.remove(there[5]);
        }
        for (int frame = 0; frame < 8; ++frame) { after = psnrs(); }
        // If changes were not announced: 17.5 dB lower, and 2.9 lower while it fades.
        CHECK(after[0] >= before[0] - 3.0);
        CHECK(after[1] == doctest::Approx(after[0]).epsilon(1e-6));
    }
}

TEST_CASE_FIXTURE(Gpu, "a frame looks at the pages that may be seen, and says how many") {
    const ViewedScene view = inOrder(viewBuiltin("builtin:atelier", {96, 96}, 100000));
    const std::uint32_t pages = pagesOf(view.scene.size());
    std::vector<reference::Page> bounds;
    for (std::uint32_t p = 0; p < pages; ++p) {
        const std::size_t first = std::size_t{p} * gpu::kPageSplats;
        bounds.push_back(reference::boundPage(
            view.scene, first, std::min<std::size_t>(gpu::kPageSplats, view.scene.size() - first)));
    }
    const WholeInPages whole(context(), view.scene, 50);
    KeptFrame frame(context(), whole.resident.scene());
    for (const double zoom : {1.0, 2.0, 8.0, 16.0}) {
        CAPTURE(zoom);
        Eye eye = view.eye;
        eye.intrinsics.fx *= zoom, eye.intrinsics.fy *= zoom;
        const FrameResult result = frame.render({&eye, 1}, makeSettings(Mode::kMono));
        const auto seen = std::ranges::count(reference::cullPages(bounds, false, {&eye, 1}, {}), 1);
        CHECK(countOf(result, "pages_resident") == pages);
        CHECK(countOf(result, "pages_seen") == within(seen - 2, seen + 2));
        CHECK(countOf(result, "splats_visible") > 0);
        // Boxes find about twice as many pages as hold a visible splat, and not more.
        const auto visible = reference::cull(view.scene, {&eye, 1}, {});
        std::set<std::size_t> needed;
        for (std::size_t i = 0; i < visible.size(); ++i) {
            if (visible[i] != 0) { needed.insert(i / gpu::kPageSplats); }
        }
        CHECK(static_cast<double>(countOf(result, "pages_seen")) <=
              2.5 * static_cast<double>(needed.size()) + 4.0);
    }
}

}  // SUITE(resident_scene)
