// A line of text with keys below it.
#include "app/view/panel/text_entry.h"

#include "app/view/panel/panel_pages.h"
#include "app/view/panel/panel_style.h"
#include "app/view/panel/shown_text.h"

#include <imgui.h>

#include <array>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kMostEntryBytes = 60;
constexpr std::array<const char*, 4> kRowsOfKeys{"1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm,.'"};

void drawRowOfKeys(PanelWidgets& widgets, TextEntry& entry, const char* keys) {
    std::vector<std::string> names;
    for (const char* key = keys; *key != '\0'; ++key) {
        const bool is_small = *key >= 'a' && *key <= 'z';
        names.emplace_back(1, is_small && entry.capitals ? static_cast<char>(*key - 'a' + 'A') : *key);
    }
    std::vector<const char*> shown;
    for (const std::string& name : names) { shown.push_back(name.c_str()); }
    if (const auto pressed = widgets.row(shown, {}, kTabPx)) { entry.type(names[*pressed]); }
}

}  // namespace

void TextEntry::open(What what, std::string title, std::string text) {
    what_ = what;
    title_ = std::move(title);
    text_ = std::move(text);
    is_confirmed_ = capitals = false;
}

void TextEntry::type(const std::string& letter) {
    if (text_.size() + letter.size() <= kMostEntryBytes) { text_ += letter; }
}

void TextEntry::eraseLast() {
    while (!text_.empty()) {
        const bool is_first = (static_cast<unsigned char>(text_.back()) & 0xc0) != 0x80;
        text_.pop_back();
        if (is_first) { return; }
    }
}

void drawTextEntry(PanelWidgets& widgets, TextEntry& entry, PanelRequests& requests) {
    writeWrapped(entry.title());
    ImGui::Separator();
    ImGui::AlignTextToFramePadding();
    writeLine(endOf(asShown(entry.text() + "_")));
    ImGui::Separator();
    if (entry.what() == TextEntry::What::kMetres) {
        drawRowOfKeys(widgets, entry, "1234567890.");
    } else {
        for (const char* keys : kRowsOfKeys) { drawRowOfKeys(widgets, entry, keys); }
        static constexpr std::array kSpaces{"Capitals", "Space"};
        if (const auto pressed =
                widgets.row(kSpaces, entry.capitals ? std::optional<std::size_t>(0) : std::nullopt, kTabPx)) {
            *pressed == 0 ? static_cast<void>(entry.capitals = !entry.capitals) : entry.type(" ");
        }
    }
    static constexpr std::array kEnds{"Erase", "Cancel", "Done"};
    const auto pressed = widgets.row(kEnds, {}, kLargeTargetPx);
    if (pressed && *pressed == 0) { entry.eraseLast(); }
    const bool is_done = entry.takeConfirmed() || (pressed && *pressed == 2);
    if (is_done) { requests.entered = {entry.what(), entry.text()}; }
    if (is_done || (pressed && *pressed == 1)) { entry.close(); }
}

}  // namespace binosplat
