// The viewer's panel without a device: what it draws, where its widgets are, what a click does.
#pragma once

#include "app/view/panel/panel_content.h"
#include "app/view/panel/panel_font.h"
#include "app/view/panel/panel_style.h"
#include "app/view/wearer/wearer_controls.h"
#include "tests/suite.h"

#include <imgui.h>

namespace binosplat::test {

class PanelSketch {
public:
    PanelSketch() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(static_cast<float>(kPanelPx.x), static_cast<float>(kPanelPx.y));
        stylePanel();
        font = std::make_unique<PanelFont>();
        takeLetters();
        status.has_scene = true;
        status.tools = WearerControls().choices();
        status.scene = "scene.ply";
    }
    PanelSketch(const PanelSketch&) = delete;
    PanelSketch& operator=(const PanelSketch&) = delete;
    ~PanelSketch() { ImGui::DestroyContext(); }

    // Draws one frame, with or without a pointer.
    PanelRequests draw(const glm::dvec2* pointer = nullptr, bool pressed = false) {
        if (const auto wish = chooser.takeWish()) { chooser.show(makeSceneList(*wish), *wish); }
        bringLetters(namesOn(settings, chooser, status), picturesOn(settings, chooser));
        status.pictures = &font->pictures();
        ImGuiIO& io = ImGui::GetIO();
        constexpr float kNowhere = -std::numeric_limits<float>::max();
        const glm::vec2 at = pointer != nullptr ? glm::vec2(*pointer) : glm::vec2(kNowhere);
        io.MousePos = ImVec2(at.x, at.y);
        io.MouseDown[0] = pressed;
        io.DeltaTime = 0.01f;
        ImGui::NewFrame();
        PanelRequests requests = drawPanel(kPanelPx, settings, chooser, status);
        settings = requests.settings;
        ImGui::Render();
        return requests;
    }
    // Opens a folder on the page of scenes.
    void showFolder(const fs::path& folder) {
        settings.page = PanelPage::kScenes;
        chooser.showFolder(folder.string());
    }
    // As the viewer does alongside its frames; false if there were no new letters.
    bool bringLetters(const std::string& text, const std::vector<ScenePicture>& shown = {}) {
        if (!font->want(text, shown)) { return false; }
        font->build();
        font->take();
        takeLetters();
        return true;
    }
    // Presses and releases, then draws one more frame; returns what the release requested.
    PanelRequests click(const std::string& name) {
        const PanelRequests before = draw();
        REQUIRE_MESSAGE(before.places.contains(name), name);
        const glm::dvec2 place = before.places.at(name);
        draw(&place);
        draw(&place, true);
        PanelRequests requests = draw(&place);
        draw();
        return requests;
    }

    std::unique_ptr<PanelFont> font;
    ViewSettings settings;
    SceneChooser chooser;
    PanelStatus status;

private:
    // Builds the font's atlas, as the viewer does to make a texture of it.
    static void takeLetters() {
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    }
};

// The font's texture as colours.
struct FontTexture {
    const unsigned char* rgba = nullptr;
    glm::uvec2 size_px{0};

    [[nodiscard]] std::array<unsigned char, 4> at(const glm::uvec2& texel) const {
        const unsigned char* const first = rgba + 4 * (std::size_t{texel.y} * size_px.x + texel.x);
        return {first[0], first[1], first[2], first[3]};
    }
};
inline FontTexture fontTexture() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    return {pixels, glm::uvec2(width, height)};
}

// The font's glyph of a letter, if it was loaded.
inline const ImFontGlyph* glyphOf(unsigned letter) {
    return ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(static_cast<ImWchar>(letter));
}
inline bool isThere(unsigned letter) { return glyphOf(letter) != nullptr; }

// Where to point at a widget, as shares of the panel's width and height.
inline glm::dvec2 shareOf(const WidgetPlaces& places, const std::string& name) {
    REQUIRE_MESSAGE(places.contains(name), name);
    return places.at(name) / glm::dvec2(kPanelPx);
}

// On a given page; `with_all`: with the widgets that not every device or headset has, too.
inline glm::dvec2 placeOf(const std::string& name, bool with_all = false, PanelPage page = PanelPage::kView) {
    static const std::array<std::array<WidgetPlaces, 2>, 3> places = [] {
        std::array<std::array<WidgetPlaces, 2>, 3> found;
        for (const PanelPage shown : {PanelPage::kView, PanelPage::kScenes, PanelPage::kMethod}) {
            PanelSketch sketch;
            sketch.settings.page = shown;
            const WidgetPlaces plain = sketch.draw().places;
            sketch.status.can_reload_shaders = sketch.status.can_pass_through = sketch.status.takes_depth =
                true;
            sketch.status.refresh_rates = {72.0, 80.0, 90.0, 120.0};  // as the simulated headset has them
            found[static_cast<std::size_t>(shown)] = {plain, sketch.draw().places};
        }
        return found;
    }();
    return shareOf(places[static_cast<std::size_t>(page)][with_all ? 1 : 0], name);
}

inline glm::dvec2 onScenes(const std::string& name) { return placeOf(name, false, PanelPage::kScenes); }
// On the page of methods, with which the panel opens if the config says panel-page = "method".
inline glm::dvec2 onMethod(const std::string& name, bool with_all = false) {
    return placeOf(name, with_all, PanelPage::kMethod);
}

// On a moving scene's panel, which has one more tab; `plays`: while it moves.
inline glm::dvec2 placeOfTime(const std::string& name, bool plays, PanelPage page = PanelPage::kTime) {
    PanelSketch sketch;
    sketch.settings.page = page;
    sketch.status.time = ShownTime{.plays = plays};
    return shareOf(sketch.draw().places, name);
}

// On the page of scenes, with `folder` open.
inline glm::dvec2 placeOfScene(const std::string& name, const std::string& folder) {
    PanelSketch sketch;
    sketch.showFolder(folder);
    return shareOf(sketch.draw().places, name);
}

}  // namespace binosplat::test
