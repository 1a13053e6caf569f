// A header-only C++ layer over binosplat.h, with owners that destroy what they hold, and exceptions. Rules,
// units and threads are those of binosplat.h, which says more about each call.
#ifndef BINOSPLAT_HPP
#define BINOSPLAT_HPP

#include "binosplat.h"

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace bsp {

// what(): one line.
class Error : public std::runtime_error {
public:
    explicit Error(bsp_result code) : std::runtime_error(bsp_error_text()), code_(code) {}
    [[nodiscard]] bsp_result code() const { return code_; }

private:
    bsp_result code_;
};

inline void check(bsp_result result) {
    if (result < 0) { throw Error(result); }
}

// A structure with nothing set but its header: make<bsp_view>(BSP_TYPE_VIEW).
template <typename Structure>
Structure make(int type) {
    Structure structure{};
    structure.type = static_cast<std::uint32_t>(type);
    structure.size = sizeof(Structure);
    return structure;
}
inline bsp_frame_info frame() { return make<bsp_frame_info>(BSP_TYPE_FRAME_INFO); }

template <typename Handle, void (*destroy)(Handle)>
class Owner {
public:
    [[nodiscard]] Handle get() const { return handle_.get(); }

protected:
    void take(Handle handle) { handle_.reset(handle); }

private:
    struct Destroy {
        void operator()(Handle handle) const { destroy(handle); }
    };
    std::unique_ptr<std::remove_pointer_t<Handle>, Destroy> handle_;
};

class Device : public Owner<bsp_device, bsp_device_destroy> {
public:
    explicit Device(const std::string& name = "") {
        auto info = make<bsp_device_info>(BSP_TYPE_DEVICE_INFO);
        info.name = name.empty() ? nullptr : name.c_str();
        create(info);
    }
    explicit Device(const bsp_device_info& info) { create(info); }
    [[nodiscard]] std::string name() const { return bsp_device_name(get()); }

private:
    void create(const bsp_device_info& info) {
        bsp_device device = nullptr;
        check(bsp_device_create(&info, &device));
        take(device);
    }
};

using Views = std::array<bsp_view, 2>;

inline Views lookAt(const double (&eye)[3], const double (&look)[3], const double (&up)[3],
                    double eye_distance, double fov_x_rad, unsigned width, unsigned height) {
    Views views{make<bsp_view>(BSP_TYPE_VIEW), make<bsp_view>(BSP_TYPE_VIEW)};
    check(bsp_look_at(eye, look, up, eye_distance, fov_x_rad, width, height, 2, views.data()));
    return views;
}

class Scene : public Owner<bsp_scene, bsp_scene_destroy> {
public:
    // Starts loading; wait() until it is loaded.
    Scene(const Device& device, const std::string& source) {
        auto info = make<bsp_scene_info>(BSP_TYPE_SCENE_INFO);
        info.source = source.c_str();
        create(device, info);
    }
    Scene(const Device& device, const bsp_splats& splats) {
        auto info = make<bsp_scene_info>(BSP_TYPE_SCENE_INFO);
        info.splats = &splats;
        create(device, info);
    }
    Scene(const Device& device, const bsp_scene_info& info) { create(device, info); }
    [[nodiscard]] bool isThere(double* progress = nullptr) const {
        const bsp_result state = bsp_scene_state(get(), progress);
        check(state);
        return state == BSP_SUCCESS;
    }
    void wait() const { check(bsp_scene_wait(get())); }
    void cancel() { bsp_scene_cancel(get()); }
    [[nodiscard]] bsp_scene_properties properties() const {
        auto properties = make<bsp_scene_properties>(BSP_TYPE_SCENE_PROPERTIES);
        check(bsp_scene_get_properties(get(), &properties));
        return properties;
    }
    // Both eyes at the start view.
    [[nodiscard]] Views startViews(double eye_distance, double fov_x_rad, unsigned width,
                                   unsigned height) const {
        const bsp_scene_properties start = properties();
        return lookAt(start.eye, start.look, start.up, eye_distance, fov_x_rad, width, height);
    }

private:
    void create(const Device& device, const bsp_scene_info& info) {
        bsp_scene scene = nullptr;
        check(bsp_scene_create(device.get(), &info, &scene));
        take(scene);
    }
};

struct Picture {
    unsigned width = 0, height = 0;
    std::vector<float> values;  // values[(y * width + x) * channels + channel]
};

class Renderer : public Owner<bsp_renderer, bsp_renderer_destroy> {
public:
    explicit Renderer(const Device& device) {
        bsp_renderer renderer = nullptr;
        check(bsp_renderer_create(device.get(), &renderer));
        take(renderer);
    }
    bsp_frame_result render(const bsp_frame_info& frame) {
        auto result = make<bsp_frame_result>(BSP_TYPE_FRAME_RESULT);
        check(bsp_render(get(), &frame, &result));
        return result;
    }
    // With the default settings, or those of `frame`.
    bsp_frame_result render(const Scene& scene, const Views& views, bsp_frame_info frame = bsp::frame()) {
        frame.scene = scene.get();
        frame.views = views.data();
        frame.view_count = 2;
        return render(frame);
    }
    [[nodiscard]] Picture colour(const bsp_view& view, unsigned index) {
        return read(view, index, 4, bsp_read_colour);
    }
    [[nodiscard]] Picture depth(const bsp_view& view, unsigned index) {
        return read(view, index, 1, bsp_read_depth);
    }

private:
    template <typename Read>
    Picture read(const bsp_view& view, unsigned index, unsigned channels, Read from) {
        Picture picture{view.width, view.height,
                        std::vector<float>(std::size_t{channels} * view.width * view.height)};
        check(from(get(), index, picture.values.data(), picture.values.size()));
        return picture;
    }
};

inline void writePicture(const std::string& path, const Picture& picture) {
    check(bsp_write_picture(path.c_str(), picture.values.data(), picture.width, picture.height));
}

}  // namespace bsp

#endif
