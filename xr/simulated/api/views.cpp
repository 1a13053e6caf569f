// The views, their recommended sizes, and where they are: section 10.3's xrLocateViews.
#include "xr/simulated/api/views.h"

#include <algorithm>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/poses.h"
#include "xr/simulated/api/spaces.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr auto kInset = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET;
// Three images of this size fit on small devices; a script may recommend larger ones.
constexpr std::uint32_t kMostViewPixels = 4096;
constexpr XrViewStateFlags kTurnsKnown =
                               XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_TRACKED_BIT,
                           kPlacesKnown =
                               XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_POSITION_TRACKED_BIT;

// True if the program may name the inset; the script can remove it from the headset even if 1.1 has its name
// in the core.
bool knowsInset(const Instance& instance) { return instance.has1_1Or(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME); }
bool hasInset(const Instance& instance) {
    return knowsInset(instance) &&
           instance.simulation->script.allowsExtension(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
}

// True if the program asks for insets that follow the gaze, with this structure of the extension's.
template <class Asked>
bool movesInsets(const Instance& instance, const void* next, XrStructureType type) {
    const auto* const asked = findInChain<Asked>(next, type);
    return asked != nullptr && instance.extensions.contains(XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME) &&
           asked->foveatedRenderingActive == XR_TRUE;
}

glm::uvec2 sizePxOf(const Script& script, XrViewConfigurationType type, std::size_t view, bool moves) {
    if (type != kInset) { return script.size_px; }
    if (!isInset(view)) { return script.contextSizePx(); }
    return moves ? script.inset.moving_px.value_or(script.insetSizePx()) : script.insetSizePx();
}

}  // namespace

void checkViewConfiguration(const Instance& instance, XrViewConfigurationType type) {
    // Values of extensions that are not enabled are not view configurations at all.
    const bool is_known = type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO ||
                          type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO ||
                          (type == kInset && knowsInset(instance));
    require(is_known, XR_ERROR_VALIDATION_FAILURE, type, " is not a view configuration");
    const bool is_there =
        type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO || (type == kInset && hasInset(instance));
    require(is_there, XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED, "the view configuration is ", type,
            hasInset(instance) ? ", there are primary stereo and that with a foveated inset"
                               : ", there is only primary stereo");
}

XrResult xrEnumerateViewConfigurations(XrInstance instance, XrSystemId systemId,
                                       uint32_t viewConfigurationTypeCapacityInput,
                                       uint32_t* viewConfigurationTypeCountOutput,
                                       XrViewConfigurationType* viewConfigurationTypes) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        checkSystem(systemId);
        std::vector<XrViewConfigurationType> types{XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
        if (hasInset(owner)) { types.push_back(kInset); }
        fillArray(viewConfigurationTypeCapacityInput, viewConfigurationTypeCountOutput,
                  viewConfigurationTypes, types);
    });
}

XrResult xrGetViewConfigurationProperties(XrInstance instance, XrSystemId systemId,
                                          XrViewConfigurationType viewConfigurationType,
                                          XrViewConfigurationProperties* configurationProperties) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        checkSystem(systemId);
        checkViewConfiguration(owner, viewConfigurationType);
        XrViewConfigurationProperties& output =
            checkStruct(configurationProperties, XR_TYPE_VIEW_CONFIGURATION_PROPERTIES);
        output.viewConfigurationType = viewConfigurationType;
        // Scripts change the angles during a run.
        output.fovMutable = XR_TRUE;
    });
}

XrResult xrEnumerateViewConfigurationViews(XrInstance instance, XrSystemId systemId,
                                           XrViewConfigurationType viewConfigurationType,
                                           uint32_t viewCapacityInput, uint32_t* viewCountOutput,
                                           XrViewConfigurationView* views) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        checkSystem(systemId);
        checkViewConfiguration(owner, viewConfigurationType);
        const std::size_t count = countViews(viewConfigurationType);
        if (!wantsArray(viewCapacityInput, viewCountOutput, views, count)) { return; }
        for (std::size_t i = 0; i < count; ++i) { checkType(views[i], XR_TYPE_VIEW_CONFIGURATION_VIEW); }
        for (std::size_t i = 0; i < count; ++i) {
            const bool moves = movesInsets<XrFoveatedViewConfigurationViewVARJO>(
                owner, views[i].next, XR_TYPE_FOVEATED_VIEW_CONFIGURATION_VIEW_VARJO);
            const glm::uvec2 size_px = sizePxOf(owner.simulation->script, viewConfigurationType, i, moves);
            views[i].recommendedImageRectWidth = size_px.x;
            views[i].recommendedImageRectHeight = size_px.y;
            views[i].maxImageRectWidth = std::max(kMostViewPixels, size_px.x);
            views[i].maxImageRectHeight = std::max(kMostViewPixels, size_px.y);
            views[i].recommendedSwapchainSampleCount = 1;
            views[i].maxSwapchainSampleCount = 1;
        }
    });
}

XrResult xrLocateViews(XrSession session, const XrViewLocateInfo* viewLocateInfo, XrViewState* viewState,
                       uint32_t viewCapacityInput, uint32_t* viewCountOutput, XrView* views) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrViewLocateInfo& info = checkStruct(viewLocateInfo, XR_TYPE_VIEW_LOCATE_INFO);
        XrViewState& output = checkStruct(viewState, XR_TYPE_VIEW_STATE);
        checkViewConfiguration(owner.instance, info.viewConfigurationType);
        const Space& space = getSpace(owner, info.space);
        checkTime(info.displayTime);
        output.viewStateFlags = 0;
        const std::size_t count = countViews(info.viewConfigurationType);
        if (!wantsArray(viewCapacityInput, viewCountOutput, views, count)) { return; }
        for (std::size_t i = 0; i < count; ++i) { checkType(views[i], XR_TYPE_VIEW); }
        owner.moves_insets = movesInsets<XrViewLocateFoveatedRenderingVARJO>(
            owner.instance, info.next, XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO);
        const State state = owner.at(info.displayTime);
        const std::optional<Pose> stage_from_space = stageFromSpace(space, state);
        for (std::size_t i = 0; i < count; ++i) {
            const EyeState& seen = state.eyes[sideOf(i)];
            Pose pose = stage_from_space ? compose(inverse(*stage_from_space), seen.stage_from_eye) : Pose{};
            // Unknown values are not reported.
            if (space.reference != XR_REFERENCE_SPACE_TYPE_VIEW) {
                if (!state.head_place_known) { pose.position = glm::dvec3(0.0); }
                if (!state.head_turn_known) { pose.orientation = glm::dquat(1.0, 0.0, 0.0, 0.0); }
            }
            views[i].pose = toXr(pose);
            const Script& script = owner.instance.simulation->script;
            views[i].fov =
                toXr(isInset(i) ? script.findInset(state, sideOf(i), owner.moves_insets) : seen.fov);
        }
        const bool is_in_head = space.reference == XR_REFERENCE_SPACE_TYPE_VIEW;
        if (stage_from_space && (state.head_turn_known || is_in_head)) {
            output.viewStateFlags = kTurnsKnown;
        }
        if (stage_from_space && (state.head_place_known || is_in_head)) {
            output.viewStateFlags |= kPlacesKnown;
        }
    });
}

}  // namespace simulated
