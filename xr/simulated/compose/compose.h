// The wearer's view: layers blended in linear light, one eye at a time, to 8-bit sRGB. This is done on the
// CPU, with the same result in every run.
#pragma once

#include "xr/simulated/compose/geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace simulated {

enum class Texels {
    kRgba8,    // four bytes
    kBgra8,    // four bytes
    kRgba16f,  // four IEEE halves, little endian
};
enum class Transfer {
    kLinear,  // values are light: *_UNORM and *_SFLOAT swapchains
    kSrgb,    // values are sRGB-encoded: *_SRGB swapchains
};

// One array layer of a swapchain image, rows from the top, tightly packed. The texels belong to the caller.
struct Picture {
    glm::uvec2 size_px{0, 0};
    Texels texels = Texels::kRgba8;
    Transfer transfer = Transfer::kSrgb;
    std::span<const std::byte> bytes;
};
[[nodiscard]] std::size_t bytesPerTexel(Texels texels);

// A rectangle of a picture in pixels from its top left corner; it must lie inside the picture. An empty one
// shows nothing.
struct Rect {
    glm::uvec2 offset{0, 0};
    glm::uvec2 extent{0, 0};
};

// Both false: the layer covers what is below it. Named like XrCompositionLayerFlagBits.
struct Blending {
    bool texture_source_alpha = false;
    bool unpremultiplied_alpha = false;
};

struct ProjectionView {
    Picture picture;
    Rect rect;
    Pose stage_from_view;
    Fov fov;  // upside down or mirrored views (up < down, right < left) are taken as they are
};
struct ProjectionLayer {
    std::array<ProjectionView, 2> views;  // by Side
    Blending blending;
    // By Side; replaces that part of the view, if a program drew one.
    std::array<std::optional<ProjectionView>, 2> insets{};
};

enum class Visibility { kBoth, kLeft, kRight };
struct QuadLayer {
    Picture picture;
    Rect rect;
    Pose stage_from_quad;  // its centre; visible only from its +z side
    glm::dvec2 size_m{0.0, 0.0};
    Visibility visibility = Visibility::kBoth;
    Blending blending;
};

// The inside of a cylinder about the y axis of its pose, with the middle of its picture at -z. With a radius
// of 0 or infinity it is infinitely far away.
struct CylinderLayer {
    Picture picture;
    Rect rect;
    Pose stage_from_cylinder;
    double radius_m = 0.0;
    double central_angle_rad = 0.0;
    double aspect_ratio = 1.0;  // of the picture: width on the arc to height
    Visibility visibility = Visibility::kBoth;
    Blending blending;
};

// The inside of a sphere, or of a piece of it between two latitudes and over a span of longitudes about -z.
// Radii as for cylinders.
struct SphereLayer {
    Picture picture;
    Rect rect;
    Pose stage_from_sphere;
    double radius_m = 0.0;
    double horizontal_angle_rad = 0.0;
    double upper_angle_rad = 0.0, lower_angle_rad = 0.0;
    Visibility visibility = Visibility::kBoth;
    Blending blending;
};

// A cube map infinitely far: faces +x, -x, +y, -y, +z, -z, laid out as Vulkan reads them.
struct CubeLayer {
    std::array<Picture, 6> faces;
    glm::dquat stage_from_cube{1.0, 0.0, 0.0, 0.0};
    Visibility visibility = Visibility::kBoth;
    Blending blending;
};

// The room, in every direction.
struct RoomLayer {
    glm::dvec3 light{0.0};  // linear
    double opacity = 1.0;
    Blending blending;
};

using Layer = std::variant<ProjectionLayer, QuadLayer, CylinderLayer, SphereLayer, CubeLayer, RoomLayer>;

// 8-bit sRGB, three bytes per pixel, rows from the top.
struct RgbPicture {
    glm::uvec2 size_px{0, 0};
    std::vector<std::uint8_t> bytes;
    bool operator==(const RgbPicture&) const = default;
};

struct EyeView {
    glm::uvec2 size_px{0, 0};
    Pose stage_from_eye;
    Fov fov;
};

// The room behind all layers, if the headset does not block it: light that is added, or that is seen as far
// as the layers' alpha lets it through.
struct Backdrop {
    glm::dvec3 light{0.0};  // linear
    bool adds = false;
};

// Layers in submission order over the backdrop. A projection layer is reprojected from its own view's
// orientation to the eye's, by directions; nothing is drawn where the view had no picture. An inset replaces
// that part of its eye's view, edges included; the two are blended as one picture. If a view has the eye's
// own pixels, and perhaps more around them, its sRGB picture is kept byte for byte.
[[nodiscard]] RgbPicture composeEye(const EyeView& eye, Side side, std::span<const Layer> layers,
                                    const Backdrop& backdrop = {});

// Left and right eye side by side, at the top of a picture as tall as the taller one.
[[nodiscard]] RgbPicture putSideBySide(const RgbPicture& left, const RgbPicture& right);

// IEC 61966-2-1, both for values from 0 to 1; decoding and encoding a byte gives the same byte.
[[nodiscard]] double decodeSrgb(double encoded);
[[nodiscard]] double encodeSrgb(double linear);

}  // namespace simulated
