// Chapter 7 and section 10.3 of OpenXR on the simulated runtime: spaces, views and the visibility mask.
#include "tests/xr/simulated/api/simulated_direct.h"

SUITE(simulated_space) {

constexpr auto kFloor = XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR;
constexpr auto kHidden = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
constexpr auto kMono = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;

// The head is a metre to the right of the room's middle and turned to the left.
constexpr const char* kAside = "head 0 position 1 1.7 0 turn 90 20\nhead 1 position 2 1.7 0\n";

struct WalkingFixture : SessionFixture {
    WalkingFixture()
        : SessionFixture(
              "size 64 64\nframes none\nipd 0.06\neye left angles -50 40 45 -48\nvisibility-mask on\n"
              "head 0 position 1 1.5 2 turn 0 0\nhead 2 position 1 1.5 0 turn 90 0\n") {}
};

struct Mask {
    static constexpr std::uint32_t kMost = 512;
    std::vector<XrVector2f> vertices = std::vector<XrVector2f>(kMost);
    std::vector<std::uint32_t> indices = std::vector<std::uint32_t>(kMost);

    Mask(const SessionFixture& made, std::uint32_t view, XrVisibilityMaskTypeKHR type) {
        XrVisibilityMaskKHR mask{
            XR_TYPE_VISIBILITY_MASK_KHR, nullptr, kMost, 0, vertices.data(), kMost, 0, indices.data()};
        REQUIRE(made.XR(xrGetVisibilityMaskKHR)(made.session, kStereo, view, type, &mask) == XR_SUCCESS);
        vertices.resize(mask.vertexCountOutput);
        indices.resize(mask.indexCountOutput);
    }
    XrVector2f at(std::size_t i) const { return vertices.at(indices.at(i)); }
    float left() const { return std::ranges::min(vertices, {}, &XrVector2f::x).x; }
    float right() const { return std::ranges::max(vertices, {}, &XrVector2f::x).x; }
};

TEST_CASE_FIXTURE(SessionFixture, "spaces are VIEW, LOCAL and STAGE, of which the stage alone has bounds") {
    CHECK(checkListOf(XrReferenceSpaceType{}, xrEnumerateReferenceSpaces, session) ==
          std::vector{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL,
                      XR_REFERENCE_SPACE_TYPE_STAGE});
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr,
                                    XR_REFERENCE_SPACE_TYPE_STAGE, kIdentity};
    XrSpace space = XR_NULL_HANDLE;
    const auto make = [&] { return xrCreateReferenceSpace(session, &info, &space); };
    checkEach(XR_SUCCESS, {make(), xrDestroySpace(space)});
    CHECK(xrDestroySpace(space) == XR_ERROR_HANDLE_INVALID);
    checkArguments(xrCreateReferenceSpace, session, &info, &space);
    CHECK(with(info.referenceSpaceType, static_cast<XrReferenceSpaceType>(99), make) ==
          XR_ERROR_REFERENCE_SPACE_UNSUPPORTED);
    checkChanges(make, XR_ERROR_POSE_INVALID, to(info.poseInReferenceSpace.orientation.w, 0),
                 to(info.poseInReferenceSpace.orientation.w, 1.02f),
                 to(info.poseInReferenceSpace.position.y, NAN));

    XrExtent2Df bounds{-1, -1};
    CHECK(xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_STAGE, &bounds) == XR_SUCCESS);
    CHECK(bounds.width > 0);
    CHECK(xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_LOCAL, &bounds) ==
          XR_SPACE_BOUNDS_UNAVAILABLE);
    CHECK(bounds.width == 0);
    checkEach(XR_ERROR_VALIDATION_FAILURE,
              {xrGetReferenceSpaceBoundsRect(session, static_cast<XrReferenceSpaceType>(99), &bounds),
               xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_STAGE, nullptr)});

    // Locating needs two spaces, a time and a place for the answer.
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    checkEach(XR_ERROR_TIME_INVALID,
              {xrLocateSpace(local, local, 0, &location), xrLocateSpace(local, local, -1, &location)});
    CHECK(xrLocateSpace(local, XR_NULL_HANDLE, 1, &location) == XR_ERROR_HANDLE_INVALID);
    checkArguments([&](XrSpace of, auto* place) { return xrLocateSpace(of, local, 1, place); }, local,
                   &location);

    // A headset without a mask gives an empty one.
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    CHECK(XR(xrGetVisibilityMaskKHR)(session, kStereo, 1, XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR, &mask) ==
          XR_SUCCESS);
    CHECK(mask.vertexCountOutput == 0);
}

