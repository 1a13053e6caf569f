// Placement, light grids and colours of splats on patches. Patches are independent, and so are chunks of a
// patch's splats: threads take them in any order and write to places known beforehand, so the scene does not
// depend on the number of threads.
#include "engine/builtin/patch.h"

#include "engine/builtin/builtin.h"
#include "engine/builtin/gloss.h"
#include "engine/builtin/noise.h"
#include "engine/parallel.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace binosplat::builtin {

namespace {

// Sigma over spacing, by the number of splats across a patch. On a square grid with 0.66, 3 % of the
// background shines through the middle of four splats at opacity 0.96; smaller values show holes, larger ones
// blur. A narrow strip (a bar, a leaf) would look fatter than it is: one splat across of 0.45 falls to half
// its opacity at the strip's edges.
float sigmaPerSpacing(std::uint64_t splats_across) {
    return splats_across == 1 ? 0.45f : splats_across == 2 ? 0.56f : 0.66f;
}

struct Frame {
    glm::vec3 point, along_u, along_v, normal;  // along_*: derivatives by u and v
};

Frame frameAt(const Patch& patch, const glm::vec2& uv) {
    constexpr float kStep = 1e-3f;
    const auto derive = [&](const glm::vec2& axis) {
        const glm::vec2 before = glm::max(uv - kStep * axis, glm::vec2(0.0f)),
                        after = glm::min(uv + kStep * axis, glm::vec2(1.0f));
        return (patch.point(after) - patch.point(before)) / glm::dot(after - before, axis);
    };
    Frame frame{patch.point(uv), derive({1.0f, 0.0f}), derive({0.0f, 1.0f}), {}};
    const glm::vec3 normal = glm::cross(frame.along_u, frame.along_v);
    const float length = glm::length(normal);
    frame.normal = length > 1e-12f ? normal / length : glm::vec3(0.0f, -1.0f, 0.0f);
    if (patch.behind && glm::dot(frame.normal, frame.point - patch.behind(frame.point)) < 0.0f) {
        frame.normal = -frame.normal;
    }
    return frame;
}

// Light over a patch, sampled at cell centres and interpolated.
class LightGrid {
public:
    LightGrid() = default;
    LightGrid(const Patch& patch, const Room& room, const std::vector<Occluder>& occluders,
              std::uint64_t splats) {
        if (!patch.lit) { return; }
        // No finer than the splats, and no finer than the softest shadows need.
        const float spacing = std::sqrt(patch.size_m.x * patch.size_m.y / static_cast<float>(splats)),
                    cell = std::max(0.05f, spacing);
        const auto cells = [cell](float extent) {
            return std::clamp(static_cast<int>(std::lround(extent / cell)), 1, 96);
        };
        columns_ = cells(patch.size_m.x);
        rows_ = cells(patch.size_m.y);
        for (int row = 0; row < rows_; ++row) {
            for (int column = 0; column < columns_; ++column) {
                const glm::vec2 uv((static_cast<float>(column) + 0.5f) / static_cast<float>(columns_),
                                   (static_cast<float>(row) + 0.5f) / static_cast<float>(rows_));
                const Frame frame = frameAt(patch, uv);
                Light light = gatherLight(room, occluders, frame.point, frame.normal);
                if (patch.two_sided) {
                    const Light back = gatherLight(room, occluders, frame.point, -frame.normal);
                    light.diffuse = 0.5f * light.diffuse + 0.5f * back.diffuse;
                    light.sun = 0.6f * (light.sun + back.sun);
                }
                values_.push_back(light);
            }
        }
    }

    [[nodiscard]] Light at(const glm::vec2& uv) const {
        const glm::vec2 limit(static_cast<float>(columns_ - 1), static_cast<float>(rows_ - 1));
        const glm::vec2 place = glm::clamp(uv * (limit + 1.0f) - 0.5f, glm::vec2(0.0f), limit);
        const glm::vec2 cell = glm::floor(place), f = place - cell;
        const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y),
                  x1 = std::min(x + 1, columns_ - 1), y1 = std::min(y + 1, rows_ - 1);
        const auto value = [&](int column, int row) {
            return values_[static_cast<std::size_t>(row * columns_ + column)];
        };
        const Light a = value(x, y), b = value(x1, y), c = value(x, y1), d = value(x1, y1);
        return {glm::mix(glm::mix(a.diffuse, b.diffuse, f.x), glm::mix(c.diffuse, d.diffuse, f.x), f.y),
                glm::mix(glm::mix(a.sun, b.sun, f.x), glm::mix(c.sun, d.sun, f.x), f.y)};
    }

private:
    int columns_ = 0, rows_ = 0;
    std::vector<Light> values_;
};

// The rows of a patch that has `count` splats: `starts[r]` is the first splat of row r.
struct Rows {
    std::vector<std::uint64_t> starts;
};

