// The composition of layers: each pixel of an eye looks along its ray through all of them.
#include "xr/simulated/compose/compose.h"

#include "xr/simulated/compose/seen_shapes.h"
#include "xr/simulated/compose/texels.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace simulated {

namespace {

// The tangents of a view's edges; u grows to the right and v downwards, both 0 to 1.
struct Tangents {
    double left, right, up, down;
    explicit Tangents(const Fov& fov)
        : left(std::tan(fov.left_rad)),
          right(std::tan(fov.right_rad)),
          up(std::tan(fov.up_rad)),
          down(std::tan(fov.down_rad)) {}

    [[nodiscard]] glm::dvec3 direction(const glm::dvec2& uv) const {
        return {left + (right - left) * uv.x, up + (down - up) * uv.y, -1.0};
    }
    // Where a direction meets the view; none behind it.
    [[nodiscard]] std::optional<glm::dvec2> uvOf(const glm::dvec3& direction) const {
        if (!(direction.z < 0.0)) { return std::nullopt; }
        const glm::dvec2 tangent = glm::dvec2(direction) / -direction.z;
        return glm::dvec2((tangent.x - left) / (right - left), (tangent.y - up) / (down - up));
    }
};

glm::dvec2 pixelCentre(const glm::uvec2& size_px, std::uint32_t x, std::uint32_t y) {
    return glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(size_px);
}

// An empty rectangle shows nothing.
bool isEmpty(const Rect& rect) { return rect.extent.x == 0 || rect.extent.y == 0; }

// A layer as one eye sees it: linear light and alpha where a pixel's ray meets it.
class SeenView {
public:
    SeenView(const EyeView& eye, const ProjectionView& view)
        : sampler_(view.picture, view.rect),
          tangents_(view.fov),
          view_from_eye_(glm::mat3_cast(glm::conjugate(view.stage_from_view.orientation) *
                                        eye.stage_from_eye.orientation)) {
        shift_px_ = findShift(eye, view.rect.extent);
    }

    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t x, std::uint32_t y,
                                               const glm::dvec3& direction_eye) const {
        if (shift_px_) { return sampler_.texel(x + shift_px_->x, y + shift_px_->y); }
        const std::optional<glm::dvec2> uv = tangents_.uvOf(view_from_eye_ * direction_eye);
        return uv ? sampler_.sampleInside(uv->x, uv->y) : std::nullopt;
    }

private:
    // If the view has all pixels of the eye: the place of the first. Poses and angles went to the application
    // and came back in single precision, so that corners may be off by 0.02 pixels.
    [[nodiscard]] std::optional<glm::uvec2> findShift(const EyeView& eye, const glm::uvec2& extent) const {
        constexpr double kSameGrid_px = 0.02;
        const Tangents eye_tangents(eye.fov);
        const auto placeOf = [&](const glm::dvec2& corner) {
            const std::optional<glm::dvec2> uv =
                tangents_.uvOf(view_from_eye_ * eye_tangents.direction(corner));
            return uv ? *uv * glm::dvec2(extent) : glm::dvec2(-1.0);
        };
        const glm::dvec2 first = glm::round(placeOf({0.0, 0.0})), last = first + glm::dvec2(eye.size_px);
        if (glm::any(glm::lessThan(first, glm::dvec2(0.0))) ||
            glm::any(glm::greaterThan(last, glm::dvec2(extent)))) {
            return {};
        }
        for (const glm::dvec2 corner :
             {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
            const glm::dvec2 moved_px = placeOf(corner) - (first + corner * glm::dvec2(eye.size_px));
            if (!(glm::length(moved_px) < kSameGrid_px)) { return {}; }
        }
        return glm::uvec2(first);
    }

    Sampler sampler_;
    Tangents tangents_;
    glm::dmat3 view_from_eye_;
    std::optional<glm::uvec2> shift_px_;
};

// An eye's view with the inset in it, if there is one.
class SeenProjection {
public:
    SeenProjection(const EyeView& eye, const ProjectionLayer& layer, Side side) {
        if (const auto& inset = layer.insets[side]; inset && !isEmpty(inset->rect)) {
            views_.emplace_back(eye, *inset);
        }
        if (!isEmpty(layer.views[side].rect)) { views_.emplace_back(eye, layer.views[side]); }
    }

    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t x, std::uint32_t y,
                                               const glm::dvec3& direction_eye) const {
        std::optional<glm::dvec4> texel;
        for (const SeenView& view : views_) {
            if (!texel) { texel = view.at(x, y, direction_eye); }
        }
        return texel;
    }

private:
    std::vector<SeenView> views_;  // the first that shows something counts
};

class SeenQuad {
public:
    SeenQuad(const EyeView& eye, const QuadLayer& quad)
        : sampler_(quad.picture, quad.rect), rays_(eye, quad.stage_from_quad), size_m_(quad.size_m) {}

    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t, std::uint32_t,
                                               const glm::dvec3& direction_eye) const {
        const glm::dvec3 direction = rays_.layer_from_eye * direction_eye;
        // From the front only, and only ahead: the eye is on the +z side and looks towards -z.
        if (!(rays_.eye.z > 0.0) || !(direction.z < 0.0)) { return std::nullopt; }
        if (size_m_.x <= 0.0 || size_m_.y <= 0.0) { return std::nullopt; }
        const glm::dvec3 hit = rays_.eye - direction * (rays_.eye.z / direction.z);
        return sampler_.sampleInside(hit.x / size_m_.x + 0.5, 0.5 - hit.y / size_m_.y);
    }

