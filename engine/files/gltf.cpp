// From the columns of a glTF to stored attributes, placed by each node.
#include "engine/files/gltf.h"

#include "engine/error.h"
#include "engine/files/gltf_document.h"
#include "engine/files/json_node.h"
#include "engine/files/quantized.h"
#include "engine/files/scene_builder.h"
#include "engine/scene/floor_plane.h"
#include "engine/scene/placed_splat.h"
#include "engine/scene/sh_turn.h"
#include "engine/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

namespace binosplat {

namespace {

// Instances aside, a splat takes at least 44 bytes; a small file with more splats than that is meant to fill
// the memory.
constexpr std::uint64_t kMostSplatsPerByte = 256;

// Scales are lengths. Drafts of the extension up to 2026 had logarithms: some of these are negative in any
// scene, lengths never are.
bool holdsLogarithms(const GltfDocument& document) {
    std::vector<float> scales;
    for (const GltfSplats& part : document.parts) {
        for (std::uint64_t first = 0; first < part.count(); first += StoredBlock::kRows) {
            part.scale.read(
                first,
                static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, part.count() - first)),
                scales);
            if (std::ranges::any_of(scales, [](float scale) { return scale < 0.0f; })) { return true; }
        }
    }
    return false;
}

// Of positions that nodes move, in float64: positions that are themselves far from 0 have lost their detail
// already.
glm::dvec3 findOrigin(const GltfDocument& document) {
    constexpr std::size_t kMostSamples = 4096;
    double all = 0.0;
    for (const GltfSplats& part : document.parts) { all += static_cast<double>(part.count()); }
    std::array<std::vector<double>, 3> places, moves;
    std::vector<float> values;
    for (const GltfSplats& part : document.parts) {
        // Weighted, so that small parts far away do not shift the rest.
        const double share = static_cast<double>(part.count()) / std::max(all, 1.0);
        const auto rows = std::min(static_cast<std::size_t>(part.count()),
                                   static_cast<std::size_t>(std::ceil(share * kMostSamples)));
        part.position.read(0, rows, values);
        for (std::size_t row = 0; row < rows; ++row) {
            const glm::dvec4 place = part.world_from_node * glm::dvec4(values[3 * row], values[3 * row + 1],
                                                                       values[3 * row + 2], 1.0);
            for (int axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(place[axis])) { continue; }
                places[static_cast<std::size_t>(axis)].push_back(place[axis]);
                moves[static_cast<std::size_t>(axis)].push_back(part.world_from_node[3][axis]);
            }
        }
    }
    glm::dvec3 origin(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>&place = places[static_cast<std::size_t>(axis)],
        &move = moves[static_cast<std::size_t>(axis)];
        if (!place.empty() && originAbout(findQuantile(move, 0.5)) != 0.0) {
            origin[axis] = originAbout(findQuantile(place, 0.5));
        }
    }
    return origin;
}

// Fills blocks with a part's splats in world axes.
class PartReader {
    using Curve = double (*)(double);

public:
    PartReader(const GltfSplats& part, bool logarithms, const GltfDocument& document,
               const glm::dvec3& origin)
        : part_(part),
          origin_(origin),
          logarithms_(logarithms),
          sh_degree_(document.sh_degree),
          linear_(part.world_from_node),
          is_rigid_(linear_ == glm::dmat3(1.0)),
          is_similarity_(isSimilarity(linear_)),
          turn_(nearestRotation(linear_)),
          harmonics_(turn_) {
        // A mirrored ellipsoid equals the one that is turned by the opposite matrix: its axes have no sign.
        const double sign = glm::determinant(turn_) < 0.0 ? -1.0 : 1.0;
        turned_ = glm::quat_cast(sign * turn_);
        scale_ = std::cbrt(std::abs(glm::determinant(linear_)));
        if (part.is_linear != document.is_linear) {
            convert_ = part.is_linear ? static_cast<Curve>(encodedOf) : static_cast<Curve>(lightOf);
        }
    }

    void read(std::uint64_t first, StoredBlock& block) {
        readPlaces(first, block);
        readShapes(first, block);
        readColours(first, block);
        if (convert_ != nullptr) { convertColours(block); }
    }

private:
    void readPlaces(std::uint64_t first, StoredBlock& block) {
        part_.position.read(first, block.rows, values_);
        for (std::size_t row = 0; row < block.rows; ++row) {
            const glm::dvec4 in_node(values_[3 * row], values_[3 * row + 1], values_[3 * row + 2], 1.0);
            const glm::dvec3 position = glm::dvec3(part_.world_from_node * in_node) - origin_;
            for (int axis = 0; axis < 3; ++axis) {
                block.put(kStoredX + axis, row, static_cast<float>(position[axis]));
            }
        }
        part_.opacity.read(first, block.rows, values_);
        for (std::size_t row = 0; row < block.rows; ++row) {
            block.put(kStoredOpacity, row, storedOpacity(values_[row]));
        }
    }

