// A single resampling with linear filters in both directions.
#include "engine/picture/turned.h"

#include "engine/parallel.h"

#include <algorithm>
#include <cmath>

namespace binosplat {
namespace {

// The display's transfer curve, also beyond white.
float decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}
float encode(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

// Colours of a picture with three channels and alpha.
std::vector<glm::vec4> linearOf(const Image& picture) {
    std::vector<glm::vec4> pixels(picture.pixelCount());
    forBlocks(pixels.size(), 1 << 14, static_cast<int>(std::thread::hardware_concurrency()),
              [&](std::size_t begin, std::size_t end) {
                  for (std::size_t i = begin; i < end; ++i) {
                      const float* p = &picture.values[4 * i];
                      pixels[i] = {decode(p[0]), decode(p[1]), decode(p[2]), p[3]};
                  }
              });
    return pixels;
}

// A place that differs from a pixel's middle only by rounding counts as the middle.
glm::dvec2 settled(const glm::dvec2& place) {
    const glm::dvec2 whole = glm::round(place);
    return {std::abs(place.x - whole.x) < 1e-6 ? whole.x : place.x,
            std::abs(place.y - whole.y) < 1e-6 ? whole.y : place.y};
}

}  // namespace

Image showTurned(const Image& picture, const Eye& eye, const Eye& view) {
    if (eye.world_from_camera.orientation == view.world_from_camera.orientation &&
        eye.size_px == view.size_px) {
        return picture;
    }
    const std::vector<glm::vec4> pixels = linearOf(picture);
    const glm::dquat eye_from_view =
        glm::conjugate(eye.world_from_camera.orientation) * view.world_from_camera.orientation;
    const Intrinsics &k = eye.intrinsics, &l = view.intrinsics;
    const glm::dvec2 last = glm::dvec2(eye.size_px) - 1.0;
    const auto pixelAt = [&](const glm::dvec2& at) {
        return pixels[static_cast<std::size_t>(at.y) * eye.size_px.x + static_cast<std::size_t>(at.x)];
    };
    Image shown{view.size_px, 4, std::vector<float>(4 * std::size_t{view.size_px.x} * view.size_px.y)};
    forBlocks(view.size_px.y, 16, static_cast<int>(std::thread::hardware_concurrency()),
              [&](std::size_t begin, std::size_t end) {
                  for (std::size_t y = begin; y < end; ++y) {
                      for (std::size_t x = 0; x < view.size_px.x; ++x) {
                          const glm::dvec3 ray =
                              eye_from_view * glm::dvec3((static_cast<double>(x) + 0.5 - l.cx) / l.fx,
                                                         (static_cast<double>(y) + 0.5 - l.cy) / l.fy, 1.0);
                          const glm::dvec2 wanted(k.fx * ray.x / ray.z + k.cx - 0.5,
                                                  k.fy * ray.y / ray.z + k.cy - 0.5);
                          const glm::dvec2 place = glm::clamp(settled(wanted), glm::dvec2(0.0), last),
                                           low = glm::floor(place);
                          const glm::dvec2 high = glm::min(low + 1.0, last);
                          const glm::vec2 share(place - low);
                          glm::vec4 colour =
                              glm::mix(glm::mix(pixelAt(low), pixelAt({high.x, low.y}), share.x),
                                       glm::mix(pixelAt({low.x, high.y}), pixelAt(high), share.x), share.y);
                          float* out = &shown.values[4 * (y * view.size_px.x + x)];
                          for (int c = 0; c < 3; ++c) { out[c] = encode(colour[c]); }
                          out[3] = colour.a;
                      }
                  }
              });
    return shown;
}

}  // namespace binosplat
