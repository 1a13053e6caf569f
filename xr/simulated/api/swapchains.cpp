// Swapchains: checks of the requested images; making, acquiring, waiting for and releasing images.
#include "xr/simulated/api/swapchains.h"

#include <algorithm>
#include <bit>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr XrSwapchainUsageFlags kKnownUsage =
    XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
    XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT |
    XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT |
    XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT;
constexpr XrSwapchainCreateFlags kKnownFlags =
    XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT | XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;

// The requested usage, and the runtime's own: the attachment layout in which images are handed over, and the
// read-back.
VkImageUsageFlags usageOf(XrSwapchainUsageFlags asked, const SwapchainFormat& format) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const bool is_colour = format.aspects == VK_IMAGE_ASPECT_COLOR_BIT;
    usage |= is_colour ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if ((asked & XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT) != 0) { usage |= VK_IMAGE_USAGE_STORAGE_BIT; }
    if ((asked & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) != 0) { usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT; }
    if ((asked & XR_SWAPCHAIN_USAGE_SAMPLED_BIT) != 0) { usage |= VK_IMAGE_USAGE_SAMPLED_BIT; }
    return usage;
}

// A mutable image may be written through a view of another format, which is how sRGB images are written by
// compute shaders. Vulkan 1.0 has no extended usage, so it is requested only then.
VkImageCreateFlags flagsOf(XrSwapchainUsageFlags asked) {
    if ((asked & XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT) == 0) { return 0; }
    const bool is_written = (asked & XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT) != 0;
    return VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | (is_written ? VK_IMAGE_CREATE_EXTENDED_USAGE_BIT : 0);
}

const SwapchainFormat& checkFormat(const Session& session, std::int64_t wanted) {
    const auto& formats = session.device->formats();
    const auto found = std::find_if(formats.begin(), formats.end(),
                                    [&](const auto& format) { return format.format == wanted; });
    require(found != formats.end(), XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED, "the format ", wanted,
            " was not enumerated");
    const bool takes_depth = session.instance.simulation->script.depth != Script::Depth::kNoImages;
    require(takes_depth || found->aspects == VK_IMAGE_ASPECT_COLOR_BIT, XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
            "the script takes no depth");
    return *found;
}

ImageInfo checkImageInfo(const Session& session, const XrSwapchainCreateInfo& info) {
    require((info.createFlags & ~kKnownFlags) == 0 && (info.usageFlags & ~kKnownUsage) == 0,
            XR_ERROR_VALIDATION_FAILURE, "unknown flags: createFlags ", info.createFlags, ", usageFlags ",
            info.usageFlags);
    require((info.createFlags & XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT) == 0, XR_ERROR_FEATURE_UNSUPPORTED,
            "no protected content");
    const SwapchainFormat& format = checkFormat(session, info.format);
    const bool is_colour = format.aspects == VK_IMAGE_ASPECT_COLOR_BIT;
    const XrSwapchainUsageFlags foreign =
        is_colour ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
    require((info.usageFlags & foreign) == 0, XR_ERROR_FEATURE_UNSUPPORTED, format.name,
            is_colour ? " cannot be a depth attachment" : " cannot be a colour attachment");
    require(
        info.width > 0 && info.height > 0 && info.arraySize > 0 && info.mipCount > 0 && info.sampleCount > 0,
        XR_ERROR_VALIDATION_FAILURE, "a size is 0: ", info.width, "x", info.height, ", arraySize ",
        info.arraySize, ", mipCount ", info.mipCount, ", sampleCount ", info.sampleCount);
    require(info.width <= kMostSwapchainPixels && info.height <= kMostSwapchainPixels,
            XR_ERROR_VALIDATION_FAILURE, "the size is ", info.width, "x", info.height, ", at most ",
            kMostSwapchainPixels, " each are offered");
    require(info.mipCount <= std::bit_width(std::max(info.width, info.height)), XR_ERROR_VALIDATION_FAILURE,
            "mipCount is ", info.mipCount, ", more than ", info.width, "x", info.height, " pixels have");
    require(info.faceCount == 1 || info.faceCount == 6, XR_ERROR_VALIDATION_FAILURE, "faceCount is ",
            info.faceCount, ", must be 1 or 6");
    const bool is_cube = info.faceCount == 6;
    require(!is_cube || session.instance.extensions.contains(XR_KHR_COMPOSITION_LAYER_CUBE_EXTENSION_NAME),
            XR_ERROR_FEATURE_UNSUPPORTED, "cube maps are of XR_KHR_composition_layer_cube");
    require(!is_cube || (info.width == info.height && is_colour), XR_ERROR_VALIDATION_FAILURE,
            "the faces of a cube map are ", info.width, "x", info.height, " of ", format.name,
            ", must be coloured squares");
    require(info.arraySize <= kMostSwapchainPixels, XR_ERROR_VALIDATION_FAILURE, "arraySize is ",
            info.arraySize, ", at most ", kMostSwapchainPixels, " are offered");
    require(info.sampleCount == 1, XR_ERROR_FEATURE_UNSUPPORTED, "sampleCount is ", info.sampleCount,
            ", must be 1, which is maxSwapchainSampleCount");
    const VkImageCreateFlags flags =
        flagsOf(info.usageFlags) | (is_cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0);
    const ImageInfo image{format,        {info.width, info.height},        info.arraySize * info.faceCount,
                          info.mipCount, usageOf(info.usageFlags, format), flags,
                          info.faceCount};
    session.device->checkImage(image);
    return image;
}

}  // namespace

