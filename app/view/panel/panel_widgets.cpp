// ImGui's widgets, with their places noted down.
#include "app/view/panel/panel_widgets.h"

#include "app/view/panel/shown_text.h"

#include <algorithm>

namespace binosplat {

bool PanelWidgets::button(const char* name) {
    const bool pressed = ImGui::Button(name);
    noteMiddle(name);
    return pressed;
}

bool PanelWidgets::checkbox(const char* name, bool* value) {
    const bool changed = ImGui::Checkbox(name, value);
    noteBox(name);
    return changed;
}

bool PanelWidgets::radio(const char* name, bool is_chosen) {
    const bool pressed = ImGui::RadioButton(name, is_chosen);
    noteBox(name);
    return pressed;
}

std::optional<std::string_view> PanelWidgets::chooseFrom(const char* label, std::span<const std::string_view> names,
                                                         std::string_view chosen, std::size_t per_row) {
    ImGui::TextUnformatted(label);
    std::optional<std::string_view> pressed;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i % per_row != 0) {
            ImGui::SameLine(ImGui::GetContentRegionAvail().x * static_cast<float>(i % per_row) / static_cast<float>(per_row));
        }
        if (radio(std::string(names[i]).c_str(), chosen == names[i])) { pressed = names[i]; }
    }
    return pressed;
}

bool PanelWidgets::entry(const std::string& name, const std::string& trouble) {
    // ImGui takes ## in a label for the beginning of what is not shown: the text is drawn by itself, on a button without any.
    ImGui::PushID(name.c_str());
    ImGui::BeginDisabled(!trouble.empty());
    const bool pressed = ImGui::Button("##entry", ImVec2(-1.0f, 0.0f));
    ImGui::EndDisabled();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), padding = ImGui::GetStyle().FramePadding;
    const std::string shown = asShown(trouble.empty() ? name : name + "   " + trouble);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(low, high, true);
    draw.AddText(ImVec2(low.x + padding.x, low.y + padding.y), ImGui::GetColorU32(trouble.empty() ? ImGuiCol_Text : ImGuiCol_TextDisabled),
                 shown.c_str());
    draw.PopClipRect();
    noteMiddle(name);
    ImGui::PopID();
    return pressed;
}

void PanelWidgets::noteSlider(const char* name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places_[name] = {low.x + 0.5f * ImGui::CalcItemWidth(), 0.5f * (low.y + high.y)};
}

void PanelWidgets::noteMiddle(const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places_[name] = {0.5f * (low.x + high.x), 0.5f * (low.y + high.y)};
}

void PanelWidgets::noteBox(const char* name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places_[name] = {low.x + 0.5f * (high.y - low.y), 0.5f * (low.y + high.y)};
}

void writeWrapped(std::string_view text) {
    // Lines first: what is read from right to left begins on the first of them.
    const std::string clean = withoutControls(text);
    const float width = ImGui::GetContentRegionAvail().x;
    std::string shown;
    for (const char *at = clean.data(), *const end = at + clean.size(); at < end;) {
        const char* const stop = std::max(ImGui::GetFont()->CalcWordWrapPositionA(1.0f, at, end, width), at + 1);
        if (!shown.empty()) { shown += '\n'; }
        shown += asShown({at, stop});
        for (at = stop; at < end && *at == ' ';) { ++at; }
    }
    ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
}

}  // namespace binosplat
