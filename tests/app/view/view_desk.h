// The window without a headset, on a display without a screen, with a mouse and keys.
#pragma once

#include "tests/app/view/view_window.h"

namespace binosplat::test {

// The desktop's dialog does this: "echo FILE" chooses a file.
inline void dialogDoes(const Workplace& work, const std::string& command) {
    const fs::path dialog = work.path / "tools" / "zenity";
    fs::create_directories(dialog.parent_path());
    std::ofstream(dialog) << "#!/bin/sh\n" << command << '\n';
    fs::permissions(dialog, fs::perms::owner_all);
}

// Pictures at rest have one sample per pixel, unless a test says otherwise.
inline void drawOnce(const Workplace& work) {
    const fs::path file = work.base / "config" / "binosplat" / "preferences.toml";
    if (fs::exists(file)) { return; }
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "[view]\nwindow-smooth = \"off\"\n";
}

class Window : public Program {
public:
    Window(const Workplace& work, const std::string& options, const std::string& environment = "",
           const std::string& scene = "builtin:slanted-wall")
        : Program((picturesInto(work), drawOnce(work), work.path),
                  "env " + environment + viewOnDesk(scene + " " + options).substr(3)) {
        await("shows ");
        point();
    }
    // Keys go to the window that contains the mouse.
    static void point() {
        hands("search --sync --onlyvisible --name ' - binosplat$' mousemove --window %1 20 20");
    }
    // Shows or hides the help: then all before has reached the window. Returns its latest picture's number.
    std::uint64_t help() {
        hands("key h");
        const std::string lines = await("help");
        return frameOf(lines.substr(lines.rfind("frame ")));
    }
    // Waits until the window shows all pixels: only then does it write a picture that was requested.
    void rest() {
        hands("key p");
        picture_ = await("/pictures/");
        picture_ = picture_.substr(picture_.rfind(": picture ") + 10);
        picture_.pop_back();
    }
    static Image shown() { return partOf(desk().screen.picture(), {0, 0}, {1280, 720}); }
    [[nodiscard]] const std::string& picture() const { return picture_; }  // file of the latest picture
    // The colour at a place, after the keys and clicks that came before; then returns to the start view.
    glm::dvec3 seenAt(const glm::dvec2& place) {
        help();
        rest();
        hands(moveTo(place) + "click --repeat 2 --delay 20 1");
        const std::string line = await("the centre is ");
        glm::dvec3 point(0.0);
        REQUIRE(std::sscanf(line.substr(line.find("centre is")).c_str(), "centre is %lf, %lf, %lf", &point.x,
                            &point.y, &point.z) == 3);
        await("arrived");
        hands("key r");
        await("arrived");
        rest();
        return point;
    }
    // Where the camera is, while the panel shows the page View.
    glm::dvec3 eye(const Workplace& work) {
        click("Save", PanelPage::kView);
        await("saved as ");
        return placementAtWall(work).position;
    }
    void drag(int button, const glm::dvec2& from, const glm::dvec2& to) {
        for (const std::string& does : dragOf(button, from, to)) { hands(does); }
    }
    // Clicks on the panel, at 0.7 of its size in the upper right corner; a folder of scenes may be open
    // there.
    static void click(const std::string& widget, PanelPage page, const std::string& folder = "") {
        PanelSketch sketch;
        sketch.status.window.emplace();
        sketch.settings.page = page;
        if (!folder.empty()) { sketch.showFolder(folder); }
        const glm::dvec2 size(glm::ivec2(0.7 * glm::dvec2(kPanelPx)));
        hands(moveTo(glm::dvec2(1280.0 - size.x, 0.0) + shareOf(sketch.draw().places, widget) * size) +
              "click 1");
    }
    void end() {
        hands("key Escape");
        checkEnd(" pictures in the window, ");
    }

private:
    std::string picture_;
};

}  // namespace binosplat::test