std::uint32_t Swapchain::nextImage() const {
    const auto count = static_cast<std::uint32_t>(images.size());
    const auto turn = static_cast<std::uint32_t>(acquisitions % count);
    std::uint32_t next = turn;
    switch (session.instance.simulation->script.image_order) {
        case Script::ImageOrder::kInTurn:
            break;
        case Script::ImageOrder::kReversed:
            next = count - 1 - turn;
            break;
        case Script::ImageOrder::kShuffled:
            next = static_cast<std::uint32_t>((acquisitions + 1) * 2654435761u >> 16) % count;
            break;
    }
    const auto isHeld = [&](std::uint32_t image) {
        return std::find(acquired.begin(), acquired.end(), image) != acquired.end();
    };
    // Not the one on show, if there is another.
    const auto isShown = [&](std::uint32_t image) {
        return has_released && image == released_index && acquired.size() + 1 < count;
    };
    while (isHeld(next) || isShown(next)) { next = (next + 1) % count; }
    return next;
}

Swapchain& getSwapchain(const Session& session, XrSwapchain swapchain) {
    Swapchain& found = get<Swapchain>(swapchain);
    if (&found.session != &session) { refuseHandle(swapchain, " of this session"); }
    return found;
}

void fetchTexels(Swapchain& swapchain) {
    // Nothing here looks at depth.
    if (swapchain.has_texels || swapchain.info.format.aspects != VK_IMAGE_ASPECT_COLOR_BIT) { return; }
    swapchain.released_texels = swapchain.session.device->read(*swapchain.images[swapchain.released_index]);
    swapchain.has_texels = true;
}

XrResult xrEnumerateSwapchainFormats(XrSession session, uint32_t formatCapacityInput,
                                     uint32_t* formatCountOutput, int64_t* formats) {
    return answerFor<Session>(__func__, session, [&](const Session& owner) {
        std::vector<int64_t> values;
        if (!owner.isHeadless()) {
            for (const SwapchainFormat& format : owner.device->formats()) { values.push_back(format.format); }
        }
        fillArray(formatCapacityInput, formatCountOutput, formats, values);
    });
}

