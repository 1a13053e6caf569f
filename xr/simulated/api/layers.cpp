// Checks, composes and logs projections and quads. Layers that surround the wearer are in
// surrounding_layers.cpp.
#include "xr/simulated/api/layers.h"

#include <array>
#include <cmath>
#include <numbers>

#include "xr/simulated/api/passthrough.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/spaces.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/surrounding_layers.h"
#include "xr/simulated/api/swapchains.h"
#include "xr/simulated/api/views.h"

namespace simulated {
namespace {

constexpr XrCompositionLayerFlags kKnownLayerFlags = XR_COMPOSITION_LAYER_CORRECT_CHROMATIC_ABERRATION_BIT |
                                                     XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT |
                                                     XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;

constexpr std::array<const char*, kMostViews> kViewNames{"left", "right", "left_inset", "right_inset"};

Swapchain& checkSubImage(const Session& session, const XrSwapchainSubImage& image) {
    Swapchain& swapchain = getSwapchain(session, image.swapchain);
    require(swapchain.has_released, XR_ERROR_LAYER_INVALID, "no image of the swapchain was released");
    const auto& [offset, extent] = image.imageRect;
    const std::int64_t right = std::int64_t{offset.x} + extent.width,
                       bottom = std::int64_t{offset.y} + extent.height;
    const bool is_inside = offset.x >= 0 && offset.y >= 0 && extent.width >= 0 && extent.height >= 0 &&
                           right <= swapchain.info.size.width && bottom <= swapchain.info.size.height;
    require(is_inside, XR_ERROR_SWAPCHAIN_RECT_INVALID, "the rectangle ", offset.x, " ", offset.y, " ",
            extent.width, " ", extent.height, " is not within its image of ", swapchain.info.size.width, "x",
            swapchain.info.size.height);
    require(image.imageArrayIndex < swapchain.info.layers, XR_ERROR_VALIDATION_FAILURE, "imageArrayIndex is ",
            image.imageArrayIndex, ", the swapchain has ", swapchain.info.layers, " layers");
    return swapchain;
}

void checkColour(const Swapchain& swapchain) {
    require(swapchain.info.format.aspects == VK_IMAGE_ASPECT_COLOR_BIT, XR_ERROR_LAYER_INVALID,
            swapchain.info.format.name, " is shown as a picture");
    require(swapchain.info.faces == 1, XR_ERROR_LAYER_INVALID, "a cube map shown as a picture");
}

const XrCompositionLayerDepthInfoKHR* depthOf(const Session& session,
                                              const XrCompositionLayerProjectionView& view) {
    if (!session.instance.extensions.contains(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME)) {
        return nullptr;
    }
    return findInChain<const XrCompositionLayerDepthInfoKHR>(view.next,
                                                             XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR);
}

void checkDepth(const Session& session, const XrCompositionLayerDepthInfoKHR& depth) {
    const Swapchain& swapchain = checkSubImage(session, depth.subImage);
    const bool takes_depth = session.instance.simulation->script.depth != Script::Depth::kNoLayers;
    require(takes_depth, XR_ERROR_LAYER_INVALID, "the script takes no depth");
    require((swapchain.info.format.aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0, XR_ERROR_LAYER_INVALID,
            swapchain.info.format.name, " is given as depth");
    const bool is_range = depth.minDepth >= 0 && depth.maxDepth <= 1 && depth.minDepth <= depth.maxDepth;
    require(is_range, XR_ERROR_VALIDATION_FAILURE, "minDepth is ", depth.minDepth, " and maxDepth ",
            depth.maxDepth, ", must be in order within 0 to 1");
    const bool are_distances = depth.nearZ >= 0 && depth.farZ >= 0 && depth.nearZ != depth.farZ;
    require(are_distances, XR_ERROR_VALIDATION_FAILURE, "nearZ is ", depth.nearZ, " and farZ ", depth.farZ,
            ", must differ and not be negative");
}

void checkView(const Session& session, const XrCompositionLayerProjectionView& view) {
    checkType(view, XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
    checkPose(view.pose);
    for (const float angle :
         {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown}) {
        require(std::abs(angle) < static_cast<float>(std::numbers::pi / 2), XR_ERROR_VALIDATION_FAILURE,
                "a view angle is ", angle, ", must be within a quarter turn");
    }
    checkColour(checkSubImage(session, view.subImage));
    if (const XrCompositionLayerDepthInfoKHR* depth = depthOf(session, view)) { checkDepth(session, *depth); }
}

void checkProjection(const Session& session, const XrCompositionLayerProjection& layer) {
    const std::size_t count = countViews(session.view_configuration);
    require(layer.viewCount == count && layer.views != nullptr, XR_ERROR_VALIDATION_FAILURE, layer.viewCount,
            " views, must be ", count == kEyes ? "one for each eye" : "four: the eyes' and their insets'");
    for (std::size_t i = 0; i < count; ++i) { checkView(session, layer.views[i]); }
}

void checkQuad(const Session& session, const XrCompositionLayerQuad& layer) {
    checkEyeVisibility(layer.eyeVisibility);
    checkPose(layer.pose);
    // A quad may be a line or a point, which is not visible.
    require(layer.size.width >= 0 && layer.size.height >= 0, XR_ERROR_VALIDATION_FAILURE,
            "the quad's size is ", layer.size.width, " ", layer.size.height, ", must not be negative");
    checkColour(checkSubImage(session, layer.subImage));
}

ProjectionView makeView(const Session& session, const XrCompositionLayerProjectionView& view,
                        const Pose& stage_from_space) {
    return {pictureOf(getSwapchain(session, view.subImage.swapchain), view.subImage.imageArrayIndex),
            rectOf(view.subImage.imageRect), compose(stage_from_space, fromXr(view.pose)), fromXr(view.fov)};
}

LoggedView loggedView(const Session& session, const XrCompositionLayerProjectionView& view) {
    LoggedView logged = loggedImage(session, view.subImage);
    logged.pose = fromXr(view.pose);
    logged.fov = fromXr(view.fov);
    if (const XrCompositionLayerDepthInfoKHR* depth = depthOf(session, view)) {
        const char* const format = getSwapchain(session, depth->subImage.swapchain).info.format.name;
        logged.depth = LoggedDepth{format, depth->minDepth, depth->maxDepth, depth->nearZ, depth->farZ};
    }
    return logged;
}

std::vector<std::string> loggedFlags(XrCompositionLayerFlags flags) {
    std::vector<std::string> names;
    if ((flags & XR_COMPOSITION_LAYER_CORRECT_CHROMATIC_ABERRATION_BIT) != 0) {
        names.emplace_back("correct_chromatic_aberration");
    }
    if ((flags & XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT) != 0) {
        names.emplace_back("blend_texture_source_alpha");
    }
    if ((flags & XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT) != 0) {
        names.emplace_back("unpremultiplied_alpha");
    }
    return names;
}

}  // namespace

void checkEyeVisibility(XrEyeVisibility visibility) {
    require(visibility >= XR_EYE_VISIBILITY_BOTH && visibility <= XR_EYE_VISIBILITY_RIGHT,
            XR_ERROR_VALIDATION_FAILURE, visibility, " is not an eye visibility");
}

Visibility visibilityOf(XrEyeVisibility visibility) {
    return visibility == XR_EYE_VISIBILITY_BOTH   ? Visibility::kBoth
           : visibility == XR_EYE_VISIBILITY_LEFT ? Visibility::kLeft
                                                  : Visibility::kRight;
}

const char* nameOf(XrEyeVisibility visibility) {
    constexpr const char* kNames[] = {"both", "left", "right"};
    return kNames[visibility];
}

void checkPicture(const Session& session, const XrSwapchainSubImage& image) {
    checkColour(checkSubImage(session, image));
}

Picture pictureOf(Swapchain& swapchain, std::uint32_t array_layer) {
    fetchTexels(swapchain);
    const VkFormat format = swapchain.info.format.format;
    Picture picture;
    picture.size_px = {swapchain.info.size.width, swapchain.info.size.height};
    const bool is_bgra = format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_B8G8R8A8_UNORM;
    picture.texels = format == VK_FORMAT_R16G16B16A16_SFLOAT ? Texels::kRgba16f
                     : is_bgra                               ? Texels::kBgra8
                                                             : Texels::kRgba8;
    const bool is_srgb = format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB;
    picture.transfer = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
    const std::size_t layer_bytes = swapchain.released_texels.size() / swapchain.info.layers;
    picture.bytes =
        std::span<const std::byte>(swapchain.released_texels).subspan(array_layer * layer_bytes, layer_bytes);
    return picture;
}

Rect rectOf(const XrRect2Di& rect) {
    return {{rect.offset.x, rect.offset.y}, {rect.extent.width, rect.extent.height}};
}

Blending blendingOf(XrCompositionLayerFlags flags) {
    return {(flags & XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT) != 0,
            (flags & XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT) != 0};
}

LoggedView loggedImage(const Session& session, const XrSwapchainSubImage& image) {
    const Swapchain& swapchain = getSwapchain(session, image.swapchain);
    const auto& [offset, extent] = image.imageRect;
    LoggedView logged;
    logged.swapchain = swapchain.number;
    logged.image_index = swapchain.released_index;
    logged.array_index = image.imageArrayIndex;
    logged.format = swapchain.info.format.name;
    logged.x = offset.x;
    logged.y = offset.y;
    logged.width = extent.width;
    logged.height = extent.height;
    return logged;
}

namespace {

void checkLayer(const Session& session, const XrCompositionLayerBaseHeader* submitted) {
    require(submitted != nullptr, XR_ERROR_LAYER_INVALID, "it is null");
    const XrCompositionLayerBaseHeader& layer = *submitted;
    const bool is_surrounding = isSurrounding(session, layer.type),
               is_room = isPassthrough(session, layer.type);
    const bool is_known = layer.type == XR_TYPE_COMPOSITION_LAYER_PROJECTION ||
                          layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD || is_surrounding || is_room;
    require(is_known, XR_ERROR_LAYER_INVALID, layer.type,
            " is neither a projection nor a quad, nor a layer of an extension that is enabled");
    checkChain(layer.next);
    require((layer.layerFlags & ~kKnownLayerFlags) == 0, XR_ERROR_VALIDATION_FAILURE,
            "unknown layer flags: ", layer.layerFlags);
    if (is_room) { return checkPassthrough(session, layer); }  // which is in no space
    getSpace(session, layer.space);
    if (is_surrounding) {
        checkSurrounding(session, layer);
    } else if (layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
        checkQuad(session, as<XrCompositionLayerQuad>(layer));
    } else {
        checkProjection(session, as<XrCompositionLayerProjection>(layer));
    }
}

}  // namespace

void checkLayers(const Session& session, const XrFrameEndInfo& info) {
    require(info.layerCount <= kMostLayers, XR_ERROR_LAYER_LIMIT_EXCEEDED, info.layerCount,
            " layers, at most ", kMostLayers, " are shown");
    checkArray(info.layers, info.layerCount, "layers");
    require(info.layerCount == 0 || !session.isHeadless(), XR_ERROR_LAYER_INVALID,
            "a headless session shows no layers");
    for (std::uint32_t i = 0; i < info.layerCount; ++i) {
        try {
            checkLayer(session, info.layers[i]);
        } catch (const Refusal& refusal) { refuse(refusal.result, "layer ", i, ": ", refusal.reason); }
    }
}

std::vector<Layer> makeLayers(const Session& session, const XrFrameEndInfo& info, const State& state) {
    std::vector<Layer> layers;
    for (std::uint32_t i = 0; i < info.layerCount; ++i) {
        const XrCompositionLayerBaseHeader& layer = *info.layers[i];
        if (isPassthrough(session, layer.type)) {
            if (const auto room = makePassthroughLayer(session, layer)) { layers.emplace_back(*room); }
            continue;
        }
        const std::optional<Pose> stage_from_space = stageFromSpace(getSpace(session, layer.space), state);
        if (!stage_from_space) { continue; }
        const Blending blending = blendingOf(layer.layerFlags);
        if (isSurrounding(session, layer.type)) {
            layers.push_back(makeSurroundingLayer(session, layer, *stage_from_space));
        } else if (layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
            const auto& quad = as<XrCompositionLayerQuad>(layer);
            layers.emplace_back(QuadLayer{
                pictureOf(getSwapchain(session, quad.subImage.swapchain), quad.subImage.imageArrayIndex),
                rectOf(quad.subImage.imageRect),
                compose(*stage_from_space, fromXr(quad.pose)),
                {quad.size.width, quad.size.height},
                visibilityOf(quad.eyeVisibility),
                blending});
        } else {
            const auto& projection = as<XrCompositionLayerProjection>(layer);
            ProjectionLayer composed{{}, blending};
            for (std::size_t v = 0; v < projection.viewCount; ++v) {
                const ProjectionView view = makeView(session, projection.views[v], *stage_from_space);
                if (isInset(v)) {
                    composed.insets[sideOf(v)] = view;
                } else {
                    composed.views[sideOf(v)] = view;
                }
            }
            layers.emplace_back(composed);
        }
    }
    return layers;
}

std::vector<LoggedLayer> loggedLayers(const Session& session, const XrFrameEndInfo& info,
                                      const State& state) {
    std::vector<LoggedLayer> logged;
    for (std::uint32_t i = 0; i < info.layerCount; ++i) {
        const XrCompositionLayerBaseHeader& layer = *info.layers[i];
        LoggedLayer& entry = logged.emplace_back();
        entry.flags = loggedFlags(layer.layerFlags);
        if (isPassthrough(session, layer.type)) {
            entry.type = "passthrough";
            continue;
        }
        const Space& space = getSpace(session, layer.space);
        entry.space = nameOf(space);
        entry.stage_from_space = stageFromSpace(space, state).value_or(Pose{});
        if (isSurrounding(session, layer.type)) {
            logSurrounding(session, layer, entry);
        } else if (layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
            const auto& quad = as<XrCompositionLayerQuad>(layer);
            entry.type = "quad";
            entry.views = {loggedImage(session, quad.subImage)};
            entry.pose = fromXr(quad.pose);
            entry.size_m = {quad.size.width, quad.size.height};
            entry.eye_visibility = nameOf(quad.eyeVisibility);
        } else {
            const auto& projection = as<XrCompositionLayerProjection>(layer);
            entry.type = "projection";
            for (std::size_t v = 0; v < projection.viewCount; ++v) {
                entry.views.push_back(loggedView(session, projection.views[v]));
                if (projection.viewCount == kMostViews) { entry.views.back().name = kViewNames[v]; }
            }
        }
    }
    return logged;
}

}  // namespace simulated
