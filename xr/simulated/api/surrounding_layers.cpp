// Cylinders, spheres and cubes: checked, composed and logged.
#include "xr/simulated/api/surrounding_layers.h"

#include <cmath>
#include <numbers>

#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr float kSlack = 1e-4f;  // 2 pi rounded to float is more than 2 pi
constexpr float kPi = std::numbers::pi_v<float>;

// May be infinite, which means the same as 0.
bool isRadius(float radius) { return radius >= 0; }
bool isAngle(float angle, float least, float most) {
    return angle >= least - kSlack && angle <= most + kSlack;
}

void checkCylinder(const Session& session, const XrCompositionLayerCylinderKHR& layer) {
    checkEyeVisibility(layer.eyeVisibility);
    checkPose(layer.pose);
    require(isRadius(layer.radius), XR_ERROR_VALIDATION_FAILURE, "the radius is ", layer.radius,
            ", must not be negative");
    require(isAngle(layer.centralAngle, 0, 2 * kPi), XR_ERROR_VALIDATION_FAILURE, "the central angle is ",
            layer.centralAngle, ", must be 0 to 2 pi");
    require(layer.aspectRatio > 0 && std::isfinite(layer.aspectRatio), XR_ERROR_VALIDATION_FAILURE,
            "the aspect ratio is ", layer.aspectRatio, ", must be positive");
    checkPicture(session, layer.subImage);
}

void checkSphere(const Session& session, const XrCompositionLayerEquirect2KHR& layer) {
    checkEyeVisibility(layer.eyeVisibility);
    checkPose(layer.pose);
    require(isRadius(layer.radius), XR_ERROR_VALIDATION_FAILURE, "the radius is ", layer.radius,
            ", must not be negative");
    require(isAngle(layer.centralHorizontalAngle, 0, 2 * kPi), XR_ERROR_VALIDATION_FAILURE,
            "the horizontal angle is ", layer.centralHorizontalAngle, ", must be 0 to 2 pi");
    const bool are_latitudes = isAngle(layer.upperVerticalAngle, -kPi / 2, kPi / 2) &&
                               isAngle(layer.lowerVerticalAngle, -kPi / 2, kPi / 2);
    require(are_latitudes, XR_ERROR_VALIDATION_FAILURE, "the vertical angles are ", layer.upperVerticalAngle,
            " and ", layer.lowerVerticalAngle, ", must be -pi/2 to pi/2");
    checkPicture(session, layer.subImage);
}

XrPosef poseOf(const XrCompositionLayerCubeKHR& layer) { return {layer.orientation, {0, 0, 0}}; }

void checkCube(const Session& session, const XrCompositionLayerCubeKHR& layer) {
    checkEyeVisibility(layer.eyeVisibility);
    checkPose(poseOf(layer));
    const Swapchain& swapchain = getSwapchain(session, layer.swapchain);
    require(swapchain.has_released, XR_ERROR_LAYER_INVALID, "no image of the swapchain was released");
    require(swapchain.info.faces == 6, XR_ERROR_LAYER_INVALID, "a picture shown as a cube map");
    require(layer.imageArrayIndex < swapchain.info.layers / 6, XR_ERROR_VALIDATION_FAILURE,
            "imageArrayIndex is ", layer.imageArrayIndex, ", the swapchain has ", swapchain.info.layers / 6,
            " cube maps");
}

CubeLayer makeCubeLayer(const Session& session, const XrCompositionLayerCubeKHR& layer,
                        const Pose& stage_from_space) {
    Swapchain& swapchain = getSwapchain(session, layer.swapchain);
    CubeLayer cube;
    for (std::uint32_t face = 0; face < 6; ++face) {
        cube.faces[face] = pictureOf(swapchain, 6 * layer.imageArrayIndex + face);
    }
    cube.stage_from_cube = compose(stage_from_space, fromXr(poseOf(layer))).orientation;
    cube.visibility = visibilityOf(layer.eyeVisibility);
    cube.blending = blendingOf(layer.layerFlags);
    return cube;
}

}  // namespace

