// Dear ImGui's Vulkan backend, set up for one picture.
#include "app/view/panel/canvas.h"

#include "app/view/panel/panel_font.h"
#include "app/view/panel/panel_style.h"
#include "app/view/room/sprites.h"
#include "engine/error.h"
#include "xr/images.h"

#include <imgui.h>

#include <backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace binosplat {

namespace {

// Recordings that may be in flight; earlier ones are done.
constexpr int kFramesInFlight = 2;
// More than any page of the panel draws.
constexpr int kMostVertices = 1 << 16, kMostIndices = 3 * kMostVertices / 2;

// Draws nothing, with enough vertices that later frames find buffers that are large enough: one for each of
// the two in flight.
void makeBuffersAhead(vk::CommandBuffer commands) {
    ImDrawList list(ImGui::GetDrawListSharedData());
    list.VtxBuffer.resize(kMostVertices, ImDrawVert());
    list.IdxBuffer.resize(kMostIndices, 0);
    ImDrawList* lists[] = {&list};
    ImDrawData data;
    data.Valid = true;
    data.CmdLists = lists;
    data.CmdListsCount = 1;
    data.TotalVtxCount = kMostVertices;
    data.TotalIdxCount = kMostIndices;
    data.DisplaySize = data.FramebufferScale = ImVec2(1.0f, 1.0f);
    for (int frame = 0; frame < 2; ++frame) { ImGui_ImplVulkan_RenderDrawData(&data, commands); }
}

void requireSuccess(VkResult result) {
    check(result == VK_SUCCESS, "the panel cannot be drawn: {}", vk::to_string(vk::Result(result)));
}

}  // namespace

Canvas::Canvas(const Context& context, glm::uvec2 size_px, vk::Format format)
    : context_(context), size_px_(size_px) {
    const auto families = context.physicalDevice().getQueueFamilyProperties();
    if (!(families[context.queueFamily()].queueFlags & vk::QueueFlagBits::eGraphics)) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{}: the panel needs a queue that draws", context.deviceName()));
    }
    const TexelLayout layout = texelLayoutOf(format);
    const vk::Format raw = layout.blue_first ? vk::Format::eB8G8R8A8Unorm : vk::Format::eR8G8B8A8Unorm;
    makeImage(raw);
    if (layout.linear) {
        const vk::Format encoded = layout.blue_first ? vk::Format::eB8G8R8A8Srgb : vk::Format::eR8G8B8A8Srgb;
        encoded_.emplace(context, "canvas", size_px, encoded,
                         vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc);
    }
    makeRenderPass(raw);
    startImGui();
}

Canvas::~Canvas() {
    ImGui_ImplVulkan_Shutdown();
    ImGui::DestroyContext();
}

void Canvas::makeImage(vk::Format format) {
    picture_.emplace(context_, "canvas", size_px_, format,
                     vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc);
    view_ = vk::raii::ImageView(context_.device(),
                                vk::ImageViewCreateInfo({}, image(), vk::ImageViewType::e2D, format, {},
                                                        {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}));
}

void Canvas::makeRenderPass(vk::Format format) {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const vk::AttachmentDescription attachment(
        {}, format, vk::SampleCountFlagBits::e1, vk::AttachmentLoadOp::eClear, vk::AttachmentStoreOp::eStore,
        vk::AttachmentLoadOp::eDontCare, vk::AttachmentStoreOp::eDontCare, vk::ImageLayout::eUndefined,
        vk::ImageLayout::eTransferSrcOptimal);
    const vk::AttachmentReference reference(0, vk::ImageLayout::eColorAttachmentOptimal);
    const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, {}, reference);
    const vk::SubpassDependency dependencies[] = {
        {VK_SUBPASS_EXTERNAL, 0, Stage::eTransfer, Stage::eColorAttachmentOutput, Access::eTransferRead,
         Access::eColorAttachmentWrite},
        {0, VK_SUBPASS_EXTERNAL, Stage::eColorAttachmentOutput, Stage::eTransfer,
         Access::eColorAttachmentWrite, Access::eTransferRead}};
    render_pass_ = vk::raii::RenderPass(context_.device(),
                                        vk::RenderPassCreateInfo({}, attachment, subpass, dependencies));
    framebuffer_ = vk::raii::Framebuffer(
        context_.device(), vk::FramebufferCreateInfo({}, *render_pass_, *view_, size_px_.x, size_px_.y, 1));
}

void Canvas::startImGui() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(static_cast<float>(size_px_.x), static_cast<float>(size_px_.y));
    stylePanel();
    font_ = std::make_unique<PanelFont>();
    startBackend();
    Commands commands(context_);
    commands.begin();
    ImGui_ImplVulkan_CreateFontsTexture(*commands.buffer());
    makeBuffersAhead(*commands.buffer());
    commands.submitAndWait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    static_assert(IMGUI_VERSION_NUM < 18700, "later backends have the texture's descriptor there");
    letters_ = static_cast<VkImage>(io.Fonts->TexID);
}

