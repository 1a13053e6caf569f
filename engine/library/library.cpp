// The public header's functions, by the engine's own.
#include "engine/error.h"
#include "engine/frame/stereo_frame.h"
#include "engine/geometry.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/library/binosplat.h"
#include "engine/picture/image_io.h"
#include "engine/scene/procedural.h"
#include "engine/scene/standpoint.h"
#include "engine/web/web_files.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace binosplat::engine {

namespace {

constexpr unsigned kLargestSize = 16384;
constexpr std::uint64_t kCacheBytes = std::uint64_t{4} << 30;  // of scenes from the web, as --cache-limit

glm::dvec3 vectorOf(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void checkSize(unsigned width, unsigned height) {
    check(width >= 1 && width <= kLargestSize && height >= 1 && height <= kLargestSize, "size is {}x{}, must be 1 to {} each way", width,
          height, kLargestSize);
}

Mode modeOf(Method method) {
    switch (method) {
        case Method::kTwoPass:
            return Mode::kTwoPass;
        case Method::kShared:
            return Mode::kShared;
        case Method::kPaper:
            return Mode::kPaper;
        case Method::kPredicted:
            return Mode::kPredicted;
        case Method::kTemporal:
            return Mode::kTemporal;
    }
    fail("method is {}, must be one of Method", static_cast<int>(method));
}

Eye eyeOf(const View& view, glm::uvec2 size_px, const glm::dvec3& origin) {
    const auto& [w, x, y, z] = view.orientation;
    const glm::dquat orientation(w, x, y, z);
    const double length = glm::length(orientation);
    check(std::isfinite(length) && length > 0.0, "orientation of a view has the length {}, must be 1", length);
    const glm::dvec3 position = vectorOf(view.position);
    check(isFinite(position), "position of a view is not finite");
    constexpr double kRight = std::numbers::pi / 2.0;
    check(view.left_rad < view.right_rad && view.down_rad < view.up_rad && view.left_rad > -kRight && view.right_rad < kRight &&
              view.down_rad > -kRight && view.up_rad < kRight,
          "angles of a view are {}, {}, {}, {} (left, right, up, down), must be within pi / 2, left less than right and down less than up",
          view.left_rad, view.right_rad, view.up_rad, view.down_rad);
    const ViewAngles angles{view.left_rad, view.right_rad, view.up_rad, view.down_rad};
    return {{glm::normalize(orientation), position - origin}, intrinsicsFromAngles(angles, size_px), size_px};
}

FrameSettings frameSettingsOf(const Settings& settings, Order order, double usual_near) {
    check(settings.budget >= 0.0 && settings.budget <= 1.0, "budget is {}, must be 0 to 1", settings.budget);
    const double near = settings.near.value_or(usual_near);
    check(std::isfinite(near) && near > 0.0, "near is {}, must be more than 0", near);
    const glm::dvec3 background = vectorOf(settings.background);
    check(isFinite(background), "background is not finite");
    FrameSettings frame;
    frame.mode = modeOf(settings.method);
    frame.near = near;
    frame.background = background;
    frame.order = order;
    frame.keep_past = hasPast(frame.mode);
    // Of reports: nobody asks here.
    frame.keep_depth = false;
    frame.half_floats = settings.half_floats;
    frame.stereo.budget = settings.budget;
    frame.stereo.move_cost = kDefaultMoveCost;
    return frame;
}

}  // namespace

Views lookAt(const std::array<double, 3>& eye, const std::array<double, 3>& look, const std::array<double, 3>& up, double eye_distance,
             double fov_x_rad, unsigned width, unsigned height) {
    checkSize(width, height);
    check(fov_x_rad > 0.0 && fov_x_rad < std::numbers::pi, "field of view is {}, must be more than 0 and less than pi", fov_x_rad);
    check(std::isfinite(eye_distance), "eye distance is not finite");
    const Eye middle{binosplat::lookAt(vectorOf(eye), vectorOf(look), vectorOf(up)), {}, {width, height}};
    const double x = fov_x_rad / 2.0, y = std::atan(std::tan(x) * height / width);
    Views views;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Pose pose = stereoPair(middle, eye_distance)[i].world_from_camera;
        const glm::dquat& q = pose.orientation;
        views[i] = {{q.w, q.x, q.y, q.z}, {pose.position.x, pose.position.y, pose.position.z}, -x, x, y, -y};
    }
    return views;
}