Rows layOutRows(const Patch& patch, std::uint64_t count) {
    const double wanted = std::sqrt(static_cast<double>(count) * patch.size_m.y / patch.size_m.x);
    const auto rows =
        static_cast<std::size_t>(std::clamp<double>(std::round(wanted), 1.0, static_cast<double>(count)));
    std::vector<double> ends(rows);
    double sum = 0.0;
    for (std::size_t row = 0; row < rows; ++row) {
        const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(rows);
        for (const float u : {0.1f, 0.5f, 0.9f}) { sum += glm::length(frameAt(patch, {u, v}).along_u); }
        sum += 1e-6;
        ends[row] = sum;
    }
    Rows result{{0}};
    for (const double end : ends) {
        result.starts.push_back(
            static_cast<std::uint64_t>(std::llround(end / sum * static_cast<double>(count))));
    }
    return result;
}

glm::quat makeRotation(const Frame& frame, const glm::vec3& t_u, glm::vec3& t_v) {
    t_v = frame.along_v - glm::dot(frame.along_v, t_u) * t_u;
    const float length = glm::length(t_v);
    if (length > 1e-9f) {
        t_v /= length;
    } else {
        t_v = glm::normalize(glm::cross(
            std::abs(t_u.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f), t_u));
    }
    return glm::normalize(glm::quat_cast(glm::mat3(t_u, t_v, glm::cross(t_u, t_v))));
}

class PatchWriter {
public:
    PatchWriter(const Patch& patch, const Room& room, const LightGrid& grid, std::uint32_t seed,
                std::uint64_t count, int subsamples)
        : patch_(patch),
          room_(room),
          grid_(grid),
          rows_(layOutRows(patch, count)),
          seed_(seed),
          subsamples_(subsamples) {}

    void write(Scene& scene, std::uint64_t first, std::uint64_t begin, std::uint64_t end) const {
        auto row =
            static_cast<std::size_t>(std::upper_bound(rows_.starts.begin(), rows_.starts.end(), begin) -
                                     rows_.starts.begin()) -
            1;
        for (std::uint64_t i = begin; i < end; ++i) {
            while (i >= rows_.starts[row + 1]) { ++row; }
            writeSplat(scene, first + i, i, row);
        }
    }

private:
    void writeSplat(Scene& scene, std::uint64_t target, std::uint64_t i, std::size_t row) const {
        const glm::vec2 cell(1.0f / static_cast<float>(rows_.starts[row + 1] - rows_.starts[row]),
                             1.0f / static_cast<float>(rows_.starts.size() - 1));
        // Every other row is shifted by half a splat, and each splat a little by chance: even, but without a
        // visible grid.
        const std::uint32_t chance = hash(static_cast<std::uint32_t>(i), seed_);
        const glm::vec2 jitter(unitFloat(chance) - 0.5f, unitFloat(hash(chance)) - 0.5f);
        const glm::vec2 place(
            static_cast<float>(i - rows_.starts[row]) + 0.5f + (row % 2 == 0 ? 0.2f : -0.2f),
            static_cast<float>(row) + 0.5f);
        // The outermost splats move in by a sixteenth of a cell: half of a splat's opacity reaches 0.3 cells
        // past the edge otherwise.
        const glm::vec2 even = (place + 0.16f * jitter) * cell,
                        uv = glm::clamp(0.5f + (even - 0.5f) * (1.0f - 0.12f * cell), glm::vec2(0.0f),
                                        glm::vec2(1.0f));

        const Frame frame = frameAt(patch_, uv);
        const float length_u = glm::length(frame.along_u);
        const glm::vec3 t_u = length_u > 1e-9f ? frame.along_u / length_u : glm::vec3(1.0f, 0.0f, 0.0f);
        glm::vec3 t_v;
        scene.rotations[target] = makeRotation(frame, t_u, t_v);
        scene.positions[target] = frame.point;
        const glm::vec2 spacing = cell * glm::vec2(length_u, std::abs(glm::dot(frame.along_v, t_v)));
        const glm::vec2 per_spacing(sigmaPerSpacing(rows_.starts[row + 1] - rows_.starts[row]),
                                    sigmaPerSpacing(rows_.starts.size() - 1));
        scene.scales[target] = glm::max(per_spacing * spacing, glm::vec2(1e-5f));

        float opacity = 0.0f;
        const glm::vec3 colour = shade(frame, uv, cell, opacity);
        scene.opacities[target] = opacity;
        float* sh = scene.sh.data() + target * 48;
        const glm::vec3 constant = shFromColour(encode(colour));
        for (int channel = 0; channel < 3; ++channel) { sh[channel] = constant[channel]; }
        if (patch_.glossy) { addGloss(frame, sh); }
    }