bool isSurrounding(const Session& session, XrStructureType type) {
    const auto& extensions = session.instance.extensions;
    switch (type) {
        case XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR:
            return extensions.contains(XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME);
        case XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR:
            return extensions.contains(XR_KHR_COMPOSITION_LAYER_EQUIRECT2_EXTENSION_NAME);
        case XR_TYPE_COMPOSITION_LAYER_CUBE_KHR:
            return extensions.contains(XR_KHR_COMPOSITION_LAYER_CUBE_EXTENSION_NAME);
        default:
            return false;
    }
}

void checkSurrounding(const Session& session, const XrCompositionLayerBaseHeader& layer) {
    if (layer.type == XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR) {
        checkCylinder(session, as<XrCompositionLayerCylinderKHR>(layer));
    } else if (layer.type == XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR) {
        checkSphere(session, as<XrCompositionLayerEquirect2KHR>(layer));
    } else {
        checkCube(session, as<XrCompositionLayerCubeKHR>(layer));
    }
}

Layer makeSurroundingLayer(const Session& session, const XrCompositionLayerBaseHeader& layer,
                           const Pose& stage_from_space) {
    if (layer.type == XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR) {
        const auto& cylinder = as<XrCompositionLayerCylinderKHR>(layer);
        return CylinderLayer{
            pictureOf(getSwapchain(session, cylinder.subImage.swapchain), cylinder.subImage.imageArrayIndex),
            rectOf(cylinder.subImage.imageRect),
            compose(stage_from_space, fromXr(cylinder.pose)),
            cylinder.radius,
            cylinder.centralAngle,
            cylinder.aspectRatio,
            visibilityOf(cylinder.eyeVisibility),
            blendingOf(cylinder.layerFlags)};
    }
    if (layer.type == XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR) {
        const auto& sphere = as<XrCompositionLayerEquirect2KHR>(layer);
        return SphereLayer{
            pictureOf(getSwapchain(session, sphere.subImage.swapchain), sphere.subImage.imageArrayIndex),
            rectOf(sphere.subImage.imageRect),
            compose(stage_from_space, fromXr(sphere.pose)),
            sphere.radius,
            sphere.centralHorizontalAngle,
            sphere.upperVerticalAngle,
            sphere.lowerVerticalAngle,
            visibilityOf(sphere.eyeVisibility),
            blendingOf(sphere.layerFlags)};
    }
    return makeCubeLayer(session, as<XrCompositionLayerCubeKHR>(layer), stage_from_space);
}

void logSurrounding(const Session& session, const XrCompositionLayerBaseHeader& layer, LoggedLayer& entry) {
    if (layer.type == XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR) {
        const auto& cylinder = as<XrCompositionLayerCylinderKHR>(layer);
        entry.type = "cylinder";
        entry.views = {loggedImage(session, cylinder.subImage)};
        entry.pose = fromXr(cylinder.pose);
        entry.eye_visibility = nameOf(cylinder.eyeVisibility);
        entry.numbers = {{"radius", cylinder.radius},
                         {"central_angle", cylinder.centralAngle},
                         {"aspect_ratio", cylinder.aspectRatio}};
    } else if (layer.type == XR_TYPE_COMPOSITION_LAYER_EQUIRECT2_KHR) {
        const auto& sphere = as<XrCompositionLayerEquirect2KHR>(layer);
        entry.type = "equirect2";
        entry.views = {loggedImage(session, sphere.subImage)};
        entry.pose = fromXr(sphere.pose);
        entry.eye_visibility = nameOf(sphere.eyeVisibility);
        entry.numbers = {{"radius", sphere.radius},
                         {"horizontal_angle", sphere.centralHorizontalAngle},
                         {"upper_angle", sphere.upperVerticalAngle},
                         {"lower_angle", sphere.lowerVerticalAngle}};
    } else {
        const auto& cube = as<XrCompositionLayerCubeKHR>(layer);
        const VkExtent2D& size = getSwapchain(session, cube.swapchain).info.size;
        const XrExtent2Di whole{static_cast<std::int32_t>(size.width),
                                static_cast<std::int32_t>(size.height)};
        entry.type = "cube";
        entry.views = {loggedImage(session, {cube.swapchain, {{0, 0}, whole}, cube.imageArrayIndex})};
        entry.pose = fromXr(poseOf(cube));
        entry.eye_visibility = nameOf(cube.eyeVisibility);
    }
}

}  // namespace simulated