struct Renderer::State {
    explicit State(const std::string& device) : context({.device = device}) {}

    Context context;
    std::unique_ptr<GpuScene> scene;
    std::optional<StereoFrame> frame;  // after what it shows
    binosplat::View start{};           // in the file's coordinates
    glm::dvec3 origin{0.0};            // see Scene
    double usual_near = kUsualNear;
    double gpu_ms = 0.0;
    bool rendered = false;
};

Renderer::Renderer(const std::string& device) : state_(std::make_unique<State>(device)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::load(const std::string& scene) {
    LoadNotes notes;
    const Scene loaded = loadSceneFromAnywhere(scene, 0, notes, {}, {}, {webCacheFolder(), kCacheBytes, {}});
    const std::optional<binosplat::View> own = isBuiltin(scene) ? builtinView(scene) : std::nullopt;
    binosplat::View start = own ? *own : judgeStandpoint(loaded).view;
    start.eye += loaded.origin, start.look += loaded.origin;
    const double usual_near = usualNear(loaded);
    // The scene before stays until the frame has room for the new one, and for good if it has not.
    auto uploaded = std::make_unique<GpuScene>(state_->context, loaded);
    if (state_->frame) {
        state_->frame->show(*uploaded);
    } else {
        state_->frame.emplace(state_->context, *uploaded);
    }
    state_->scene = std::move(uploaded);
    state_->start = start;
    state_->origin = loaded.origin;
    state_->usual_near = usual_near;
    state_->rendered = false;
}

std::string Renderer::deviceName() const { return state_->context.deviceName(); }

std::size_t Renderer::splatCount() const { return state_->scene ? state_->scene->splatCount() : 0; }

Views Renderer::startViews(double eye_distance, double fov_x_rad, unsigned width, unsigned height) const {
    check(state_->scene != nullptr, "startViews: no scene is loaded, must be loaded first");
    const auto array = [](const glm::dvec3& v) { return std::array{v.x, v.y, v.z}; };
    const binosplat::View& start = state_->start;
    return engine::lookAt(array(start.eye), array(start.look), array(start.up), eye_distance, fov_x_rad, width, height);
}

void Renderer::render(const Views& views, const Settings& settings) {
    check(state_->frame.has_value(), "render: no scene is loaded, must be loaded first");
    checkSize(settings.width, settings.height);
    const glm::uvec2 size_px(settings.width, settings.height);
    const std::array<Eye, 2> eyes{eyeOf(views[0], size_px, state_->origin), eyeOf(views[1], size_px, state_->origin)};
    const FrameSettings frame = frameSettingsOf(settings, state_->scene->usualOrder(), state_->usual_near);
    state_->rendered = false;
    state_->gpu_ms = state_->frame->render(eyes, frame).gpu_total_ms;
    state_->rendered = true;
}

Picture Renderer::read(int eye) {
    check(state_->rendered, "read: nothing is rendered yet");
    check(eye == kLeft || eye == kRight, "eye is {}, must be 0 (left) or 1 (right)", eye);
    Image image = state_->frame->readPicture(eye);
    return {image.size_px.x, image.size_px.y, std::move(image.values)};
}

double Renderer::gpuMs() const { return state_->gpu_ms; }

std::filesystem::path writePicture(const std::filesystem::path& path_without_extension, const Picture& picture) {
    const Image image{{picture.width, picture.height}, 4, picture.values};
    return binosplat::writePicture(path_without_extension, PictureKind::kDisplay, image).front();
}

}  // namespace binosplat::engine
