// Chapter 7 and section 10.3 of OpenXR on the simulated runtime: spaces, views and the visibility mask.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <cmath>

TEST_SUITE_BEGIN("simulated_space");

namespace simulated_space_test {

using namespace binosplat::test;

namespace {

constexpr XrSpaceLocationFlags kAll = XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
                                      XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr XrTime kStart = 1'000'000'000;

struct WalkingFixture : SessionFixture {
    WalkingFixture()
        : SessionFixture(
              "size 64 64\nframes none\nipd 0.06\neye left angles -50 40 45 -48\nvisibility-mask on\n"
              "head 0 position 1 1.5 2 turn 0 0\nhead 2 position 1 1.5 0 turn 90 0\n") {}
};

struct NarrowingFixture : SessionFixture {
    NarrowingFixture() : SessionFixture("size 64 64\nframes none\nrate 10\nvisibility-mask on\nat 0.55 eye right angles -30 30 30 -30\n") {}
};

}  // namespace

TEST_CASE_FIXTURE(SessionFixture, "reference spaces are VIEW, LOCAL and STAGE") {
    std::uint32_t count = 0;
    CHECK(xrEnumerateReferenceSpaces(session, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(count == 3);
    XrReferenceSpaceType types[3];
    CHECK(xrEnumerateReferenceSpaces(session, 3, &count, types) == XR_SUCCESS);
    CHECK(types[2] == XR_REFERENCE_SPACE_TYPE_STAGE);
    CHECK(xrEnumerateReferenceSpaces(session, 2, &count, types) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrEnumerateReferenceSpaces(session, 3, &count, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrEnumerateReferenceSpaces(XR_NULL_HANDLE, 0, &count, nullptr) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "a reference space has a type and a pose") {
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, XR_REFERENCE_SPACE_TYPE_STAGE, kIdentity};
    XrSpace space = XR_NULL_HANDLE;
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_SUCCESS);
    CHECK(xrDestroySpace(space) == XR_SUCCESS);
    CHECK(xrDestroySpace(space) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrCreateReferenceSpace(session, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrCreateReferenceSpace(session, nullptr, &space) == XR_ERROR_VALIDATION_FAILURE);
    info.referenceSpaceType = static_cast<XrReferenceSpaceType>(99);
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_ERROR_REFERENCE_SPACE_UNSUPPORTED);
    info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_STAGE;
    info.poseInReferenceSpace.orientation = {0, 0, 0, 0};
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_ERROR_POSE_INVALID);
    info.poseInReferenceSpace.orientation = {0, 0, 0, 1.02f};
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_ERROR_POSE_INVALID);
    info.poseInReferenceSpace = kIdentity;
    info.poseInReferenceSpace.position.y = NAN;
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_ERROR_POSE_INVALID);
    info.poseInReferenceSpace = kIdentity;
    info.type = XR_TYPE_ACTION_SPACE_CREATE_INFO;
    CHECK(xrCreateReferenceSpace(session, &info, &space) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(SessionFixture, "the stage has bounds, other spaces have none") {
    XrExtent2Df bounds{-1, -1};
    CHECK(xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_STAGE, &bounds) == XR_SUCCESS);
    CHECK(bounds.width > 0);
    CHECK(xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_LOCAL, &bounds) == XR_SPACE_BOUNDS_UNAVAILABLE);
    CHECK(bounds.width == 0);
    CHECK(xrGetReferenceSpaceBoundsRect(session, static_cast<XrReferenceSpaceType>(99), &bounds) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrGetReferenceSpaceBoundsRect(session, XR_REFERENCE_SPACE_TYPE_STAGE, nullptr) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(WalkingFixture, "spaces are located in one another as the script moves the head") {
    const XrSpace view = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW), stage = makeSpace(XR_REFERENCE_SPACE_TYPE_STAGE);
    XrSpaceVelocity velocity{XR_TYPE_SPACE_VELOCITY};
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION, &velocity};
    CHECK(xrLocateSpace(view, stage, kStart + 1'000'000'000, &location) == XR_SUCCESS);
    CHECK(location.locationFlags == kAll);
    CHECK(location.pose.position.x == doctest::Approx(1));
    CHECK(location.pose.position.y == doctest::Approx(1.5));
    CHECK(location.pose.position.z == doctest::Approx(1));
    CHECK(location.pose.orientation.y == doctest::Approx(std::sin(M_PI / 8)));
    CHECK(velocity.velocityFlags == (XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT));
    CHECK(velocity.linearVelocity.z == doctest::Approx(-1));
    CHECK(velocity.angularVelocity.y == doctest::Approx(M_PI / 4).epsilon(1e-3));
    // LOCAL starts where the head was: the way back from the head to it is the way that the head went.
    CHECK(xrLocateSpace(view, local, kStart, &location) == XR_SUCCESS);
    CHECK(location.pose.position.z == doctest::Approx(0));
    CHECK(location.pose.position.y == doctest::Approx(0));
    CHECK(xrLocateSpace(view, view, kStart, &location) == XR_SUCCESS);
    CHECK(location.pose.orientation.w == doctest::Approx(1));
}

TEST_CASE_FIXTURE(SessionFixture, "locating wants two spaces, a time and a place for the answer") {
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    CHECK(xrLocateSpace(local, local, 0, &location) == XR_ERROR_TIME_INVALID);
    CHECK(xrLocateSpace(local, local, -1, &location) == XR_ERROR_TIME_INVALID);
    CHECK(xrLocateSpace(XR_NULL_HANDLE, local, 1, &location) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrLocateSpace(local, XR_NULL_HANDLE, 1, &location) == XR_ERROR_HANDLE_INVALID);
    CHECK(xrLocateSpace(local, local, 1, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    location.type = XR_TYPE_SPACE_VELOCITY;
    CHECK(xrLocateSpace(local, local, 1, &location) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(WalkingFixture, "views are the eyes' poses and angles") {
    XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, kStart, local};
    XrViewState state{XR_TYPE_VIEW_STATE};
    XrView views[2] = {{XR_TYPE_VIEW}, {XR_TYPE_VIEW}};
    std::uint32_t count = 0;
    CHECK(xrLocateViews(session, &info, &state, 2, &count, views) == XR_SUCCESS);
    CHECK(count == 2);
    CHECK(state.viewStateFlags != 0);
    CHECK(views[1].pose.position.x - views[0].pose.position.x == doctest::Approx(0.06));
    CHECK(views[0].fov.angleLeft == doctest::Approx(-50 * M_PI / 180));
    CHECK(views[1].fov.angleLeft == doctest::Approx(-45 * M_PI / 180));

    CHECK(xrLocateViews(session, &info, &state, 1, &count, views) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrLocateViews(session, &info, &state, 0, &count, nullptr) == XR_SUCCESS);
    CHECK(xrLocateViews(session, &info, &state, 2, nullptr, views) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrLocateViews(session, &info, nullptr, 2, &count, views) == XR_ERROR_VALIDATION_FAILURE);
    views[1].type = XR_TYPE_VIEW_STATE;
    CHECK(xrLocateViews(session, &info, &state, 2, &count, views) == XR_ERROR_VALIDATION_FAILURE);
    views[1].type = XR_TYPE_VIEW;
    info.displayTime = 0;
    CHECK(xrLocateViews(session, &info, &state, 2, &count, views) == XR_ERROR_TIME_INVALID);
    info.displayTime = kStart;
    info.space = XR_NULL_HANDLE;
    CHECK(xrLocateViews(session, &info, &state, 2, &count, views) == XR_ERROR_HANDLE_INVALID);
    info.space = local;
    info.viewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
    CHECK(xrLocateViews(session, &info, &state, 2, &count, views) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
}

TEST_CASE_FIXTURE(WalkingFixture, "the visibility mask is a mesh in two calls") {
    const auto getMask = function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
    const auto stereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    const auto hidden = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    CHECK(getMask(session, stereo, 0, hidden, &mask) == XR_SUCCESS);
    REQUIRE(mask.vertexCountOutput > 0);
    REQUIRE(mask.indexCountOutput % 3 == 0);
    std::vector<XrVector2f> vertices(mask.vertexCountOutput);
    std::vector<std::uint32_t> indices(mask.indexCountOutput);
    mask.vertices = vertices.data();
    mask.indices = indices.data();
    // Either capacity of 0 asks for both counts.
    const std::uint32_t vertex_count = mask.vertexCountOutput;
    mask.vertexCapacityInput = 1;
    mask.vertexCountOutput = mask.indexCountOutput = 0;
    CHECK(getMask(session, stereo, 0, hidden, &mask) == XR_SUCCESS);
    CHECK(mask.vertexCountOutput == vertex_count);
    CHECK(mask.indexCountOutput == indices.size());
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.indexCapacityInput = mask.indexCountOutput - 1;
    CHECK(getMask(session, stereo, 0, hidden, &mask) == XR_ERROR_SIZE_INSUFFICIENT);
    mask.indexCapacityInput = mask.indexCountOutput;
    CHECK(getMask(session, stereo, 0, hidden, &mask) == XR_SUCCESS);
    for (const std::uint32_t index : indices) CHECK(index < vertices.size());
    CHECK(getMask(session, stereo, 2, hidden, &mask) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(getMask(session, stereo, 0, static_cast<XrVisibilityMaskTypeKHR>(9), &mask) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(getMask(session, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO, 0, hidden, &mask) == XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
    CHECK(getMask(XR_NULL_HANDLE, stereo, 0, hidden, &mask) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(WalkingFixture, "the outline of what is visible goes once round the axis, counter-clockwise") {
    const auto getMask = function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
    for (const std::uint32_t view : {0u, 1u}) {
        XrVector2f vertices[256];
        std::uint32_t indices[256];
        XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR, nullptr, 256, 0, vertices, 256, 0, indices};
        REQUIRE(getMask(session, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, view, XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR, &mask) ==
                XR_SUCCESS);
        REQUIRE(mask.indexCountOutput >= 3);
        double turned = 0;
        for (std::uint32_t i = 0; i < mask.indexCountOutput; ++i) {
            const XrVector2f from = vertices[indices[i]], to = vertices[indices[(i + 1) % mask.indexCountOutput]];
            const double step = std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
            CHECK(step > 0);
            turned += step;
        }
        CHECK(turned == doctest::Approx(2 * M_PI));
    }
}

TEST_CASE_FIXTURE(SessionFixture, "a headset without mask gives an empty one") {
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    CHECK(function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR")(session, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, 1,
                                                                         XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR, &mask) == XR_SUCCESS);
    CHECK(mask.vertexCountOutput == 0);
}

TEST_CASE_FIXTURE(NarrowingFixture, "a mask that changes with the eye's angles is announced once, for that eye") {
    focus();
    for (int i = 3; i < 6; ++i) frame();
    XrEventDataBuffer event;
    CHECK(poll(event) == XR_TYPE_UNKNOWN);
    frame();
    REQUIRE(poll(event) == XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR);
    CHECK(reinterpret_cast<const XrEventDataVisibilityMaskChangedKHR&>(event).viewIndex == 1);
    frame();
    CHECK(poll(event) == XR_TYPE_UNKNOWN);
}

}  // namespace simulated_space_test
