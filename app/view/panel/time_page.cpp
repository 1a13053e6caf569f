// The panel's page for a scene that moves.
#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

namespace binosplat {

void drawTimePage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests) {
    const ShownTime& time = *status.time;
    const std::array names{"Step back", time.plays ? "Pause" : "Play", "Step on"};
    if (const auto pressed =
            widgets.row(names, time.plays ? std::nullopt : std::optional<std::size_t>(1), kLargeTargetPx)) {
        requests.play = *pressed == 1;
        requests.frame_step = *pressed == 0 ? -1 : *pressed == 2 ? 1 : 0;
    }
    const int count = static_cast<int>(time.frames);
    int frame = static_cast<int>(time.frame) + 1;
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderInt("##frame", &frame, 1, count, "frame %d")) {
        requests.frame = static_cast<std::size_t>(std::clamp(frame, 1, count) - 1);
    }
    widgets.noteSlider("frame");
    writeLine(fmt::format("{:.2f} of {:.2f} s, {:.3g} frames a second",
                          static_cast<double>(time.frame) / time.rate_hz,
                          static_cast<double>(time.frames) / time.rate_hz, time.rate_hz));
    writeLine(time.late == 0 ? ""
                             : fmt::format("{} frames came late: they could not be read in time", time.late));
    drawSaid(status);
}

}  // namespace binosplat
