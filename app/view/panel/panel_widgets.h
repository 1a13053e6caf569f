// The panel's widgets, and where each was placed.
#pragma once

#include <imgui.h>
#include <glm/glm.hpp>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace binosplat {

// Where to point at a widget, in pixels of the panel, by its name.
using WidgetPlaces = std::map<std::string, glm::dvec2>;

// ImGui's widgets between ImGui::Begin and End; each is in places() once it is drawn.
class PanelWidgets {
public:
    // `chosen` makes it stand out; with a size of 0 it is as large as its name needs.
    bool button(const char* name, bool chosen = false, const glm::vec2& size_px = {0.0f, 0.0f});
    // Buttons of equal width in one row from here to `end_x`, a share of the line; returns the one that was
    // pressed. `chosen`: the one that stands out, if any.
    std::optional<std::size_t> row(std::span<const char* const> names, std::optional<std::size_t> chosen,
                                   float height_px, float end_x = 1.0f);
    bool checkbox(const char* name, bool* value);
    // A row of its own, `size_px` large, for a name that is shown literally, with `about` below it; `trouble`
    // greys it out, and is shown in place of `about`. The text begins `indent_px` from the left.
    bool entry(const std::string& name, const std::string& about, const std::string& trouble,
               const glm::vec2& size_px, float indent_px);
    // A star, called `name` in places().
    bool star(const std::string& name, bool filled, const glm::vec2& size_px);
    // Call after a slider, to note its place.
    void noteSlider(const std::string& name) { note(name, ImGui::CalcItemWidth()); }
    // Rows of names beside their label, of which one is chosen; returns the one that was pressed, if any.
    std::optional<std::string_view> chooseFrom(const char* label, std::span<const std::string_view> names,
                                               std::string_view chosen, std::size_t per_row);

    [[nodiscard]] const WidgetPlaces& places() const { return places_; }

private:
    // Notes the middle of the first `width_px` of the widget drawn last.
    void note(const std::string& name, float width_px);
    void noteMiddle(const std::string& name) { note(name, ImGui::GetItemRectSize().x); }
    void noteBox(const std::string& name) { note(name, ImGui::GetItemRectSize().y); }

    WidgetPlaces places_;
};

void writeLine(const std::string& line);
// As much of the text's end as fits into a line: a path's end says more.
std::string endOf(std::string line);
// Text with any content, see asShown, in as many lines as it needs.
void writeWrapped(std::string_view text);

}  // namespace binosplat