TEST_CASE_FIXTURE(WalkingFixture, "spaces are located as the script moves the head, and views at its eyes") {
    const XrSpace view = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW),
                  stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    XrSpaceVelocity velocity{XR_TYPE_SPACE_VELOCITY};
    const XrSpaceLocation location = locate(view, stage, kStart + 1'000'000'000, &velocity);
    CHECK(location.locationFlags == (kValid | kTracked));
    checkNear(location.pose.position, {1, 1.5f, 1});
    CHECK(location.pose.orientation.y == doctest::Approx(std::sin(M_PI / 8)));
    CHECK(these(velocity.velocityFlags, velocity.linearVelocity.z, velocity.angularVelocity.y) ==
          these(kMoving, doctest::Approx(-1), doctest::Approx(M_PI / 4).epsilon(1e-3)));
    // LOCAL starts where the head was, so relative to the head it moves the opposite way.
    checkNear(locate(view, local, kStart).pose.position, {0, 0, 0});
    CHECK(locate(view, view, kStart).pose.orientation.w == doctest::Approx(1));

    XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, kStereo, kStart, local};
    XrViewState state{XR_TYPE_VIEW_STATE};
    auto views = checkListOf(XrView{XR_TYPE_VIEW}, xrLocateViews, session, &info, &state);
    REQUIRE(views.size() == 2);
    std::uint32_t count = 0;
    const auto find = [&] { return xrLocateViews(session, &info, &state, 2, &count, views.data()); };
    CHECK(find() == XR_SUCCESS);
    CHECK(state.viewStateFlags != 0);
    CHECK(these(views[1].pose.position.x - views[0].pose.position.x, views[0].fov.angleLeft,
                views[0].fov.angleUp) ==
          these(doctest::Approx(0.06), doctest::Approx(-50 * M_PI / 180), doctest::Approx(45 * M_PI / 180)));
    CHECK(views[0].fov.angleDown == doctest::Approx(-48 * M_PI / 180));
    CHECK(views[1].fov.angleLeft == doctest::Approx(-45 * M_PI / 180));
    CHECK(xrLocateViews(session, &info, nullptr, 2, &count, views.data()) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(with(info.displayTime, 0, find) == XR_ERROR_TIME_INVALID);
    CHECK(with(info.space, XR_NULL_HANDLE, find) == XR_ERROR_HANDLE_INVALID);
    CHECK(with(info.viewConfigurationType, kMono, find) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE_FIXTURE(WalkingFixture, "the visibility mask is a mesh; its outline goes once round the axis") {
    const auto getMask = XR(xrGetVisibilityMaskKHR);
    Mask whole(*this, 0, kHidden);
    const auto vertices = static_cast<std::uint32_t>(whole.vertices.size()),
               indices = static_cast<std::uint32_t>(whole.indices.size());
    REQUIRE(indices % 3 == 0);
    for (const auto& [room, expected] :
         {std::pair(0u, XR_SUCCESS), std::pair(indices - 1, XR_ERROR_SIZE_INSUFFICIENT),
          std::pair(indices, XR_SUCCESS)}) {
        // If either capacity is 0, both counts are returned.
        XrVisibilityMaskKHR some{XR_TYPE_VISIBILITY_MASK_KHR, nullptr, vertices, 0,
                                 whole.vertices.data(),       room,    0,        whole.indices.data()};
        CHECK(getMask(session, kStereo, 0, kHidden, &some) == expected);
        CHECK(these(some.vertexCountOutput, some.indexCountOutput) == these(vertices, indices));
    }
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    checkEach(XR_ERROR_VALIDATION_FAILURE,
              {getMask(session, kStereo, 2, kHidden, &mask),
               getMask(session, kStereo, 0, static_cast<XrVisibilityMaskTypeKHR>(9), &mask)});
    CHECK(getMask(session, kMono, 0, kHidden, &mask) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    CHECK(getMask(XR_NULL_HANDLE, kStereo, 0, kHidden, &mask) == XR_ERROR_HANDLE_INVALID);

    // Counter-clockwise triangles inside the view, which together fill it.
    const double width = std::tan(50 * M_PI / 180) + std::tan(40 * M_PI / 180),
                 height = 1 + std::tan(48 * M_PI / 180);
    double areas[2] = {};
    for (const int visible : {0, 1}) {
        const Mask mesh(*this, 0, visible != 0 ? XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR : kHidden);
        CHECK(std::ranges::max(mesh.indices) < mesh.vertices.size());
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const XrVector2f a = mesh.at(i), b = mesh.at(i + 1), c = mesh.at(i + 2);
            const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
            CHECK(area > 0);
            areas[visible] += area;
        }
        CHECK(mesh.right() - mesh.left() <= width + 1e-5);
    }
    CHECK(areas[0] + areas[1] == doctest::Approx(width * height));
    // A polygon with 64 corners on the ellipse has 32 sin(pi / 32) instead of pi.
    CHECK(areas[1] == doctest::Approx(32 * std::sin(M_PI / 32) * width * height / 4));

    for (const std::uint32_t view : {0u, 1u}) {
        const Mask outline(*this, view, XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR);
        REQUIRE(outline.indices.size() >= 3);
        double turned = 0;
        for (std::size_t i = 0; i < outline.indices.size(); ++i) {
            const XrVector2f from = outline.at(i), to = outline.at((i + 1) % outline.indices.size());
            const double step = std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
            CHECK(step > 0);
            turned += step;
        }
        CHECK(turned == doctest::Approx(2 * M_PI));
        // It touches the edges.
        CHECK(outline.left() == doctest::Approx(view == 0 ? -std::tan(50 * M_PI / 180) : -1));
        CHECK(outline.right() == doctest::Approx(view == 0 ? std::tan(40 * M_PI / 180) : 1));
    }
}

TEST_CASE("a mask that changes with the eye's angles is announced once, for that eye") {
    const SessionFixture made(kQuietScript +
                              "rate 10\nvisibility-mask on\nat 0.55 eye right angles -30 30 30 -30\n");
    made.begin();
    for (int shown = 0; shown < 8; ++shown) {
        made.frame();
        const auto changes =
            made.events<XrEventDataVisibilityMaskChangedKHR>(XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR);
        REQUIRE(changes.size() == (shown == 6 ? 1 : 0));
        if (shown == 6) { CHECK(changes[0].viewIndex == 1); }
    }
}

TEST_CASE("LOCAL_FLOOR is LOCAL on the floor, in 1.1 or by its extension; recentring is announced for both") {
    for (const auto& [version, extensions] :
         {std::pair(k1_1, Extensions{}), {k1_0, {XR_EXT_LOCAL_FLOOR_EXTENSION_NAME}}, {k1_0, {}}}) {
        const HeadlessSession made(version, extensions,
                                   "rate 10\nhead 0 position 1 1.6 0 turn 90 0\n"
                                   "head 1 position -1 2.6 0 turn 190 0\nat 0.15 recentre\n");
        XrReferenceSpaceType types[8];
        std::uint32_t count = 0;
        REQUIRE(made.XR(xrEnumerateReferenceSpaces)(made.session, 8, &count, types) == XR_SUCCESS);
        const bool is_known = version == k1_1 || !extensions.empty();
        CHECK(std::count(types, types + count, kFloor) == is_known);
        XrExtent2Df bounds{-1, -1};
        CHECK(made.XR(xrGetReferenceSpaceBoundsRect)(made.session, kFloor, &bounds) ==
              (is_known ? XR_SPACE_BOUNDS_UNAVAILABLE : XR_ERROR_VALIDATION_FAILURE));
        XrSpace floor = XR_NULL_HANDLE;
        CHECK(made.trySpace(kFloor, floor) == (is_known ? XR_SUCCESS : XR_ERROR_REFERENCE_SPACE_UNSUPPORTED));
        if (is_known) {
            XrPosef pose = made.locate(floor, made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE), kStart).pose;
            checkNear(pose.position, {1, 0, 0});
            CHECK(pose.orientation.y == doctest::Approx(std::sqrt(0.5)));
            pose = made.locate(floor, made.makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL), kStart).pose;
            checkNear(pose.position, {0, -1.6f, 0});
            CHECK(pose.orientation.w == doctest::Approx(1));
        }

        made.begin();
        for (int frame = 0; frame < 3; ++frame) { REQUIRE(made.sync() == XR_SUCCESS); }
        std::vector<XrReferenceSpaceType> announced;
        for (const auto& change : made.events<XrEventDataReferenceSpaceChangePending>(
                 XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING)) {
            CHECK(these(change.session, change.changeTime) == these(made.session, kStart + 150'000'000));
            // From LOCAL's first origin, at the head's pose at time 0, to the head's pose now; LOCAL_FLOOR is
            // below it both times.
            CHECK(change.poseValid == XR_TRUE);
            const XrPosef& pose = change.poseInPreviousSpace;
            checkNear(pose.position, {0, change.referenceSpaceType == kFloor ? 0 : 0.15f, -0.3f});
            CHECK(pose.orientation.y == doctest::Approx(std::sin(std::acos(-1) / 24)));
            CHECK(pose.orientation.x == doctest::Approx(0));
            announced.push_back(change.referenceSpaceType);
        }
        CHECK(announced == (is_known ? std::vector{XR_REFERENCE_SPACE_TYPE_LOCAL, kFloor}
                                     : std::vector{XR_REFERENCE_SPACE_TYPE_LOCAL}));
    }
}

