// Dear ImGui on a picture of our own, which is copied to a headset's panel or a window. Values are
// display-encoded: an sRGB image or a window shows them as they are.
#pragma once

#include "app/view/room/panel_pointer.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/own_image.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <utility>
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

    // Letters wanted before begin() are shown as boxes until takeLetters(), between frames, has brought them.
    // What earlier frames use is kept until they are done.
    [[nodiscard]] PanelFont& font() const { return *font_; }
    void takeLetters();
    // Widgets are drawn between this and end() or giveUp().
    void begin(const PanelPointer& pointer, double step_seconds);
    void end();
    // Discards the widgets and the last recording; may wait for the queue.
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
    // Without letters until upload().
    void startBackend();
    void upload(vk::CommandBuffer commands);
    void startBackendNow();
    void setBackendAside();
    // What was set aside, once no frame uses it.
    void dropOld();

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
    std::vector<std::pair<void*, vk::raii::DescriptorPool>> old_;  // backends that frames in flight may use
    // Whether the backend exists; its letters may not be there yet.
    bool has_letters_ = false, is_uploading_ = false;
    int records_ = 0;  // since they were uploaded
};

}  // namespace binosplat