XrResult xrCreateSwapchain(XrSession session, const XrSwapchainCreateInfo* createInfo,
                           XrSwapchain* swapchain) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        const XrSwapchainCreateInfo& info = checkStruct(createInfo, XR_TYPE_SWAPCHAIN_CREATE_INFO);
        XrSwapchain& output = checkOutput(swapchain);
        require(!owner.isHeadless(), XR_ERROR_VALIDATION_FAILURE, "a headless session has no swapchains");
        auto created = std::make_unique<Swapchain>(owner);
        created->info = checkImageInfo(owner, info);
        created->is_static = (info.createFlags & XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT) != 0;
        created->is_prepared.resize(created->is_static ? 1 : owner.instance.simulation->script.images);
        for (std::size_t i = 0; i < created->is_prepared.size(); ++i) {
            created->images.push_back(owner.device->createImage(created->info));
        }
        output = handleOf(adopt(owner, std::move(created)));
    });
}

XrResult xrDestroySwapchain(XrSwapchain swapchain) {
    return answer(__func__, [&] { destroyObject(get<Swapchain>(swapchain)); });
}

XrResult xrEnumerateSwapchainImages(XrSwapchain swapchain, uint32_t imageCapacityInput,
                                    uint32_t* imageCountOutput, XrSwapchainImageBaseHeader* images) {
    return answerFor<Swapchain>(__func__, swapchain, [&](const Swapchain& owner) {
        if (!wantsArray(imageCapacityInput, imageCountOutput, images, owner.images.size())) { return; }
        auto* const vulkan_images = reinterpret_cast<XrSwapchainImageVulkan2KHR*>(images);
        for (std::size_t i = 0; i < owner.images.size(); ++i) {
            checkType(vulkan_images[i], XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR);
        }
        for (std::size_t i = 0; i < owner.images.size(); ++i) {
            vulkan_images[i].image = owner.images[i]->handle();
        }
    });
}

XrResult xrAcquireSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo* acquireInfo,
                                 uint32_t* index) {
    return answerFor<Swapchain>(__func__, swapchain, [&](Swapchain& owner) {
        checkOptional(acquireInfo, XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO);
        uint32_t& output = checkOutput(index);
        require(!owner.is_static || owner.acquisitions == 0, XR_ERROR_CALL_ORDER_INVALID,
                "a static image is acquired once");
        require(owner.acquired.size() < owner.images.size(), XR_ERROR_CALL_ORDER_INVALID, "all ",
                owner.images.size(), " images are acquired already");
        const std::uint32_t next = owner.nextImage();
        // The image on show is handed out again: the application holds all others.
        if (owner.has_released && owner.released_index == next && owner.session.instance.simulation->output) {
            fetchTexels(owner);
        }
        if (!owner.is_prepared[next]) { owner.session.device->prepare(*owner.images[next]); }
        owner.is_prepared[next] = true;
        ++owner.acquisitions;
        owner.acquired.push_back(next);
        output = next;
    });
}

XrResult xrWaitSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageWaitInfo* waitInfo) {
    return answerFor<Swapchain>(__func__, swapchain, [&](Swapchain& owner) {
        const XrSwapchainImageWaitInfo& info = checkStruct(waitInfo, XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO);
        require(!owner.acquired.empty(), XR_ERROR_CALL_ORDER_INVALID, "no image is acquired");
        require(!owner.is_oldest_waited, XR_ERROR_CALL_ORDER_INVALID,
                "the image that was waited for is not released yet");
        // Slow images exceed every finite timeout. While a loss is pending, no result could say so, and the
        // wait succeeds.
        if (owner.session.slow_images > 0 && info.timeout != XR_INFINITE_DURATION &&
            !owner.session.loss_announced) {
            --owner.session.slow_images;
            return XR_TIMEOUT_EXPIRED;
        }
        owner.is_oldest_waited = true;
        return XR_SUCCESS;
    });
}

XrResult xrReleaseSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo* releaseInfo) {
    return answerFor<Swapchain>(__func__, swapchain, [&](Swapchain& owner) {
        checkOptional(releaseInfo, XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO);
        require(owner.is_oldest_waited, XR_ERROR_CALL_ORDER_INVALID, "no image was waited for");
        owner.released_index = owner.acquired.front();
        owner.acquired.pop_front();
        owner.is_oldest_waited = false;
        owner.has_released = true;
        owner.has_texels = false;
    });
}

}  // namespace simulated
