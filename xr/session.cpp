// The session state machine.
#include "xr/session.h"

#include "engine/platform.h"
#include "xr/convert.h"
#include "xr/platform.h"

#include <algorithm>
#include <cmath>

namespace binosplat::xr {
namespace {

constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
// For runtimes that state no period, or an absurd one.
constexpr double kUsualPeriodSeconds = 1.0 / 90.0;
constexpr double kLongestStepSeconds = 0.1;
constexpr double kShortestPeriodMs = 1.0, kLongestPeriodMs = 100.0;
constexpr float kHalfIpdMetres = 0.0315f;  // while the headset does not say where its eyes are
constexpr XrPosef kHere{{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};
// XR_REFERENCE_SPACE_TYPE_LOCAL_FLOOR, which older headers lack.
constexpr auto kLocalFloor = static_cast<XrReferenceSpaceType>(1000426000);

// The head without its tilt, in our axes; one that looks straight up or down keeps the heading of its right-hand side.
Pose upright(const Pose& head) {
    const glm::dvec3 forward = head.orientation * glm::dvec3(0.0, 0.0, 1.0), right = head.orientation * glm::dvec3(1.0, 0.0, 0.0);
    const bool is_level = std::hypot(forward.x, forward.z) > 0.1;
    const double heading = is_level ? std::atan2(forward.x, forward.z) : std::atan2(-right.z, right.x);
    return {glm::angleAxis(heading, glm::dvec3(0.0, 1.0, 0.0)), head.position};
}

// The middle between the eyes.
Pose headOf(const std::array<EyeView, 2>& eyes) {
    const Pose left = fromXr(eyes[kLeft].pose), right = fromXr(eyes[kRight].pose);
    return {glm::slerp(left.orientation, right.orientation, 0.5), 0.5 * (left.position + right.position)};
}

}  // namespace

Session::Session(const Instance& instance, const Context& context)
    : instance_(instance), context_(context), blend_mode_(instance.blendMode(false)) {
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
        local_ = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL, kHere);
        space_ = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL, kHere);
        head_ = makeSpace(XR_REFERENCE_SPACE_TYPE_VIEW, kHere);
        findFloor();
        for (int eye = 0; eye < 2; ++eye) { readHiddenMesh(eye); }
    } catch (...) {
        xrDestroySession(session_);  // and all that was made of it
        throw;
    }
}

Session::~Session() {
    const std::lock_guard lock(context_.queueMutex());
    xrDestroySession(session_);
}

