// Metres as people write them.
#include "app/view/panel/measure.h"

#include "engine/setup/values.h"

#include <fmt/format.h>

#include <algorithm>

namespace binosplat {

std::string openRuler(Ruler& ruler) {
    ruler.open();
    return "click on one end of something whose length you know";
}

std::string measureAt(const std::optional<glm::dvec3>& place, Ruler& ruler, double units_per_metre,
                      TextEntry& entry) {
    if (!place) { return "nothing is seen there: click on something else"; }
    const std::optional<double> units = ruler.add(*place);
    if (!units) { return "and now on its other end"; }
    if (!(*units > 0.0)) { return "both ends are the same place"; }
    const std::string now = fmt::format("{:.4g} m", *units / units_per_metre);
    entry.open(TextEntry::What::kMetres,
               fmt::format("As shown, it is {} long. How many metres is it in truth?", now), "");
    return "as shown, it is " + now + " long";
}

std::optional<double> takeMeasure(const PanelRequests& requests, const Ruler& ruler, LoadedScene& scene) {
    if (!requests.entered || requests.entered->first != TextEntry::What::kMetres) { return std::nullopt; }
    std::string text = requests.entered->second;
    std::ranges::replace(text, ',', '.');
    const std::optional<double> metres = parseNumber(text);
    if (!metres || !(*metres > 0.0) || !(ruler.units() > 0.0)) { return std::nullopt; }
    return scene.measured = *metres / ruler.units();
}

ViewSettings savedPlace(const ViewState& state, const LoadedScene& scene) {
    ViewSettings saved = state.withPlacement();
    saved.metres_per_unit = scene.measured;
    return saved;
}

}  // namespace binosplat
