// One allocation per image.
#include "engine/gpu/own_image.h"

namespace binosplat {

OwnImage::OwnImage(const Context& context, const char* name, glm::uvec2 size_px, vk::Format format,
                   vk::ImageUsageFlags usage)
    : image(context.device(),
            vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {size_px.x, size_px.y, 1}, 1, 1,
                                vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal, usage)) {
    const auto needs = image.getMemoryRequirements();
    const std::uint32_t type =
        context.memoryType(needs.memoryTypeBits, {}, vk::MemoryPropertyFlagBits::eDeviceLocal);
    memory = vk::raii::DeviceMemory(context.device(), vk::MemoryAllocateInfo(needs.size, type));
    image.bindMemory(*memory, 0);
    context.name(image, name);
}

}  // namespace binosplat
