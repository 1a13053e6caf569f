// Resampling flat pictures to a grid of equal angles.
#include "app/scores/lens_view.h"

#include "engine/error.h"
#include "shaders/shared/types.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace binosplat {
namespace {

constexpr unsigned kPlaces = 4;  // along each side of a pixel
constexpr float kBehind = std::numeric_limits<float>::quiet_NaN();

glm::dmat3 worldFrom(const Eye& eye) { return glm::mat3_cast(eye.world_from_camera.orientation); }

// Looking along the mean of the lenses' axes, level with both eyes.
glm::dmat3 worldFromGrid(const std::array<Eye, 2>& eyes, const std::array<glm::dvec3, 2>& lens_centres) {
    glm::dvec3 forward(0.0), right(0.0);
    for (std::size_t side = 0; side < 2; ++side) {
        forward += worldFrom(eyes[side]) * glm::normalize(lens_centres[side]);
        right += worldFrom(eyes[side])[0];
    }
    check(glm::length(forward) > 1e-3, "the lenses look in opposite directions, must have a middle");
    forward = glm::normalize(forward);
    right -= glm::dot(right, forward) * forward;
    check(glm::length(right) > 1e-3, "the eyes are turned against each other, must be level");
    right = glm::normalize(right);
    return {right, glm::cross(forward, right), forward};
}

// How many pixels of a flat picture a radian has there, as the mean of both directions.
double densityAt(const Intrinsics& lens, const glm::dvec3& direction) {
    const double cosine = glm::normalize(direction).z;
    return std::sqrt(lens.fx * lens.fy / (cosine * cosine * cosine));
}

glm::dvec2 placeOf(const Intrinsics& lens, const glm::dvec3& direction) {
    return {lens.fx * direction.x / direction.z + lens.cx, lens.fy * direction.y / direction.z + lens.cy};
}

}  // namespace

LensView::LensView(const std::array<Eye, 2>& eyes, const std::array<glm::dvec3, 2>& lens_centres) {
    const glm::dmat3 world_from_grid = worldFromGrid(eyes, lens_centres);
    double density = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
        views_[side].eye_from_grid = glm::transpose(worldFrom(eyes[side])) * world_from_grid;
        views_[side].size_px = eyes[side].size_px;
        density = std::max(density, densityAt(eyes[side].intrinsics, lens_centres[side]));
    }
    pixel_rad_ = 1.0 / density;
    coverPictures(eyes);
    for (const int side : {kLeft, kRight}) { lookUp(eyes[static_cast<std::size_t>(side)], side); }
}

// The grid has as many tiles on each side of its middle as the farthest points of the pictures' borders need.
void LensView::coverPictures(const std::array<Eye, 2>& eyes) {
    glm::dvec2 least(0.0), most(0.0);
    for (std::size_t side = 0; side < 2; ++side) {
        const glm::dmat3 grid_from_eye = glm::transpose(views_[side].eye_from_grid);
        const Intrinsics& lens = eyes[side].intrinsics;
        const auto reach = [&](double x, double y) {
            const glm::dvec3 direction =
                grid_from_eye * glm::dvec3((x - lens.cx) / lens.fx, (y - lens.cy) / lens.fy, 1.0);
            const double across = std::hypot(direction.x, direction.y);
            const double angle_px = std::atan2(across, direction.z) / pixel_rad_;
            const glm::dvec2 place =
                across > 0.0 ? angle_px / across * glm::dvec2(direction) : glm::dvec2(0.0);
            least = glm::min(least, place);
            most = glm::max(most, place);
        };
        const glm::uvec2 size = eyes[side].size_px;
        for (unsigned x = 0; x <= size.x; ++x) { reach(x, 0.0), reach(x, size.y); }
        for (unsigned y = 0; y <= size.y; ++y) { reach(0.0, y), reach(size.x, y); }
    }
    constexpr auto tile = static_cast<double>(gpu::kTileSize);
    const glm::uvec2 before(glm::ceil(-least / tile)), behind(glm::ceil(most / tile));
    size_px_ = gpu::kTileSize * (before + behind);
    middle_px_ = tile * glm::dvec2(before);
}