    void readShapes(std::uint64_t first, StoredBlock& block) {
        part_.rotation.read(first, block.rows, values_);
        part_.scale.read(first, block.rows, scales_);
        for (std::size_t row = 0; row < block.rows; ++row) {
            glm::dquat rotation{};
            rotation.x = values_[4 * row], rotation.y = values_[4 * row + 1],
            rotation.z = values_[4 * row + 2], rotation.w = values_[4 * row + 3];
            std::array<float, 3> logs{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                logs[axis] = logarithms_ ? scales_[3 * row + axis] : storedScale(scales_[3 * row + axis]);
            }
            if (is_similarity_ && !is_rigid_) {
                rotation = turned_ * rotation;
                for (float& log : logs) { log += static_cast<float>(std::log(scale_)); }
            } else if (!is_similarity_ && glm::length(rotation) > 0.0) {
                const Ellipsoid placed = place(
                    linear_, {glm::normalize(rotation), glm::exp(glm::dvec3(logs[0], logs[1], logs[2]))});
                rotation = placed.rotation;
                for (int axis = 0; axis < 3; ++axis) {
                    logs[static_cast<std::size_t>(axis)] =
                        storedScale(static_cast<float>(placed.scales[axis]));
                }
            }
            for (int axis = 0; axis < 3; ++axis) {
                block.put(kStoredScale0 + axis, row, logs[static_cast<std::size_t>(axis)]);
            }
            block.put(kStoredRot0, row, static_cast<float>(rotation.w));
            block.put(kStoredRot1, row, static_cast<float>(rotation.x));
            block.put(kStoredRot2, row, static_cast<float>(rotation.y));
            block.put(kStoredRot3, row, static_cast<float>(rotation.z));
        }
    }

    void readColours(std::uint64_t first, StoredBlock& block) {
        const std::size_t per_channel = static_cast<std::size_t>(shCoefficientCount(sh_degree_)) - 1;
        for (std::size_t row = 0; row < block.rows; ++row) {
            std::fill_n(block.rest(row), 3 * per_channel, 0.0f);
        }
        if (part_.colour) {
            part_.colour->read(first, block.rows, values_);
            const auto width = static_cast<std::size_t>(part_.colour->components());
            for (std::size_t row = 0; row < block.rows; ++row) {
                for (int channel = 0; channel < 3; ++channel) {
                    // Without the 0.5 that is added to a displayed colour, as the extension defines it.
                    block.put(kStoredDc0 + channel, row,
                              values_[width * row + static_cast<std::size_t>(channel)] / kShConstant);
                }
            }
            return;
        }
        for (std::size_t k = 0; k < part_.sh.size(); ++k) {
            part_.sh[k].read(first, block.rows, values_);
            for (std::size_t row = 0; row < block.rows; ++row) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    const float value = values_[3 * row + channel];
                    if (k == 0) {
                        block.column(kStoredDc0 + static_cast<int>(channel))[row] = value;
                    } else {
                        block.rest(row)[channel * per_channel + k - 1] = value;
                    }
                }
            }
        }
        if (is_rigid_ || part_.sh.size() <= 1) { return; }
        const int degree = part_.sh.size() > 9 ? 3 : part_.sh.size() > 4 ? 2 : 1;
        for (std::size_t row = 0; row < block.rows; ++row) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                harmonics_.apply(block.rest(row) + channel * per_channel, degree);
            }
        }
    }

    // The constant colour is exact; what depends on direction uses the curve's mean slope over its usual
    // range.
    void convertColours(StoredBlock& block) const {
        const std::size_t per_channel = static_cast<std::size_t>(shCoefficientCount(sh_degree_)) - 1;
        for (std::size_t row = 0; row < block.rows; ++row) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                float& constant = block.column(kStoredDc0 + static_cast<int>(channel))[row];
                const std::span<float> rest(block.rest(row) + channel * per_channel, per_channel);
                double squares = 0.0;
                for (const float value : rest) {
                    squares += static_cast<double>(value) * static_cast<double>(value);
                }
                // The basis is orthonormal on the sphere, so this is the root mean square over all
                // directions.
                const double range = std::max(std::sqrt(squares / (4.0 * std::numbers::pi)), 1e-3);
                const double colour = 0.5 + static_cast<double>(kShConstant) * static_cast<double>(constant);
                const double slope = (convert_(colour + range) - convert_(colour - range)) / (2.0 * range);
                constant = storedColour(static_cast<float>(convert_(colour)));
                for (float& value : rest) { value *= static_cast<float>(slope); }
            }
        }
    }

    const GltfSplats& part_;
    glm::dvec3 origin_;
    bool logarithms_;
    int sh_degree_;
    glm::dmat3 linear_;
    bool is_rigid_, is_similarity_;  // rigid: only moved
    glm::dmat3 turn_;
    glm::dquat turned_{};
    double scale_ = 1.0;
    Curve convert_ = nullptr;  // for a colour's channel; null: it stays as it is
    ShTurn harmonics_;
    std::vector<float> values_, scales_;
};

}  // namespace

