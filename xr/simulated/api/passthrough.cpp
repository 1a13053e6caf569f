// The room fills the whole view. Projections onto meshes are not there.
#include "xr/simulated/api/passthrough.h"

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/api/surrounding_layers.h"

namespace simulated {
namespace {

struct Passthrough : SessionChild {
    using Handle = XrPassthroughFB;

    bool is_running;

    Passthrough(Session& owner, bool runs) : SessionChild(owner), is_running(runs) {}
};

struct PassthroughLayer : SessionChild {
    using Handle = XrPassthroughLayerFB;

    const Passthrough& of;
    bool is_running;
    double opacity = 1.0;

    PassthroughLayer(const Passthrough& passthrough, bool runs)
        : SessionChild(passthrough.session), of(passthrough), is_running(runs) {}
};

bool runsAtCreation(XrPassthroughFlagsFB flags) {
    require((flags & ~XR_PASSTHROUGH_IS_RUNNING_AT_CREATION_BIT_FB) == 0, XR_ERROR_VALIDATION_FAILURE,
            "unknown passthrough flags: ", flags);
    return flags != 0;
}

template <typename T>
XrResult setRunning(const char* function, typename T::Handle handle, bool runs) {
    return answer(function, [&] { get<T>(handle).is_running = runs; });
}

XrResult refuseMeshes(const char* function) {
    return answer(function,
                  [] { refuse(XR_ERROR_FEATURE_UNSUPPORTED, "the room is not projected onto meshes"); });
}

}  // namespace

XrResult xrCreatePassthroughFB(XrSession session, const XrPassthroughCreateInfoFB* createInfo,
                               XrPassthroughFB* outPassthrough) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const auto& info = checkStruct(createInfo, XR_TYPE_PASSTHROUGH_CREATE_INFO_FB);
        XrPassthroughFB& output = checkOutput(outPassthrough);
        require(owner.instance.simulation->script.passthrough, XR_ERROR_FEATURE_UNSUPPORTED,
                "the script offers no passthrough");
        for (const auto& child : owner.children) {
            require(dynamic_cast<const Passthrough*>(child.get()) == nullptr,
                    XR_ERROR_FEATURE_ALREADY_CREATED_PASSTHROUGH_FB, "the session has a passthrough already");
        }
        output = handleOf(adopt(owner, std::make_unique<Passthrough>(owner, runsAtCreation(info.flags))));
    });
}

XrResult xrDestroyPassthroughFB(XrPassthroughFB passthrough) {
    return answer(__func__, [&] { destroyObject(get<Passthrough>(passthrough)); });
}
XrResult xrPassthroughStartFB(XrPassthroughFB passthrough) {
    return setRunning<Passthrough>(__func__, passthrough, true);
}
XrResult xrPassthroughPauseFB(XrPassthroughFB passthrough) {
    return setRunning<Passthrough>(__func__, passthrough, false);
}

XrResult xrCreatePassthroughLayerFB(XrSession session, const XrPassthroughLayerCreateInfoFB* createInfo,
                                    XrPassthroughLayerFB* outLayer) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const auto& info = checkStruct(createInfo, XR_TYPE_PASSTHROUGH_LAYER_CREATE_INFO_FB);
        XrPassthroughLayerFB& output = checkOutput(outLayer);
        Passthrough& passthrough = get<Passthrough>(info.passthrough);
        require(&passthrough.session == &owner, XR_ERROR_HANDLE_INVALID,
                "the passthrough is another session's");
        require(info.purpose == XR_PASSTHROUGH_LAYER_PURPOSE_RECONSTRUCTION_FB, XR_ERROR_FEATURE_UNSUPPORTED,
                "the purpose is ", info.purpose, ", there is only the room as it is");
        output = handleOf(
            adopt(passthrough, std::make_unique<PassthroughLayer>(passthrough, runsAtCreation(info.flags))));
    });
}

XrResult xrDestroyPassthroughLayerFB(XrPassthroughLayerFB layer) {
    return answer(__func__, [&] { destroyObject(get<PassthroughLayer>(layer)); });
}
XrResult xrPassthroughLayerPauseFB(XrPassthroughLayerFB layer) {
    return setRunning<PassthroughLayer>(__func__, layer, false);
}
XrResult xrPassthroughLayerResumeFB(XrPassthroughLayerFB layer) {
    return setRunning<PassthroughLayer>(__func__, layer, true);
}

XrResult xrPassthroughLayerSetStyleFB(XrPassthroughLayerFB layer, const XrPassthroughStyleFB* style) {
    return answer(__func__, [&] {
        const float opacity = checkStruct(style, XR_TYPE_PASSTHROUGH_STYLE_FB).textureOpacityFactor;
        require(opacity >= 0 && opacity <= 1, XR_ERROR_VALIDATION_FAILURE, "the opacity is ", opacity,
                ", must be within 0 to 1");
        get<PassthroughLayer>(layer).opacity = opacity;
    });
}

XrResult xrCreateGeometryInstanceFB(XrSession, const XrGeometryInstanceCreateInfoFB*, XrGeometryInstanceFB*) {
    return refuseMeshes(__func__);
}
XrResult xrDestroyGeometryInstanceFB(XrGeometryInstanceFB) { return refuseMeshes(__func__); }
XrResult xrGeometryInstanceSetTransformFB(XrGeometryInstanceFB, const XrGeometryInstanceTransformFB*) {
    return refuseMeshes(__func__);
}

void checkPassthrough(const Session& session, const XrCompositionLayerBaseHeader& layer) {
    const auto& shown = as<XrCompositionLayerPassthroughFB>(layer);
    require(&get<PassthroughLayer>(shown.layerHandle).session == &session, XR_ERROR_HANDLE_INVALID,
            "the layer is another session's");
}

std::optional<RoomLayer> makePassthroughLayer(const Session& session,
                                              const XrCompositionLayerBaseHeader& layer) {
    const PassthroughLayer& shown =
        get<PassthroughLayer>(as<XrCompositionLayerPassthroughFB>(layer).layerHandle);
    if (!shown.is_running || !shown.of.is_running) { return std::nullopt; }
    const glm::dvec3& room = session.instance.simulation->script.room_colour;
    return RoomLayer{{decodeSrgb(room.r), decodeSrgb(room.g), decodeSrgb(room.b)},
                     shown.opacity,
                     blendingOf(layer.layerFlags)};
}

}  // namespace simulated