glm::dvec3 LensView::directionAt(const glm::dvec2& place_px, int side) const {
    const glm::dvec2 from_middle = place_px - middle_px_;
    const double distance = glm::length(from_middle), angle = distance * pixel_rad_;
    const double across = distance > 0.0 ? std::sin(angle) / distance : 0.0;
    return views_[static_cast<std::size_t>(side)].eye_from_grid *
           glm::dvec3(across * from_middle, std::cos(angle));
}

double LensView::solidAngleAt(const glm::dvec2& place_px) const {
    const double angle = glm::length(place_px - middle_px_) * pixel_rad_;
    return pixel_rad_ * pixel_rad_ * (angle > 0.0 ? std::sin(angle) / angle : 1.0);
}

void LensView::lookUp(const Eye& eye, int side) {
    View& view = views_[static_cast<std::size_t>(side)];
    const std::size_t row = size_px_.x + 1;
    for (unsigned y = 0; y <= size_px_.y; ++y) {
        for (unsigned x = 0; x <= size_px_.x; ++x) {
            const glm::dvec3 direction = directionAt({x, y}, side);
            view.corners_px.emplace_back(direction.z > 0.0 ? glm::vec2(placeOf(eye.intrinsics, direction))
                                                           : glm::vec2(kBehind));
        }
    }
    const unsigned row_tiles = (view.size_px.x + gpu::kTileSize - 1) / gpu::kTileSize;
    const auto isInside = [&](const glm::vec2& place) {  // false behind the eye
        return place.x >= 0.0f && place.y >= 0.0f && place.x <= static_cast<float>(view.size_px.x) &&
               place.y <= static_cast<float>(view.size_px.y);
    };
    for (unsigned y = 0; y < size_px_.y; ++y) {
        for (unsigned x = 0; x < size_px_.x; ++x) {
            const glm::vec2* first = &view.corners_px[y * row + x];
            if (!isInside(first[0]) || !isInside(first[1]) || !isInside(first[row]) ||
                !isInside(first[row + 1])) {
                view.tiles.push_back(kNowhere);
                continue;
            }
            const glm::uvec2 centre((first[0] + first[1] + first[row] + first[row + 1]) / 4.0f);
            const glm::uvec2 tile = glm::min(centre, view.size_px - 1u) / gpu::kTileSize;
            view.tiles.push_back(tile.y * row_tiles + tile.x);
        }
    }
}

Image LensView::show(const Image& picture, int side) const {
    const View& view = views_[static_cast<std::size_t>(side)];
    check(picture.size_px == view.size_px && picture.channels >= 3,
          "a picture of {}x{} is not what the lens shows, must be {}x{}", picture.size_px.x,
          picture.size_px.y, view.size_px.x, view.size_px.y);
    Image shown{size_px_, 3, std::vector<float>(3 * view.tiles.size(), 0.0f)};
    const std::size_t row = size_px_.x + 1, channels = static_cast<std::size_t>(picture.channels);
    for (std::size_t pixel = 0; pixel < view.tiles.size(); ++pixel) {
        if (view.tiles[pixel] == kNowhere) { continue; }
        const glm::vec2* first = &view.corners_px[pixel / size_px_.x * row + pixel % size_px_.x];
        glm::vec3 sum(0.0f);
        for (unsigned place = 0; place < kPlaces * kPlaces; ++place) {
            const float right = (static_cast<float>(place % kPlaces) + 0.5f) / kPlaces,
                        down = (static_cast<float>(place / kPlaces) + 0.5f) / kPlaces;
            const glm::vec2 at_px = glm::mix(glm::mix(first[0], first[1], right),
                                             glm::mix(first[row], first[row + 1], right), down);
            const glm::uvec2 at = glm::min(glm::uvec2(at_px), view.size_px - 1u);
            const float* rgb = &picture.values[(std::size_t{at.y} * view.size_px.x + at.x) * channels];
            sum += glm::vec3(rgb[0], rgb[1], rgb[2]);
        }
        for (int c = 0; c < 3; ++c) {
            shown.values[3 * pixel + static_cast<std::size_t>(c)] = sum[c] / (kPlaces * kPlaces);
        }
    }
    return shown;
}

}  // namespace binosplat
