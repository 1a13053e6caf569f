// The session state machine.
#include "xr/session.h"

#include "xr/platform.h"

#include <algorithm>

namespace binosplat::xr {
namespace {

constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
// For runtimes that state no period, or an absurd one.
constexpr double kUsualPeriodSeconds = 1.0 / 90.0;
constexpr double kLongestStepSeconds = 0.1;

}  // namespace

Session::Session(const Instance& instance, const Context& context) : instance_(instance), context_(context) {
    const std::lock_guard lock(context.queueMutex());
    auto binding = structure<XrGraphicsBindingVulkan2KHR>(XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR);
    binding.instance = *context.instance();
    binding.physicalDevice = *context.physicalDevice();
    binding.device = *context.device();
    binding.queueFamilyIndex = context.queueFamily();
    binding.queueIndex = 0;
    auto info = structure<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
    info.next = &binding;
    info.systemId = instance.system();
    BINOSPLAT_XR(xrCreateSession(instance.handle(), &info, &session_));
    try {
        auto space_info = structure<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
        space_info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
        space_info.poseInReferenceSpace.orientation.w = 1.0f;
        BINOSPLAT_XR(xrCreateReferenceSpace(session_, &space_info, &space_));
        for (int eye = 0; eye < 2; ++eye) { readHiddenMesh(eye); }
    } catch (...) {
        xrDestroySession(session_);  // and all that was made of it
        throw;
    }
}

Session::~Session() { xrDestroySession(session_); }

FrameOutcome Session::beginFrame() {
    try {
        pollEvents();
        if (ended_) { return FrameOutcome::kExit; }
        if (!running_) { return FrameOutcome::kWait; }
        const XrFrameWaitInfo wait_info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
        frame_state_ = structure<XrFrameState>(XR_TYPE_FRAME_STATE);
        BINOSPLAT_XR(xrWaitFrame(session_, &wait_info, &frame_state_));
        const XrFrameBeginInfo begin_info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
        const std::lock_guard lock(context_.queueMutex());
        BINOSPLAT_XR(xrBeginFrame(session_, &begin_info));
    } catch (const Lost& lost) {
        end(lost.what());
        return FrameOutcome::kExit;
    }
    const double since_last = static_cast<double>(frame_state_.predictedDisplayTime - last_display_time_) * 1e-9;
    const bool known = last_display_time_ != 0 && since_last > 0.0;
    step_seconds_ = std::min(known ? since_last : kUsualPeriodSeconds, kLongestStepSeconds);
    last_display_time_ = frame_state_.predictedDisplayTime;
    return frame_state_.shouldRender == XR_TRUE ? FrameOutcome::kRender : FrameOutcome::kSkip;
}

void Session::endFrame(std::span<const XrCompositionLayerBaseHeader* const> layers) {
    auto info = structure<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
    info.displayTime = frame_state_.predictedDisplayTime;
    info.environmentBlendMode = instance_.blendMode();
    info.layerCount = static_cast<std::uint32_t>(layers.size());
    info.layers = layers.empty() ? nullptr : layers.data();
    try {
        const std::lock_guard lock(context_.queueMutex());
        BINOSPLAT_XR(xrEndFrame(session_, &info));
    } catch (const Lost& lost) { end(lost.what()); }
}

void Session::requestExit() {
    const XrResult result = xrRequestExitSession(session_);
    // A session that does not run can just be left.
    if (XR_FAILED(result)) { end("the session was stopped before it ran"); }
}

void Session::pollEvents() {
    for (;;) {
        auto event = structure<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
        if (BINOSPLAT_XR(xrPollEvent(instance_.handle(), &event)) == XR_EVENT_UNAVAILABLE) { return; }
        switch (event.type) {
            case XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED: {
                const auto& change = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
                if (change.session == session_) { changeState(change.state); }
                break;
            }
            case XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING:
                end("the OpenXR runtime is going away");
                break;
            case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
                readHiddenMesh(static_cast<int>(reinterpret_cast<const XrEventDataVisibilityMaskChangedKHR&>(event).viewIndex));
                break;
            default:  // a re-centred space moves the scene with it; a changed controller shows in its actions
                break;
        }
    }
}

void Session::changeState(XrSessionState state) {
    state_ = state;
    switch (state) {
        case XR_SESSION_STATE_READY: {
            auto info = structure<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
            info.primaryViewConfigurationType = kStereo;
            BINOSPLAT_XR(xrBeginSession(session_, &info));
            running_ = true;
            last_display_time_ = 0;
            break;
        }
        case XR_SESSION_STATE_STOPPING:
            running_ = false;
            BINOSPLAT_XR(xrEndSession(session_));
            break;
        case XR_SESSION_STATE_EXITING:
            end("the runtime asked for the end");
            break;
        case XR_SESSION_STATE_LOSS_PENDING:
            end("the session is lost");
            break;
        default:
            break;
    }
}

void Session::end(const std::string& why) {
    if (!ended_) { why_ended_ = why; }
    ended_ = true;
    running_ = false;
}

std::optional<std::array<EyeView, 2>> Session::locateEyes() const {
    auto info = structure<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    info.viewConfigurationType = kStereo;
    info.displayTime = frame_state_.predictedDisplayTime;
    info.space = space_;
    auto state = structure<XrViewState>(XR_TYPE_VIEW_STATE);
    std::array<XrView, 2> views{XrView{XR_TYPE_VIEW, nullptr, {}, {}}, XrView{XR_TYPE_VIEW, nullptr, {}, {}}};
    std::uint32_t count = 0;
    try {
        BINOSPLAT_XR(xrLocateViews(session_, &info, &state, 2, &count, views.data()));
    } catch (const Lost&) { return std::nullopt; }
    if (count != 2 || (state.viewStateFlags & XR_VIEW_STATE_ORIENTATION_VALID_BIT) == 0) { return std::nullopt; }
    const bool placed = (state.viewStateFlags & XR_VIEW_STATE_POSITION_VALID_BIT) != 0;
    std::array<EyeView, 2> eyes;
    for (std::size_t e = 0; e < 2; ++e) {
        eyes[e] = {views[e].pose, views[e].fov};
        if (!placed) { eyes[e].pose.position = {e == kLeft ? -0.0315f : 0.0315f, 0.0f, 0.0f}; }
    }
    return eyes;
}

void Session::readHiddenMesh(int eye) {
    if (!instance_.hasVisibilityMask() || eye < 0 || eye > 1) { return; }
    HiddenMesh& mesh = hidden_meshes_[static_cast<std::size_t>(eye)];
    mesh = {};
    ++hidden_mesh_version_;
    // Some runtimes list the extension and have not its function.
    PFN_xrVoidFunction found = nullptr;
    if (XR_FAILED(xrGetInstanceProcAddr(instance_.handle(), "xrGetVisibilityMaskKHR", &found)) || found == nullptr) { return; }
    const auto get = reinterpret_cast<PFN_xrGetVisibilityMaskKHR>(found);
    const auto kind = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
    const auto view = static_cast<std::uint32_t>(eye);
    auto mask = structure<XrVisibilityMaskKHR>(XR_TYPE_VISIBILITY_MASK_KHR);
    if (XR_FAILED(get(session_, kStereo, view, kind, &mask)) || mask.indexCountOutput == 0) { return; }
    mesh.vertices.resize(mask.vertexCountOutput);
    mesh.indices.resize(mask.indexCountOutput);
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.vertices = mesh.vertices.data();
    mask.indices = mesh.indices.data();
    if (XR_FAILED(get(session_, kStereo, view, kind, &mask))) { mesh = {}; }
}

}  // namespace binosplat::xr