FrameOutcome Session::beginFrame() {
    pollEvents();
    if (ended_) { return FrameOutcome::kExit; }
    if (!running_) { return FrameOutcome::kWait; }
    const XrFrameWaitInfo wait_info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
    frame_state_ = structure<XrFrameState>(XR_TYPE_FRAME_STATE);
    BINOSPLAT_XR(xrWaitFrame(session_, &wait_info, &frame_state_));
    const XrDuration stated_period = frame_state_.predictedDisplayPeriod;
    if (std::abs(stated_period - told_for_) > stated_period / 100) {
        told_for_ = stated_period;
        told_period_ = askForPeriod();
    }
    pace_.begin(frame_state_.predictedDisplayTime, stated_period, told_period_);
    busy_from_seconds_ = threadSeconds();
    const XrFrameBeginInfo begin_info{XR_TYPE_FRAME_BEGIN_INFO, nullptr};
    {
        const std::lock_guard lock(context_.queueMutex());
        BINOSPLAT_XR(xrBeginFrame(session_, &begin_info));
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
    info.environmentBlendMode = blend_mode_;
    info.layerCount = static_cast<std::uint32_t>(layers.size());
    info.layers = layers.empty() ? nullptr : layers.data();
    pace_.end(!layers.empty(), threadSeconds() - busy_from_seconds_);
    const std::lock_guard lock(context_.queueMutex());
    BINOSPLAT_XR(xrEndFrame(session_, &info));
}

double Session::periodMs() const {
    const double period_ms = static_cast<double>(pace_.period()) * 1e-6;
    return period_ms >= kShortestPeriodMs && period_ms <= kLongestPeriodMs ? period_ms : 1e3 * kUsualPeriodSeconds;
}

std::vector<double> Session::refreshRates() const {
    if (!instance_.hasRefreshRates()) { return {}; }
    std::vector<float> rates;
    instance_.troubles().tryFor("a choice of refresh rates", [&] {
        const auto list = instance_.function<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB");
        std::uint32_t count = 0;
        checkResult(list(session_, 0, &count, nullptr), "xrEnumerateDisplayRefreshRatesFB");
        std::vector<float> found(count);
        checkResult(list(session_, count, &count, found.data()), "xrEnumerateDisplayRefreshRatesFB");
        found.resize(count);
        rates = std::move(found);
    });
    return {rates.begin(), rates.end()};
}

XrDuration Session::askForPeriod() const {
    if (!instance_.hasRefreshRates()) { return 0; }
    float rate_hz = 0.0f;
    const bool is_known = instance_.troubles().tryFor("the display's refresh rate", [&] {
        const auto get = instance_.function<PFN_xrGetDisplayRefreshRateFB>("xrGetDisplayRefreshRateFB");
        checkResult(get(session_, &rate_hz), "xrGetDisplayRefreshRateFB");
    });
    return is_known && rate_hz > 0.0f ? std::llround(1e9 / static_cast<double>(rate_hz)) : 0;
}

std::string Session::askForRate(double rate_hz) {
    if (rate_hz == std::exchange(asked_rate_hz_, rate_hz)) { return {}; }
    const std::vector<double> rates = refreshRates();
    if (rates.empty()) { return "refresh-rate: this headset's rate cannot be chosen"; }
    // As people write them: 72 for 71.999.
    const auto isIt = [&](double rate) { return std::abs(rate - rate_hz) < 0.5; };
    const auto found = std::ranges::find_if(rates, isIt);
    if (rate_hz != 0.0 && found == rates.end()) {
        std::string offered;
        for (const double rate : rates) { offered += fmt::format("{}{:g}", offered.empty() ? "" : ", ", rate); }
        return fmt::format("refresh-rate is {:g}, this headset has {}", rate_hz, offered);
    }
    PFN_xrVoidFunction request = nullptr;
    XrResult result = xrGetInstanceProcAddr(instance_.handle(), "xrRequestDisplayRefreshRateFB", &request);
    if (XR_SUCCEEDED(result)) {
        const float asked_hz = rate_hz == 0.0 ? 0.0f : static_cast<float>(*found);
        result = reinterpret_cast<PFN_xrRequestDisplayRefreshRateFB>(request)(session_, asked_hz);
    }
    if (XR_SUCCEEDED(result)) { return {}; }
    if (result == XR_ERROR_SESSION_LOST || result == XR_ERROR_INSTANCE_LOST) { checkResult(result, "xrRequestDisplayRefreshRateFB"); }
    return fmt::format("refresh-rate is {:g}, this headset refuses it ({})", rate_hz, nameOf(result));
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
                throw InstanceLost(ExitCode::kNoDevice, kGoingAway);
            case XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING: {
                const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
                if (change.session == session_ && change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL) {
                    recentred_from_ = change.changeTime;
                }
                break;
            }
            case XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR:
                readHiddenMesh(static_cast<int>(reinterpret_cast<const XrEventDataVisibilityMaskChangedKHR&>(event).viewIndex));
                break;
            case XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB:
                told_for_ = 0;
                break;
            default:  // a changed controller shows in its actions
                break;
        }
    }
}

void Session::changeState(XrSessionState state) {
    pace_.interrupt();
    switch (state) {
        case XR_SESSION_STATE_FOCUSED:
            ++times_focused_;
            break;
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
            throw Lost(ExitCode::kNoDevice, "the session is lost");
        default:
            break;
    }
}

void Session::end(const std::string& why) {
    if (!ended_) { why_ended_ = why; }
    ended_ = true;
    running_ = false;
}

Session::Located Session::locate(XrSpace space) const {
    auto info = structure<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    info.viewConfigurationType = kStereo;
    info.displayTime = frame_state_.predictedDisplayTime;
    info.space = space;
    auto state = structure<XrViewState>(XR_TYPE_VIEW_STATE);
    std::array<XrView, 2> views{XrView{XR_TYPE_VIEW, nullptr, {}, {}}, XrView{XR_TYPE_VIEW, nullptr, {}, {}}};
    std::uint32_t count = 0;
    BINOSPLAT_XR(xrLocateViews(session_, &info, &state, 2, &count, views.data()));
    Located located;
    for (std::size_t e = 0; e < 2; ++e) { located.eyes[e] = {views[e].pose, views[e].fov}; }
    located.turn_known = count == 2 && (state.viewStateFlags & XR_VIEW_STATE_ORIENTATION_VALID_BIT) != 0;
    located.place_known = located.turn_known && (state.viewStateFlags & XR_VIEW_STATE_POSITION_VALID_BIT) != 0;
    return located;
}

