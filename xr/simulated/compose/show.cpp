// A frame's line of the log, and its picture composed and written.
#include "xr/simulated/compose/show.h"

#include "xr/simulated/api/layers.h"
#include "xr/simulated/api/views.h"
#include "xr/simulated/compose/old_output.h"
#include "xr/simulated/compose/picture_file.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

FrameRecord recordOf(Session& session, const XrFrameEndInfo& info, const State& state) {
    const Simulation& simulation = *session.instance.simulation;
    FrameRecord record;
    record.frame = simulation.frames_shown;
    record.display_time_ns = info.displayTime;
    record.period_ns = simulation.clock.period();
    record.gpu_ms = session.frames.gpu_ms;
    record.should_render = session.frames.should_render;
    record.session_state = wordOf(session.state);
    record.blend_mode = wordOf(info.environmentBlendMode);
    record.stage_from_head = state.stage_from_head;
    const bool has_insets = countViews(session.view_configuration) == kMostViews;
    for (const Side side : kSides) {
        const EyeState& eye = state.eyes[side];
        record.eyes[side] = {eye.stage_from_eye, eye.fov, {}};
        if (has_insets) {
            record.eyes[side].inset = simulation.script.findInset(state, side, session.moves_insets);
        }
    }
    record.layers = loggedLayers(session, info, state);
    record.events = std::exchange(session.log_events, {});
    return record;
}

// The room about the wearer, as far as the frame's blend mode shows it.
Backdrop backdropOf(const Script& script, const XrFrameEndInfo& info) {
    if (info.environmentBlendMode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE) { return {}; }
    const glm::dvec3& room = script.room_colour;
    return {{decodeSrgb(room.r), decodeSrgb(room.g), decodeSrgb(room.b)},
            info.environmentBlendMode == XR_ENVIRONMENT_BLEND_MODE_ADDITIVE};
}

void writePicture(const Session& session, const XrFrameEndInfo& info, const State& state,
                  const std::filesystem::path& path) {
    const Simulation& simulation = *session.instance.simulation;
    const std::vector<Layer> layers = makeLayers(session, info, state);
    std::array<RgbPicture, kEyes> pictures;
    for (const Side side : kSides) {
        const EyeState& eye = state.eyes[side];
        pictures[side] = composeEye({simulation.script.size_px, eye.stage_from_eye, eye.fov}, side, layers,
                                    backdropOf(simulation.script, info));
    }
    writePng(path, putSideBySide(pictures[kLeft], pictures[kRight]));
}

}  // namespace

void showFrame(Session& session, const XrFrameEndInfo& info, const State& state) {
    Simulation& simulation = *session.instance.simulation;
    if (!simulation.output) {
        session.log_events.clear();
        return;
    }
    const bool has_picture = simulation.script.writes_pictures &&
                             simulation.script.frames.contains(simulation.frames_shown) &&
                             info.layerCount > 0;
    FrameRecord record = recordOf(session, info, state);
    if (has_picture) { record.picture = namePicture(simulation.frames_shown); }
    ++simulation.frames_shown;
    // The log first: whatever an interrupted run leaves, its log names it.
    simulation.output->log.write(makeFrameLine(record));
    if (has_picture) { writePicture(session, info, state, simulation.output->folder / record.picture); }
}

void logBetween(Session& session, const Refusal* refusal) {
    BetweenRecord record;
    record.events = std::exchange(session.log_events, {});
    Simulation& simulation = *session.instance.simulation;
    if (!simulation.output || (refusal == nullptr && record.events.empty())) { return; }
    if (refusal != nullptr) {
        record.refused = nameOf(refusal->result);
        record.reason = refusal->reason;
        record.should_render = session.frames.should_render;
    }
    record.display_time_ns = session.frames.last_begun.value_or(simulation.clock.now());
    record.session_state = wordOf(session.state);
    simulation.output->log.write(makeBetweenLine(record));
}

}  // namespace simulated