void Canvas::startBackend() {
    // In case the backend is compiled without Vulkan's prototypes.
    const auto find = [](const char* name, void* context) {
        const Context& my = *static_cast<const Context*>(context);
        return my.instance().getDispatcher()->vkGetInstanceProcAddr(*my.instance(), name);
    };
    check(ImGui_ImplVulkan_LoadFunctions(find, const_cast<Context*>(&context_)),
          "the panel cannot be drawn: Vulkan lacks a function");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *context_.instance();
    info.PhysicalDevice = *context_.physicalDevice();
    info.Device = *context_.device();
    info.QueueFamily = context_.queueFamily();
    info.Queue = *context_.queue();
    info.PipelineCache = *context_.pipelineCache();
    const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 1);
    descriptors_ = vk::raii::DescriptorPool(
        context_.device(),
        vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
    info.DescriptorPool = *descriptors_;
    info.MinImageCount = info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = requireSuccess;
    ImGui_ImplVulkan_Init(&info, *render_pass_);
}

void Canvas::makeLetters() {
    font_->build();
    ImFontAtlas* const built = font_->built();
    if (built == nullptr) { return; }
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    built->GetTexDataAsRGBA32(&texels, &width, &height);
    const std::size_t bytes = std::size_t{4} * kLettersPx.x * kLettersPx.y;
    made_letters_ = Buffer(context_, "the panel's letters", bytes, MemoryKind::kUpload);
    std::copy_n(texels, bytes, made_letters_.mapped<unsigned char>().data());
}

void Canvas::takeLetters() {
    font_->take();
    if (made_letters_.bytes() == 0) { return; }
    uploads_.push_back({std::exchange(made_letters_, {})});
    ImGui::GetIO().Fonts->SetTexID(letters_);
    draw_list_.clear();  // the letters' places may have changed
}

void Canvas::recordLetters(Commands& commands) {
    for (Upload& upload : uploads_) {
        if (upload.recordings) { continue; }
        upload.recordings = 0;
        copyToTexture(commands.buffer(), upload.texels.handle(), letters_, kLettersPx);
    }
}

void Canvas::begin(const PanelPointer& pointer, double step_seconds) {
    ImGuiIO& io = ImGui::GetIO();
    constexpr float kNowhere = -std::numeric_limits<float>::max();
    io.MousePos = pointer.place_px ? ImVec2(static_cast<float>(pointer.place_px->x),
                                            static_cast<float>(pointer.place_px->y))
                                   : ImVec2(kNowhere, kNowhere);
    io.MouseDown[0] = pointer.pressed;
    io.MouseWheel = static_cast<float>(pointer.wheel);
    io.DeltaTime = std::max(static_cast<float>(step_seconds), 1e-4f);
    ImGui_ImplVulkan_NewFrame();
    ImGui::NewFrame();
    is_begun_ = true;
}

void Canvas::end() {
    ImGui::Render();
    is_begun_ = false;
    DrawList now = drawList();
    is_new_ = !is_recorded_ || now != draw_list_;
    if (!is_new_) { return; }
    draw_list_ = std::move(now);
    is_recorded_ = false;
    ++revision_;
}

void Canvas::giveUp() {
    if (std::exchange(is_begun_, false)) { ImGui::EndFrame(); }
    is_recorded_ = false;
    for (Upload& upload : uploads_) { upload.recordings.reset(); }  // it may have been the one that is gone
}

Canvas::DrawList Canvas::drawList() {
    DrawList bytes;
    const auto add = [&](const void* data, std::size_t size) {
        const auto* begin = static_cast<const unsigned char*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
    };
    const ImDrawData& drawn = *ImGui::GetDrawData();
    for (int i = 0; i < drawn.CmdListsCount; ++i) {
        const ImDrawList& list = *drawn.CmdLists[i];
        add(list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.size_in_bytes()));
        add(list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.size_in_bytes()));
        for (const ImDrawCmd& command : list.CmdBuffer) {
            add(&command.ClipRect, sizeof command.ClipRect);
            add(&command.ElemCount, sizeof command.ElemCount);
        }
    }
    return bytes;
}

void Canvas::copyTo(Commands& commands, vk::Image target) const {
    if (encoded_) {
        decodeImage(commands.buffer(), image(), *encoded_->image, target, size_px_);
    } else {
        copyImage(commands.buffer(), image(), target, size_px_);
    }
}

void Canvas::record(Commands& commands) {
    std::erase_if(uploads_,
                  [](Upload& upload) { return upload.recordings && ++*upload.recordings > kFramesInFlight; });
    if (!is_new_) { return; }
    recordLetters(commands);
    is_recorded_ = true;
    const vk::ClearValue clear(vk::ClearColorValue(std::array<float, 4>{}));
    const vk::raii::CommandBuffer& buffer = commands.buffer();
    buffer.beginRenderPass(vk::RenderPassBeginInfo(*render_pass_, *framebuffer_,
                                                   vk::Rect2D({0, 0}, {size_px_.x, size_px_.y}), clear),
                           vk::SubpassContents::eInline);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *buffer);
    buffer.endRenderPass();
}

}  // namespace binosplat