std::optional<std::array<EyeView, 2>> Session::locateEyes() {
    Located located = locate(space_);
    if (!located.turn_known) { return std::nullopt; }
    if (located.place_known) {
        last_place_ = toXr(headOf(located.eyes).position);
        return located.eyes;
    }
    for (const int e : {kLeft, kRight}) {
        XrPosef& pose = located.eyes[static_cast<std::size_t>(e)].pose;
        pose.position = last_place_;
        const glm::dvec3 aside(static_cast<double>(e == kLeft ? -kHalfIpdMetres : kHalfIpdMetres), 0.0, 0.0);
        pose.position = toXr(transform(fromXr(pose), aside));
    }
    return located.eyes;
}

bool Session::settle(bool demanded) {
    const bool moved = recentred_from_ && frame_state_.predictedDisplayTime >= *recentred_from_;
    if (turn_settled_ && place_settled_ && !moved && !demanded) { return false; }
    Located located = locate(local_);
    // A headset that never says where it is turns all the same.
    const bool first = !turn_settled_ || (!place_settled_ && located.place_known);
    if (!located.turn_known || (!first && !moved && !demanded)) { return false; }
    if (!located.place_known) {
        for (EyeView& eye : located.eyes) { eye.pose.position = {}; }
    }
    const XrSpace room = makeSpace(XR_REFERENCE_SPACE_TYPE_LOCAL, toXr(upright(headOf(located.eyes))));
    xrDestroySpace(std::exchange(space_, room));
    turn_settled_ = true;
    place_settled_ = located.place_known;
    recentred_from_.reset();
    last_place_ = {};
    return true;
}

std::optional<double> Session::floorBelowMetres() {
    if (floor_ == XR_NULL_HANDLE) { return std::nullopt; }
    auto location = structure<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    const auto locate = [&] { BINOSPLAT_XR(xrLocateSpace(floor_, space_, frame_state_.predictedDisplayTime, &location)); };
    if (!instance_.troubles().tryFor("a floor", locate)) { xrDestroySpace(std::exchange(floor_, XrSpace(XR_NULL_HANDLE))); }
    if ((location.locationFlags & XR_SPACE_LOCATION_POSITION_VALID_BIT) == 0) { return std::nullopt; }
    return -static_cast<double>(location.pose.position.y);
}

XrSpace Session::makeSpace(XrReferenceSpaceType type, const XrPosef& pose) const {
    auto info = structure<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
    info.referenceSpaceType = type;
    info.poseInReferenceSpace = pose;
    XrSpace space = XR_NULL_HANDLE;
    BINOSPLAT_XR(xrCreateReferenceSpace(session_, &info, &space));
    return space;
}

void Session::findFloor() {
    std::vector<XrReferenceSpaceType> offered;
    instance_.troubles().tryFor("the stage's floor", [&] {
        std::uint32_t count = 0;
        BINOSPLAT_XR(xrEnumerateReferenceSpaces(session_, 0, &count, nullptr));
        std::vector<XrReferenceSpaceType> found(count);
        BINOSPLAT_XR(xrEnumerateReferenceSpaces(session_, count, &count, found.data()));
        offered = std::move(found);
    });
    for (const XrReferenceSpaceType type : {XR_REFERENCE_SPACE_TYPE_STAGE, kLocalFloor}) {
        const bool is_floor = type == kLocalFloor ? instance_.hasLocalFloor() : std::ranges::find(offered, type) != offered.end();
        if (!is_floor || floor_ != XR_NULL_HANDLE) { continue; }
        auto info = structure<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
        info.referenceSpaceType = type;
        info.poseInReferenceSpace = kHere;
        const auto make = [&] { BINOSPLAT_XR(xrCreateReferenceSpace(session_, &info, &floor_)); };
        if (!instance_.troubles().tryFor("a floor", make)) { floor_ = XR_NULL_HANDLE; }
    }
}

void Session::readHiddenMesh(int eye) {
    if (!instance_.hasVisibilityMask() || eye < 0 || eye > 1) { return; }
    HiddenMesh& mesh = hidden_meshes_[static_cast<std::size_t>(eye)];
    mesh = {};
    ++hidden_mesh_version_;
    // Some runtimes list the extension but lack its function.
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
