// Devices, and functions that need none.
#include "engine/library/objects.h"
#include "engine/library/structures.h"
#include "engine/picture/image_io.h"

#include <cmath>
#include <numbers>

namespace binosplat {
namespace {

constexpr std::uint32_t kLargestSize = 16384;

void checkSize(std::uint32_t width, std::uint32_t height) {
    check(width >= 1 && width <= kLargestSize && height >= 1 && height <= kLargestSize,
          "size is {}x{}, must be 1 to {} each way", width, height, kLargestSize);
}

glm::dvec3 vectorAt(const double* values, const char* name) {
    check(values != nullptr, "{} is null", name);
    const glm::dvec3 v(values[0], values[1], values[2]);
    check(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "{} is not finite", name);
    return v;
}

ForeignDevice foreignOf(const bsp_vulkan_device& given) {
    const auto calling = [&](void (*function)(void*)) {
        return function != nullptr
                   ? std::function<void()>([function, user = given.queue_user] { function(user); })
                   : nullptr;
    };
    check(given.enabled_extension_count == 0 || given.enabled_extensions != nullptr,
          "enabled_extensions of bsp_vulkan_device is null");
    return {.instance = given.instance,
            .physical_device = given.physical_device,
            .device = given.device,
            .queue_family = given.queue_family,
            .queue = given.queue,
            .enabled_features = given.enabled_features,
            .enabled_extensions = {given.enabled_extensions,
                                   given.enabled_extensions + given.enabled_extension_count},
            .lock_queue = calling(given.lock_queue),
            .unlock_queue = calling(given.unlock_queue)};
}

}  // namespace

Eye eyeOf(const bsp_view& view, const glm::dvec3& origin) {
    checkSize(view.width, view.height);
    const auto& [w, x, y, z] = view.orientation;
    const glm::dquat orientation(w, x, y, z);
    const double length = glm::length(orientation);
    check(std::isfinite(length) && length > 0.0, "orientation of a view has the length {}, must be 1",
          length);
    constexpr double kRight = std::numbers::pi / 2.0;
    check(view.left_rad < view.right_rad && view.down_rad < view.up_rad && view.left_rad > -kRight &&
              view.right_rad < kRight && view.down_rad > -kRight && view.up_rad < kRight,
          "angles of a view are {}, {}, {}, {} (left, right, up, down), must be within pi / 2, left less "
          "than right and down less than up",
          view.left_rad, view.right_rad, view.up_rad, view.down_rad);
    const ViewAngles angles{view.left_rad, view.right_rad, view.up_rad, view.down_rad};
    const glm::uvec2 size_px(view.width, view.height);
    return {{glm::normalize(orientation), vectorAt(view.position, "position of a view") - origin},
            intrinsicsFromAngles(angles, size_px),
            size_px};
}

}  // namespace binosplat

using namespace binosplat;

bsp_device_t::bsp_device_t(const bsp_device_info& info, const ContextOptions& options)
    : log_to(info.log), log_user(info.log_user), context(options), empty(context, Scene{}) {}

const char* bsp_version(void) { return BINOSPLAT_LIBRARY_VERSION; }

bsp_result bsp_device_create(const bsp_device_info* info, bsp_device* device) {
    return guarded([&] {
        check(device != nullptr, "device is null");
        const auto known =
            info != nullptr ? readStructure(info, BSP_TYPE_DEVICE_INFO, sizeof(bsp_header), "bsp_device_info")
                            : bsp_device_info{};
        ContextOptions options{.device = known.name != nullptr ? known.name : "",
                               .validation = known.validation != 0,
                               .memory_limit_bytes = known.memory_limit_bytes};
        ForeignDevice foreign;
        if (const auto* next =
                reinterpret_cast<const bsp_vulkan_device*>(findNext(known.next, BSP_TYPE_VULKAN_DEVICE))) {
            foreign = foreignOf(readStructure(next, BSP_TYPE_VULKAN_DEVICE,
                                              offsetof(bsp_vulkan_device, lock_queue), "bsp_vulkan_device"));
            options.foreign = &foreign;
        }
        *device = new bsp_device_t(known, options);
        return BSP_SUCCESS;
    });
}

void bsp_device_destroy(bsp_device device) {
    if (device == nullptr) { return; }
    (void)guarded([&] {
        for (const std::string& message : device->context.validationMessages()) {
            device->log("Vulkan validation: " + message);
        }
        return BSP_SUCCESS;
    });
    delete device;
}

const char* bsp_device_name(bsp_device device) { return device->context.deviceName().c_str(); }

bsp_result bsp_look_at(const double eye[3], const double look[3], const double up[3], double eye_distance,
                       double fov_x_rad, std::uint32_t width, std::uint32_t height, std::uint32_t count,
                       bsp_view* views) {
    return guarded([&] {
        checkSize(width, height);
        check(fov_x_rad > 0.0 && fov_x_rad < std::numbers::pi,
              "field of view is {}, must be more than 0 and less than pi", fov_x_rad);
        check(std::isfinite(eye_distance), "eye distance is not finite");
        check(count == 1 || count == 2, "there are {} views, must be 1 or 2", count);
        checkHeader(views, BSP_TYPE_VIEW, kFirstViewSize, "bsp_view");
        const Eye middle{
            lookAt(vectorAt(eye, "eye"), vectorAt(look, "look"), vectorAt(up, "up")), {}, {width, height}};
        const std::array<Eye, 2> eyes =
            count == 2 ? stereoPair(middle, eye_distance) : std::array{middle, middle};
        const double x = fov_x_rad / 2.0, y = std::atan(std::tan(x) * height / width);
        const std::uint32_t stride = views[0].size;
        for (std::size_t i = 0; i < count; ++i) {
            auto* view = reinterpret_cast<bsp_view*>(reinterpret_cast<unsigned char*>(views) + i * stride);
            checkHeader(view, BSP_TYPE_VIEW, kFirstViewSize, "bsp_view");
            const auto& [q, p] = eyes[i].world_from_camera;
            writeStructure(
                view,
                {0, 0, nullptr, {q.w, q.x, q.y, q.z}, {p.x, p.y, p.z}, -x, x, y, -y, width, height, {}});
        }
        return BSP_SUCCESS;
    });
}

bsp_result bsp_write_picture(const char* path, const float* rgba, std::uint32_t width, std::uint32_t height) {
    return guarded([&] {
        check(path != nullptr && rgba != nullptr, "{} is null", path == nullptr ? "path" : "rgba");
        checkSize(width, height);
        const Image image{{width, height}, 4, {rgba, rgba + std::size_t{4} * width * height}};
        writePicture(path, PictureKind::kDisplay, image);
        return BSP_SUCCESS;
    });
}