    // The mean over the splat's cell, so that a texture finer than the splats turns into its average and not
    // into noise.
    glm::vec3 shade(const Frame& frame, const glm::vec2& uv, const glm::vec2& cell, float& opacity) const {
        const Light light = patch_.lit ? grid_.at(uv) : Light{};
        glm::vec3 sum(0.0f);
        for (int y = 0; y < subsamples_; ++y) {
            for (int x = 0; x < subsamples_; ++x) {
                const glm::vec2 offset = (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                                             static_cast<float>(subsamples_) -
                                         0.5f;
                const glm::vec2 step = glm::clamp(uv + offset * cell, glm::vec2(0.0f), glm::vec2(1.0f)) - uv;
                const glm::vec3 point = frame.point + step.x * frame.along_u + step.y * frame.along_v;
                const Material material = patch_.material(point, uv + step);
                glm::vec3 incident = light.diffuse;
                if (light.sun > 0.0f) {
                    incident += light.sun * sunThroughWindow(room_, point) * sunColour();
                }
                sum += material.emission + material.albedo * incident;
                opacity += material.opacity;
            }
        }
        const float share = 1.0f / static_cast<float>(subsamples_ * subsamples_);
        opacity *= share;
        return sum * share;
    }

    void addGloss(const Frame& frame, float* sh) const {
        const glm::vec3 window(0.5f * (room_.window_min + room_.window_max), room_.max.z);
        const std::array<glm::vec3, 16> gloss = projectGloss(frame.point, frame.normal, window, room_.lamp);
        for (int k = 0; k < 16; ++k) {
            for (int channel = 0; channel < 3; ++channel) {
                sh[3 * k + channel] += gloss[static_cast<std::size_t>(k)][channel];
            }
        }
    }

    const Patch& patch_;
    const Room& room_;
    const LightGrid& grid_;
    Rows rows_;
    std::uint32_t seed_;
    int subsamples_;
};

// Runs work(0 .. count - 1) on all cores; only the calling thread reports progress.
template <typename Work>
void forAll(std::size_t count, const Work& work, const Progress& progress, double from, double to) {
    const auto caller = std::this_thread::get_id();
    forBlocks(count, 1, static_cast<int>(std::thread::hardware_concurrency()),
              [&](std::size_t i, std::size_t end) {
                  work(i);
                  if (progress && std::this_thread::get_id() == caller) {
                      progress(from + (to - from) * static_cast<double>(end) / static_cast<double>(count));
                  }
              });
}

// True if a patch lies in a wall, floor or ceiling and faces out of the room: the back of a picture frame,
// the underside of a pot.
bool isHidden(const Patch& patch, const Room& room) {
    if (!patch.lit || patch.two_sided || !patch.behind) { return false; }
    const Frame frame = frameAt(patch, {0.5f, 0.5f});
    constexpr float kContact = 0.005f;
    for (int axis = 0; axis < 3; ++axis) {
        const bool beyond_max = frame.point[axis] > room.max[axis] - kContact && frame.normal[axis] > 0.9f;
        const bool beyond_min = frame.point[axis] < room.min[axis] + kContact && frame.normal[axis] < -0.9f;
        if (beyond_max || beyond_min) { return true; }
    }
    return false;
}

double weightOf(const Patch& patch, const Room& room) {
    return isHidden(patch, room) ? 0.0 : static_cast<double>(patch.size_m.x) * patch.size_m.y * patch.detail;
}

}  // namespace

Patch& Draft::add(Patch patch) {
    patches_.push_back(std::move(patch));
    return patches_.back();
}

Scene Draft::make(std::uint64_t count, const Room& room, const Progress& progress) const {
    // Patch i gets the splats between two rounded points of the running sum: exactly `count` in all, and
    // small patches get their share on average even where it is under one.
    std::vector<std::uint64_t> starts{0};
    double total = 0.0, running = 0.0;
    for (const Patch& patch : patches_) { total += weightOf(patch, room); }
    for (const Patch& patch : patches_) {
        running += weightOf(patch, room);
        starts.push_back(
            static_cast<std::uint64_t>(std::llround(running / total * static_cast<double>(count))));
    }
    starts.back() = count;

    std::vector<LightGrid> grids(patches_.size());
    forAll(
        patches_.size(),
        [&](std::size_t i) {
            if (starts[i + 1] > starts[i]) {
                grids[i] = LightGrid(patches_[i], room, occluders_, starts[i + 1] - starts[i]);
            }
        },
        progress, 0.0, 0.3);

    Scene scene;
    scene.sh_degree = 3;
    scene.positions.resize(count);
    scene.rotations.resize(count, glm::identity<glm::quat>());
    scene.scales.resize(count);
    scene.opacities.resize(count);
    scene.sh.resize(count * 48);
    const int subsamples = count <= 400'000 ? 4 : count <= 3'000'000 ? 3 : 2;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        const std::uint64_t splats = starts[i + 1] - starts[i];
        if (splats == 0) { continue; }
        const PatchWriter writer(patches_[i], room, grids[i], static_cast<std::uint32_t>(i), splats,
                                 subsamples);
        constexpr std::uint64_t kChunk = 16384;
        const auto write = [&](std::size_t chunk) {
            writer.write(scene, starts[i], chunk * kChunk,
                         std::min<std::uint64_t>(splats, (chunk + 1) * kChunk));
        };
        const auto share = [&](std::uint64_t done) {
            return 0.3 + 0.7 * static_cast<double>(done) / static_cast<double>(count);
        };
        if (splats <= kChunk) {
            write(0);
            if (progress && i % 16 == 0) { progress(share(starts[i + 1])); }
        } else {
            forAll((splats + kChunk - 1) / kChunk, write, progress, share(starts[i]), share(starts[i + 1]));
        }
    }
    if (progress) { progress(1.0); }
    return scene;
}

}  // namespace binosplat::builtin
