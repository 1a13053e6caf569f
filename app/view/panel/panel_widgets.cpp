// ImGui's widgets, with their places noted down.
#include "app/view/panel/panel_widgets.h"

#include "app/view/panel/panel_style.h"
#include "app/view/panel/shown_text.h"

#include <algorithm>

namespace binosplat {

bool PanelWidgets::button(const char* name, bool chosen, const glm::vec2& size_px) {
    const int pushed = chosen ? pushChosenColours() : 0;
    const bool pressed = ImGui::Button(name, ImVec2(size_px.x, size_px.y));
    ImGui::PopStyleColor(pushed);
    noteMiddle(name);
    return pressed;
}

std::optional<std::size_t> PanelWidgets::row(std::span<const char* const> names,
                                             std::optional<std::size_t> chosen, float height_px,
                                             float end_x) {
    const float gap = 0.5f * ImGui::GetStyle().ItemSpacing.x, left = ImGui::GetCursorPosX(),
                start = ImGui::GetStyle().WindowPadding.x;
    const float right = start + end_x * (ImGui::GetWindowWidth() - 2.0f * start),
                count = static_cast<float>(names.size());
    const float width = (right - left - gap * (count - 1.0f)) / count;
    std::optional<std::size_t> pressed;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i != 0) { ImGui::SameLine(0.0f, gap); }
        if (button(names[i], chosen == i, {width, height_px})) { pressed = i; }
    }
    return pressed;
}

bool PanelWidgets::checkbox(const char* name, bool* value) {
    const bool changed = ImGui::Checkbox(name, value);
    noteBox(name);
    return changed;
}

std::optional<std::string_view> PanelWidgets::chooseFrom(const char* label,
                                                         std::span<const std::string_view> names,
                                                         std::string_view chosen, std::size_t per_row) {
    constexpr float kLabelShare = 0.25f;
    const float width = ImGui::GetContentRegionAvail().x, start = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    const auto widthOf = [](std::string_view name) {
        return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x +
               ImGui::CalcTextSize(name.data(), name.data() + name.size()).x;
    };
    const float column = (1.0f - kLabelShare) * width / static_cast<float>(per_row);
    // If words are too long for equal columns, they get equal gaps.
    const bool has_columns =
        std::ranges::all_of(names, [&](std::string_view name) { return widthOf(name) < column; });
    float used = 0.0f;
    for (const std::string_view name : names) { used += widthOf(name); }
    const float gap =
        ((1.0f - kLabelShare) * width - used) / std::max(static_cast<float>(names.size()) - 1.0f, 1.0f);
    std::optional<std::string_view> pressed;
    float at = start + kLabelShare * width;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (has_columns) { at = start + kLabelShare * width + column * static_cast<float>(i % per_row); }
        if (i == 0 || i % per_row != 0) {
            ImGui::SameLine(at);
        } else {
            ImGui::SetCursorPosX(at);
        }
        const std::string name(names[i]);
        if (ImGui::RadioButton(name.c_str(), chosen == names[i])) { pressed = names[i]; }
        noteBox(name);
        at += widthOf(names[i]) + gap;
    }
    return pressed;
}

bool PanelWidgets::entry(const std::string& name, const std::string& about, const std::string& trouble,
                         const glm::vec2& size_px, float indent_px) {
    // ImGui does not show what follows ## in a label: the text is drawn by itself, on a button without text.
    ImGui::PushID(name.c_str());
    ImGui::BeginDisabled(!trouble.empty());
    const bool pressed = ImGui::Button("##entry", ImVec2(size_px.x, size_px.y));
    ImGui::EndDisabled();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float left = low.x + ImGui::GetStyle().FramePadding.x + indent_px,
                line = ImGui::GetTextLineHeight();
    const std::string below = trouble.empty() ? about : trouble;
    const float lines = below.empty() ? line : 2.0f * line, top = 0.5f * (low.y + high.y - lines);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(low, high, true);
    const ImU32 grey = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    draw.AddText(ImVec2(left, top), trouble.empty() ? ImGui::GetColorU32(ImGuiCol_Text) : grey,
                 asShown(name).c_str());
    draw.AddText(ImVec2(left, top + line), grey, asShown(below).c_str());
    draw.PopClipRect();
    noteMiddle(name);
    ImGui::PopID();
    return pressed;
}

bool PanelWidgets::star(const std::string& name, bool filled, const glm::vec2& size_px) {
    ImGui::PushID(name.c_str());
    const bool pressed =
        ImGui::Button(filled ? "\xe2\x98\x85" : "\xe2\x98\x86", ImVec2(size_px.x, size_px.y));
    ImGui::PopID();
    noteMiddle(name);
    return pressed;
}

void PanelWidgets::note(const std::string& name, float width_px) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places_[name] = {low.x + 0.5f * width_px, 0.5f * (low.y + high.y)};
}

void writeLine(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

std::string endOf(std::string line) {
    const float room = ImGui::GetContentRegionAvail().x;
    if (ImGui::CalcTextSize(line.c_str()).x <= room) { return line; }
    // A letter's first byte, not a continuation byte.
    const auto begins = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; };
    while (!line.empty() && ImGui::CalcTextSize(("..." + line).c_str()).x > room) {
        line.erase(0, 1);
        while (!line.empty() && !begins(line.front())) { line.erase(0, 1); }
    }
    return "..." + line;
}

void writeWrapped(std::string_view text) {
    // Split into lines first: text read from right to left begins on the first line.
    const std::string clean = withoutControls(text);
    const float width = ImGui::GetContentRegionAvail().x;
    std::string shown;
    for (const char *at = clean.data(), *const end = at + clean.size(); at < end;) {
        const char* const stop =
            std::max(ImGui::GetFont()->CalcWordWrapPositionA(1.0f, at, end, width), at + 1);
        if (!shown.empty()) { shown += '\n'; }
        shown += asShown({at, stop});
        for (at = stop; at < end && *at == ' ';) { ++at; }
    }
    ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
}

}  // namespace binosplat