bool isGltf(InputFile& file) {
    const std::string_view start = file.peek(std::size_t{1} << 16);
    if (start.starts_with("glTF")) { return true; }
    // A tileset of 3D Tiles has an asset, too.
    if (!startsObject(start) || start.find("\"geometricError\"") != std::string_view::npos) { return false; }
    // Any of them may come first, and may be longer than this.
    constexpr std::string_view kKeys[] = {"\"asset\"", "\"accessors\"", "\"bufferViews\"",
                                          "\"extensionsUsed\"", "\"meshes\""};
    return std::ranges::any_of(
        kKeys, [&](std::string_view key) { return start.find(key) != std::string_view::npos; });
}

glm::dvec3 originOfGltf(InputFile& file) { return findOrigin(openGltf(file)); }

Scene readGltf(InputFile& file, LoadNotes& notes, const Progress& progress) {
    if (progress) { progress(0.0); }
    const GltfDocument document = openGltf(file);
    std::uint64_t total = 0;
    for (const GltfSplats& part : document.parts) {
        total += part.count();
        check(total <= kMostSplatsPerByte * document.bytes,
              "{}: places {} or more splats, expected at most {} for each of its {} bytes", file.name(),
              total, kMostSplatsPerByte, document.bytes);
    }
    const bool logarithms = holdsLogarithms(document);
    const glm::dvec3 origin = findOrigin(document);
    bool sheared = false;
    SceneBuilder builder(file.name(), total, document.sh_degree, true);
    StoredBlock block;
    std::uint64_t done = 0, blocks = 0;
    for (const GltfSplats& part : document.parts) {
        PartReader reader(part, logarithms, document, origin);
        sheared = sheared || !isSimilarity(glm::dmat3(part.world_from_node));
        for (std::uint64_t first = 0; first < part.count(); first += block.rows) {
            if (progress && blocks++ % 128 == 0) {
                progress(static_cast<double>(done) / static_cast<double>(total));
            }
            block.rows =
                static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, part.count() - first));
            reader.read(first, block);
            builder.append(block);
            done += block.rows;
        }
    }
    for (const GltfBuffer& buffer : document.buffers) { buffer.requireUnchanged(); }
    if (progress) { progress(1.0); }
    Scene scene = builder.finish(notes);
    setOrigin(scene, origin, notes);
    scene.y_up = true;
    scene.vertical_axis = 1;
    notes.axes = "x left, y up, z front; right-handed (glTF's own)";
    notes.colour_space = document.is_linear ? "lin_rec709_display (named by the file)"
                                            : "srgb_rec709_display (named by the file)";
    scene.by_distance = document.by_distance;
    scene.is_linear = document.is_linear;
    notes.lines.insert(notes.lines.end(), document.notes.begin(), document.notes.end());
    if (scene.is_linear) {
        notes.lines.push_back(fmt::format(
            "{}: colours of linear light (lin_rec709_display), encoded for the display once they are blended",
            file.name()));
    }
    if (logarithms) {
        notes.lines.push_back(
            fmt::format("{}: some scales are negative: all were read as logarithms, as early drafts of "
                        "KHR_gaussian_splatting have them",
                        file.name()));
    }
    if (sheared) {
        notes.lines.push_back(
            fmt::format("{}: a node stretches its splats unevenly; the harmonics of their colours are "
                        "turned, not stretched",
                        file.name()));
    }
    return scene;
}

}  // namespace binosplat