TEST_CASE("spaces are located all at once, as one by one") {
    const HeadlessSession made(k1_1, {}, kAside);
    const auto locateSpaces = made.XR(xrLocateSpaces);
    const XrSpace stage = made.makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    XrSpace spaces[3] = {made.makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW),
                         made.makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL), stage};
    XrSpaceVelocityData speeds[3];
    XrSpaceVelocities velocities{XR_TYPE_SPACE_VELOCITIES, nullptr, 3, speeds};
    XrSpaceLocationData places[3];
    XrSpaceLocations locations{XR_TYPE_SPACE_LOCATIONS, &velocities, 3, places};
    XrSpacesLocateInfo info{XR_TYPE_SPACES_LOCATE_INFO, nullptr, stage, kStart + 500'000'000, 3, spaces};
    const auto locate = [&] { return locateSpaces(made.session, &info, &locations); };
    REQUIRE(locate() == XR_SUCCESS);
    for (int i = 0; i < 3; ++i) {
        XrSpaceVelocity speed{XR_TYPE_SPACE_VELOCITY};
        const XrSpaceLocation location = made.locate(spaces[i], stage, info.time, &speed);
        CHECK(places[i].locationFlags == location.locationFlags);
        CHECK(std::memcmp(&places[i].pose, &location.pose, sizeof location.pose) == 0);
        CHECK(speeds[i].velocityFlags == speed.velocityFlags);
        CHECK(std::memcmp(&speeds[i].linearVelocity, &speed.linearVelocity, sizeof speed.linearVelocity) ==
              0);
    }
    CHECK(places[0].pose.position.x == doctest::Approx(1.5));
    CHECK(speeds[0].linearVelocity.x == doctest::Approx(1));

    CHECK(with(info.spaceCount, 0, [&] { return with(locations.locationCount, 0, locate); }) ==
          XR_ERROR_VALIDATION_FAILURE);
    checkChanges(locate, XR_ERROR_VALIDATION_FAILURE, to(info.spaceCount, 2), to(locations.locationCount, 2),
                 to(velocities.velocityCount, 2), to(velocities.velocities, nullptr),
                 to(locations.locations, nullptr), to(info.spaces, nullptr));
    checkChanges(locate, XR_ERROR_TIME_INVALID, to(info.time, 0), to(info.time, -42));
    checkChanges(locate, XR_ERROR_HANDLE_INVALID, to(info.baseSpace, XR_NULL_HANDLE),
                 to(spaces[2], XR_NULL_HANDLE));
    checkArguments(locateSpaces, made.session, &info, &locations);
}

}  // SUITE(simulated_space)
