// Dear ImGui on a picture of our own, which is copied to a headset's panel or a window. Values are
// display-encoded: an sRGB image or a window shows them as they are.
#pragma once

#include "app/view/room/panel_pointer.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/own_image.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace binosplat {

class PanelFont;

// One at a time: ImGui has one current context. Throws Error (exit code 3) if the queue cannot draw.
class Canvas {
public:
    // `format` is 8-bit RGBA or BGRA; copy targets have the same order of channels.
    Canvas(const Context& context, glm::uvec2 size_px, vk::Format format);
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;
    ~Canvas();

    // Letters wanted before begin() are shown as boxes until makeLetters(), on any thread, and then
    // takeLetters(), between frames, have brought them.
    [[nodiscard]] PanelFont& font() const { return *font_; }
    void makeLetters();
    void takeLetters();
    // Widgets are drawn between this and end() or giveUp().
    void begin(const PanelPointer& pointer, double step_seconds);
    void end();
    // Discards the widgets and the last recording.
    void giveUp();
    // Draws, unless the image is up to date; then the canvas may be copied from.
    void record(Commands& commands);
    // After record(): the picture in an image of the format that it was made for; as linear light if that
    // format is not sRGB.
    void copyTo(Commands& commands, vk::Image image) const;

    // The revision that the image shows once record() has run: changes with the picture, never 0.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

    [[nodiscard]] glm::uvec2 sizePx() const { return size_px_; }
    [[nodiscard]] vk::Image image() const { return *picture_->image; }

private:
    void makeImage(vk::Format format);
    void makeRenderPass(vk::Format format);
    void startImGui();
    void startBackend();
    void recordLetters(Commands& commands);

    // ImGui's draw data, byte by byte.
    using DrawList = std::vector<unsigned char>;
    static DrawList drawList();

    const Context& context_;
    glm::uvec2 size_px_;
    bool is_begun_ = false;
    DrawList draw_list_;
    std::uint64_t revision_ = 0;
    bool is_new_ = true, is_recorded_ = false;  // of the last end()
    std::unique_ptr<PanelFont> font_;           // needs an ImGui context
    std::optional<OwnImage> picture_;
    std::optional<OwnImage> encoded_;  // see decodeImage; none if copies are raw
    vk::raii::ImageView view_{nullptr};
    vk::raii::RenderPass render_pass_{nullptr};
    vk::raii::Framebuffer framebuffer_{nullptr};
    vk::raii::DescriptorPool descriptors_{nullptr};
    vk::Image letters_;    // the backend's: new ones are copied to it
    Buffer made_letters_;  // until they are taken
    struct Upload {
        Buffer texels;
        std::optional<int> recordings = {};  // since it was recorded
    };
    std::vector<Upload> uploads_;
};

}  // namespace binosplat
