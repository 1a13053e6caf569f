// What the panel is made of, and where each piece came to lie.
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

// ImGui's widgets between ImGui::Begin and End; each is in `places` once it is drawn.
class PanelWidgets {
public:
    bool button(const char* name);
    bool checkbox(const char* name, bool* value);
    // Whether it was pressed.
    bool radio(const char* name, bool is_chosen);
    // A row of its own for a name that is shown letter by letter, whatever it holds; `trouble` makes it grey and follows it.
    bool entry(const std::string& name, const std::string& trouble);
    // To be called after a slider: it is where the next column would begin.
    void noteSlider(const char* name);
    // Rows of names of which one is chosen; gives the one that was pressed, if one was.
    std::optional<std::string_view> chooseFrom(const char* label, std::span<const std::string_view> names, std::string_view chosen,
                                               std::size_t per_row);

    [[nodiscard]] const WidgetPlaces& places() const { return places_; }

private:
    void noteMiddle(const std::string& name);
    void noteBox(const char* name);

    WidgetPlaces places_;
};

// Text that may hold anything, see asShown, in as many lines as it needs.
void writeWrapped(std::string_view text);

}  // namespace binosplat