private:
    Sampler sampler_;
    LayerRays rays_;
    glm::dvec2 size_m_;
};

class SeenRoom {
public:
    explicit SeenRoom(const RoomLayer& layer) : texel_(layer.opacity * layer.light, layer.opacity) {}
    [[nodiscard]] std::optional<glm::dvec4> at(std::uint32_t, std::uint32_t, const glm::dvec3&) const {
        return texel_;
    }

private:
    glm::dvec4 texel_;
};

struct SeenLayer {
    std::variant<SeenProjection, SeenQuad, SeenCylinder, SeenSphere, SeenCube, SeenRoom> shape;
    Blending blending;
};

bool isShownTo(Side side, Visibility visibility) {
    return visibility == Visibility::kBoth || (visibility == Visibility::kLeft) == (side == kLeft);
}

std::vector<SeenLayer> listSeen(const EyeView& eye, Side side, std::span<const Layer> layers) {
    std::vector<SeenLayer> seen;
    for (const Layer& layer : layers) {
        if (const auto* projection = std::get_if<ProjectionLayer>(&layer)) {
            seen.push_back({SeenProjection(eye, *projection, side), projection->blending});
        } else if (const auto* quad = std::get_if<QuadLayer>(&layer)) {
            if (isShownTo(side, quad->visibility) && !isEmpty(quad->rect)) {
                seen.push_back({SeenQuad(eye, *quad), quad->blending});
            }
        } else if (const auto* cylinder = std::get_if<CylinderLayer>(&layer)) {
            if (isShownTo(side, cylinder->visibility) && !isEmpty(cylinder->rect)) {
                seen.push_back({SeenCylinder(eye, *cylinder), cylinder->blending});
            }
        } else if (const auto* sphere = std::get_if<SphereLayer>(&layer)) {
            if (isShownTo(side, sphere->visibility) && !isEmpty(sphere->rect)) {
                seen.push_back({SeenSphere(eye, *sphere), sphere->blending});
            }
        } else if (const auto* room = std::get_if<RoomLayer>(&layer)) {
            seen.push_back({SeenRoom(*room), room->blending});
        } else if (const auto& cube = std::get<CubeLayer>(layer); isShownTo(side, cube.visibility)) {
            seen.push_back({SeenCube(eye, cube), cube.blending});
        }
    }
    return seen;
}

// Returns light and alpha.
glm::dvec4 blend(const glm::dvec4& below, const glm::dvec4& texel, const Blending& blending) {
    if (!blending.texture_source_alpha) { return {glm::dvec3(texel), 1.0}; }
    const double alpha = std::clamp(texel.a, 0.0, 1.0);
    const glm::dvec3 premultiplied =
        blending.unpremultiplied_alpha ? glm::dvec3(texel) * alpha : glm::dvec3(texel);
    return glm::dvec4(premultiplied, alpha) + below * (1.0 - alpha);
}

}  // namespace

RgbPicture composeEye(const EyeView& eye, Side side, std::span<const Layer> layers,
                      const Backdrop& backdrop) {
    const std::vector<SeenLayer> seen = listSeen(eye, side, layers);
    const Tangents tangents(eye.fov);
    RgbPicture picture{eye.size_px, {}};
    picture.bytes.reserve(std::size_t{3} * eye.size_px.x * eye.size_px.y);
    for (std::uint32_t y = 0; y < eye.size_px.y; ++y) {
        for (std::uint32_t x = 0; x < eye.size_px.x; ++x) {
            const glm::dvec3 direction_eye = tangents.direction(pixelCentre(eye.size_px, x, y));
            glm::dvec4 light(0.0);
            for (const SeenLayer& layer : seen) {
                const auto texel =
                    std::visit([&](const auto& shape) { return shape.at(x, y, direction_eye); }, layer.shape);
                if (texel) { light = blend(light, *texel, layer.blending); }
            }
            light += glm::dvec4((backdrop.adds ? 1.0 : 1.0 - light.a) * backdrop.light, 0.0);
            for (const double value : {light.r, light.g, light.b}) {
                picture.bytes.push_back(srgbByte(value));
            }
        }
    }
    return picture;
}

RgbPicture putSideBySide(const RgbPicture& left, const RgbPicture& right) {
    RgbPicture both{{left.size_px.x + right.size_px.x, std::max(left.size_px.y, right.size_px.y)}, {}};
    both.bytes.resize(std::size_t{3} * both.size_px.x * both.size_px.y);
    std::size_t first_column = 0;
    for (const RgbPicture* picture : {&left, &right}) {
        const std::size_t row_bytes = std::size_t{3} * picture->size_px.x;
        for (std::size_t y = 0; y < picture->size_px.y; ++y) {
            std::copy_n(picture->bytes.data() + y * row_bytes, row_bytes,
                        both.bytes.data() + 3 * (y * both.size_px.x + first_column));
        }
        first_column += picture->size_px.x;
    }
    return both;
}

}  // namespace simulated
