// Facts about the passes over splats, cull to project, each started from what the twin's pass before it left.
#include "engine/passes/sort.h"
#include "tests/engine/passes/pass_stages.h"

#include <doctest/doctest.h>

#include <limits>
#include <map>
#include <optional>

TEST_SUITE_BEGIN("passes");

namespace passes_test {

using namespace binosplat;
using test::Gpu;
using test::SceneOnDevice;
using test::TwinStages;
using test::ViewedScene;

namespace {

constexpr std::size_t kGroupWords = gpu::kCullBlock / 32;
constexpr double kEpsilon = 0x1p-24;  // of a float32 rounding

const reference::Settings kSettings{};

std::vector<ViewedScene> realScenes() {
    return {test::viewBuiltin("builtin:atelier", {256, 256}, 20000), test::viewBuiltin("builtin:fence", {250, 190}),
            test::viewBuiltin("builtin:slanted-wall", {256, 256}), test::viewBuiltin("builtin:step-edge", {256, 256})};
}

std::vector<ViewedScene> allScenes() {
    std::vector<ViewedScene> scenes = realScenes();
    scenes.push_back(test::viewCloud({200, 150}));
    for (const bool antialiased : {false, true}) { scenes.push_back(test::viewGaussians({200, 150}, antialiased)); }
    return scenes;
}

// What the device rounds when it takes a splat to the camera: the eye has 48 bits, so that nothing counts but how far apart they are.
double distanceToRound(const glm::dvec3& position, const Eye& eye) { return glm::length(position - eye.world_from_camera.position); }

struct Culled {
    std::vector<std::uint32_t> bits, group_offsets;
    gpu::ListState visible;
    [[nodiscard]] bool has(std::size_t splat) const { return ((bits[splat / 32] >> (splat % 32)) & 1) != 0; }
};

Culled cullOnDevice(Gpu& gpu, const SceneOnDevice& device, std::uint32_t eye_count) {
    const std::uint32_t count = device.scene.splatCount();
    const std::size_t groups = (count + gpu::kCullBlock - 1) / gpu::kCullBlock;
    const Kernel& kernel = gpu.kernel(CullKernel{.splat_kind = device.scene.splatShape()});
    const Buffer bits = gpu.allocate<std::uint32_t>("bits", groups * kGroupWords), counts = gpu.allocate<std::uint32_t>("counts", groups);
    const Buffer list = gpu.upload("visible", std::vector{gpu::ListState{}});
    gpu::CullPass pass{};
    pass.chunks = device.scene.chunks();
    pass.eyes = device.eyeViews();
    pass.visible_bits = bits.address<gpu::uint>();
    pass.group_counts = counts.address<gpu::uint>();
    pass.visible = list.address<gpu::ListState>();
    pass.splat_count = count;
    pass.chunk_bits = device.scene.chunkBits();
    pass.eye_count = eye_count;
    pass.capacity = count;
    gpu.run([&](Commands& commands) { commands.dispatchOver(kernel, pass, count, gpu::kCullBlock); });
    return {gpu.readBack<std::uint32_t>(bits, groups * kGroupWords), gpu.readBack<std::uint32_t>(counts, groups),
            gpu.readBack<gpu::ListState>(list, 1)[0]};
}

struct Compacted {
    std::vector<std::uint32_t> keys, splats;
};

// compact of these splats, ascending, for the device's first eye; by distance from `middle` where there is one.
Compacted compactOnDevice(Gpu& gpu, const SceneOnDevice& device, const std::vector<std::uint32_t>& visible,
                          const std::optional<glm::dvec3>& middle) {
    const Kernel& kernel = gpu.kernel(CompactKernel{.by_distance = middle.has_value()});
    const std::uint32_t count = device.scene.splatCount();
    const std::size_t groups = (count + gpu::kCullBlock - 1) / gpu::kCullBlock;
    std::vector<std::uint32_t> bits(groups * kGroupWords), offsets(groups + 1);
    for (const std::uint32_t splat : visible) {
        bits[splat / 32] |= 1u << (splat % 32);
        ++offsets[splat / gpu::kCullBlock + 1];
    }
    for (std::size_t g = 1; g <= groups; ++g) { offsets[g] += offsets[g - 1]; }
    const Buffer bit_buffer = gpu.upload("bits", bits), offset_buffer = gpu.upload("offsets", offsets),
                 list = gpu.upload("list", std::vector{test::makeList(visible.size())});
    const Buffer keys = gpu.allocate<std::uint32_t>("keys", visible.size()), splats = gpu.allocate<std::uint32_t>("splats", visible.size());
    gpu::CompactPass pass{};
    pass.chunks = device.scene.chunks();
    pass.eyes = device.eyeViews();
    if (middle) { pass.middle = placeOf(*middle); }
    pass.visible_bits = bit_buffer.address<gpu::uint>();
    pass.group_offsets = offset_buffer.address<gpu::uint>();
    pass.visible = list.address<gpu::ListState>();
    pass.keys = keys.address<gpu::uint>();
    pass.splats = splats.address<gpu::uint>();
    pass.splat_count = count;
    pass.chunk_bits = device.scene.chunkBits();
    gpu.run([&](Commands& commands) { commands.dispatchOver(kernel, pass, count, gpu::kCullBlock); });
    return {gpu.readBack<std::uint32_t>(keys, visible.size()), gpu.readBack<std::uint32_t>(splats, visible.size())};
}

// How far projected splats are from the twin's, in units of what rounding can do.
struct FieldErrors {
    std::map<std::string, double> worst;
    std::size_t other_kind = 0, edge_on = 0;

    void note(const std::string& field, double error, double unit) {
        worst[field] = std::max(worst[field], std::isnan(error) ? std::numeric_limits<double>::infinity() : std::abs(error) / unit);
    }

    void note(const gpu::ProjectedSplat& splat, const reference::ProjectedSplat& truth, const ViewedScene& view, std::uint32_t i) {
        const test::OpacityColour packed = test::unpack(splat);
        if (packed.has_reference != truth.low_pass) {
            ++other_kind;
            return;
        }
        noteColour(packed, truth, view.scene, i);
        const glm::dvec2 focal(view.eye.intrinsics.fx, view.eye.intrinsics.fy), principal(view.eye.intrinsics.cx, view.eye.intrinsics.cy);
        const glm::dvec3 position(view.scene.positions[i]), from_eye = position - view.eye.world_from_camera.position;
        const double rounding = kEpsilon * distanceToRound(position, view.eye);  // of the centre in camera space
        const double z = truth.depth;
        if (truth.low_pass) {
            const glm::dvec2 c = (truth.reference_px - principal) / focal * z;
            for (int axis = 0; axis < 2; ++axis) {
                // A position's own rounding, where it lies far from the scene's origin, and 2^-7 of the two floats'.
                const double coarse = focal[axis] * (1.0 + std::abs(c[axis]) / z) * rounding / z + kEpsilon * principal[axis];
                note("reference_px", test::referenceOf(splat)[axis] - truth.reference_px[axis], coarse / 128.0);
            }
            note("1/z", static_cast<double>(splat.inverse_depth) * z - 1.0, rounding / z);
        }
        if (truth.gaussian) {
            noteGaussian(splat, truth, view, i, rounding / z);
            return;
        }
        if (splat.plane_from_pixel.x >= gpu::kMaxPlaneSlope) {
            ++edge_on;
            return;
        }
        // Everything else is divided by delta = t_w . c, whose relative error is rounding / delta. u/z and v/z are cross products of
        // the length of c, over s delta and the focal length.
        const glm::quat& q = view.scene.rotations[i];
        const double delta = std::abs(glm::dot(glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z))[2], from_eye));
        const double scale = static_cast<double>(std::min(view.scene.scales[i].x, view.scene.scales[i].y));
        const double row = rounding / delta * distanceToRound(position, view.eye) / (scale * delta * std::min(focal.x, focal.y));
        const glm::dvec3 plane_error = glm::dvec3(splat.plane_from_pixel) - truth.plane_from_pixel;
        note("A", plane_error.x, row);
        note("B", plane_error.y, row);
        note("D", plane_error.z, row);
        for (int axis = 0; axis < 2; ++axis) {
            const double error = static_cast<double>(splat.perspective[axis]) - truth.perspective[axis];
            note("perspective", error * focal[axis], rounding / (delta * delta));
        }
        if (!truth.low_pass) {
            const double size = std::max(view.eye.size_px.x, view.eye.size_px.y);
            for (int axis = 0; axis < 2; ++axis) {
                note("offset", static_cast<double>(splat.reference_px[axis]) - truth.plane_offset[axis], row * size);
            }
            note("1/z", static_cast<double>(splat.inverse_depth) - truth.inverse_depth, 3.0 * rounding / (delta * delta));
        }
    }

private:
    // Of the axes on the screen, in pixels, what rounding makes of the line of sight is a part of the longest; the low-pass is half a
    // pixel.
    void noteGaussian(const gpu::ProjectedSplat& splat, const reference::ProjectedSplat& truth, const ViewedScene& view, std::uint32_t i,
                      double rounding) {
        const glm::dvec2 focal(view.eye.intrinsics.fx, view.eye.intrinsics.fy), sigma_px = truth.reach_px / std::sqrt(truth.cut);
        const double longest_px = std::max(view.scene.scales[i].x, view.scene.scales[i].y) * std::max(focal.x, focal.y) / truth.depth;
        const double unit = rounding * (1.0 + longest_px / std::sqrt(0.3));
        const glm::dvec3 plane_error = glm::dvec3(splat.plane_from_pixel) - truth.plane_from_pixel;
        note("Gaussian A", plane_error.x, unit * truth.plane_from_pixel.x);
        note("Gaussian B", plane_error.y, unit * truth.plane_from_pixel.x * (1.0 + sigma_px.x / sigma_px.y));
        note("Gaussian D", plane_error.z, unit * truth.plane_from_pixel.z);
        // Of 1/z, over a standard deviation on the screen. Sigma2^-1 divides by the shortest axis what the longest one brings.
        const double climb = std::max(view.scene.scales[i].x, view.scene.scales[i].y) / truth.depth;
        for (int axis = 0; axis < 2; ++axis) {
            const double error = static_cast<double>(splat.perspective[axis]) - truth.perspective[axis];
            note("Gaussian perspective", error * sigma_px[axis] * truth.depth, unit * climb * (1.0 + longest_px / std::sqrt(0.3)));
        }
        note("dimmed opacity", test::unpack(splat).opacity / truth.opacity - 1.0, 1.1e-5 + unit);
    }

    void noteColour(const test::OpacityColour& packed, const reference::ProjectedSplat& truth, const Scene& scene, std::uint32_t i) {
        // Half a step of 2^-15 of -log2(opacity) is 1.06e-5 of the opacity.
        if (!truth.gaussian) { note("opacity", packed.opacity / truth.opacity - 1.0, 1.1e-5); }
        // Half floats lose up to 2^-11 of themselves, in each coefficient and in the colour. No harmonic is above 1.1.
        const auto stride = 3 * static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
        for (int channel = 0; channel < 3; ++channel) {
            double size = truth.colour[channel];
            for (std::size_t k = static_cast<std::size_t>(channel); k < stride; k += 3) {
                size += 1.1 * std::abs(static_cast<double>(scene.sh[i * stride + k]));
            }
            note("colour", packed.colour[channel] - truth.colour[channel], size * 0x1p-11 + 1e-6);
        }
    }
};

}  // namespace

TEST_CASE_FIXTURE(Gpu, "cull misses no splat that the twin sees, and keeps hardly one that the twin's culling does not") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const Culled culled = cullOnDevice(*this, SceneOnDevice(*this, view.scene, {view.eye}, kSettings.near), 1);
        std::size_t missed = 0, kept = 0;
        for (const reference::TilePair& pair : twin.pairs) { missed += culled.has(twin.order[pair.splat]) ? 0 : 1; }
        for (std::size_t i = 0; i < view.scene.size(); ++i) { kept += culled.has(i) ? 1 : 0; }
        CHECK(missed == 0);
        CHECK(static_cast<double>(kept) <= 1.02 * static_cast<double>(twin.order.size()));
        std::size_t wrong_counts = 0, ones = 0;
        for (std::size_t g = 0; g < culled.group_offsets.size(); ++g) {
            wrong_counts += culled.group_offsets[g] == ones ? 0 : 1;
            for (std::size_t w = 0; w < kGroupWords; ++w) {
                ones += static_cast<std::size_t>(std::popcount(culled.bits[kGroupWords * g + w]));
            }
        }
        CHECK(culled.visible.count == ones);
        CHECK(wrong_counts == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "cull for two eyes keeps what either keeps") {
    const ViewedScene view = test::viewBuiltin("builtin:atelier", {256, 256}, 20000);
    Eye other = view.eye;
    other.world_from_camera.orientation = other.world_from_camera.orientation * glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
    const Culled one = cullOnDevice(*this, SceneOnDevice(*this, view.scene, {view.eye}, kSettings.near), 1);
    const Culled two = cullOnDevice(*this, SceneOnDevice(*this, view.scene, {other}, kSettings.near), 1);
    const Culled both = cullOnDevice(*this, SceneOnDevice(*this, view.scene, {view.eye, other}, kSettings.near), 2);
    CHECK(one.bits != two.bits);
    for (std::size_t w = 0; w < both.bits.size(); ++w) { REQUIRE(both.bits[w] == (one.bits[w] | two.bits[w])); }
}

TEST_CASE_FIXTURE(Gpu, "compact lists the visible splats in the scene's order with keys that order as their depths") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const SceneOnDevice device(*this, view.scene, {view.eye}, kSettings.near);
        const Compacted compacted = compactOnDevice(*this, device, twin.compacted.splats, {});
        CHECK(compacted.splats == twin.compacted.splats);
        // Keys order as the floats they stand for; those are the depths, up to a few roundings of the distance.
        double worst = 0.0;
        for (std::size_t i = 0; i < compacted.keys.size(); ++i) {
            const glm::dvec3 position(view.scene.positions[twin.compacted.splats[i]]);
            const double distance = distanceToRound(position, view.eye);
            worst = std::max(worst, std::abs(static_cast<double>(test::floatOfKey(compacted.keys[i])) - twin.compacted.depths[i]) /
                                        (kEpsilon * distance));
        }
        CHECK(worst <= 8.0);  // measured: 2.4
    }
}

TEST_CASE_FIXTURE(Gpu, "compact has keys that order as the distances from the middle between the eyes, also far from the world's origin") {
    for (const double offset : {0.0, 1e6}) {
        for (ViewedScene view : allScenes()) {
            CAPTURE(view.name);
            CAPTURE(offset);
            for (glm::vec3& position : view.scene.positions) { position += static_cast<float>(offset); }
            view.eye.world_from_camera.position += offset;
            reference::Settings settings;
            // No float32, so that the rest beside it counts.
            settings.order_from = view.eye.world_from_camera.position + glm::dvec3(0.0317, 1e-7, -1e-5);
            const TwinStages twin(view, settings);
            const SceneOnDevice device(*this, view.scene, {view.eye}, settings.near);
            const Compacted compacted = compactOnDevice(*this, device, twin.compacted.splats, settings.order_from);
            CHECK(compacted.splats == twin.compacted.splats);
            double worst = 0.0;
            for (std::size_t i = 0; i < compacted.keys.size(); ++i) {
                const double square = twin.compacted.depths[i];
                worst = std::max(worst, std::abs(static_cast<double>(test::floatOfKey(compacted.keys[i])) - square) / (kEpsilon * square));
            }
            CHECK(worst <= 8.0);
        }
    }
}

TEST_CASE("keys of depths order as the depths, behind the eye too") {
    const std::vector<float> ascending{-1e30f, -2.0f, -1.0f, -1e-30f, 0.0f, 1e-30f, 1.0f, 1.0000001f, 2.0f, 1e30f};
    for (std::size_t i = 1; i < ascending.size(); ++i) { CHECK(test::sortableBits(ascending[i - 1]) < test::sortableBits(ascending[i])); }
    for (const float value : ascending) { CHECK(test::floatOfKey(test::sortableBits(value)) == value); }
}

TEST_CASE_FIXTURE(Gpu, "sort_depth puts the twin's depths front to back, ties by index") {
    const Sort sort(context());
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const std::size_t count = twin.order.size();
        std::vector<std::uint32_t> keys;
        for (const double depth : twin.compacted.depths) { keys.push_back(test::sortableBits(static_cast<float>(depth))); }
        const Buffer key_buffer = upload("keys", keys), values = upload("splats", twin.compacted.splats),
                     list = upload("list", std::vector{test::makeList(count)});
        const Buffer spare_keys = allocate<gpu::uint>("spare keys", count), spare_values = allocate<gpu::uint>("spare", count);
        const Buffer histograms(context(), "histograms", Sort::histogramBytes(count));
        KeyValues sorted;
        run([&](Commands& commands) {
            sorted = sort.record(commands, {key_buffer.address<gpu::uint>(), values.address<gpu::uint>()},
                                 {spare_keys.address<gpu::uint>(), spare_values.address<gpu::uint>()}, histograms.address<gpu::uint>(),
                                 list, 0, 32);
        });
        CHECK(sorted.values.value == values.address<gpu::uint>().value);
        // The twin's order but for splats whose depths are one and the same float32: those are in the order of their indices.
        std::vector<std::uint32_t> expected = twin.order;
        std::vector<float> depth_of(view.scene.size());
        for (std::size_t i = 0; i < count; ++i) { depth_of[twin.compacted.splats[i]] = static_cast<float>(twin.compacted.depths[i]); }
        for (auto begin = expected.begin(); begin != expected.end();) {
            const auto end = std::find_if(begin, expected.end(), [&](std::uint32_t splat) { return depth_of[splat] != depth_of[*begin]; });
            std::sort(begin, end);
            begin = end;
        }
        CHECK(readBack<std::uint32_t>(values, count) == expected);
    }
}

TEST_CASE_FIXTURE(Gpu, "project gives the twin's fields, up to roundings times the condition of each") {
    // Measured: reference 1.3, A and B 19, D 11 (16.1 on an NVIDIA H100), perspective 5, 1/z 3.1, offset 0.7, of Gaussians 2, in roundings.
    const std::map<std::string, double> bounds{
        {"opacity", 1.0},    {"colour", 1.0},     {"reference_px", 4.0},         {"1/z", 8.0},           {"A", 32.0},
        {"B", 32.0},         {"D", 24.0},         {"perspective", 16.0},         {"offset", 2.0},        {"Gaussian A", 4.0},
        {"Gaussian B", 4.0}, {"Gaussian D", 4.0}, {"Gaussian perspective", 2.0}, {"dimmed opacity", 4.0}};
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const SceneOnDevice device(*this, view.scene, {view.eye}, kSettings.near);
        const test::ProjectedOnDevice projected = test::projectOnDevice(*this, device, twin.order);
        const auto splats = readBack<gpu::ProjectedSplat>(projected.splats, projected.count);
        const auto tile_counts = readBack<std::uint32_t>(projected.tile_counts, projected.count);
        FieldErrors errors;
        std::size_t compared = 0;
        for (std::size_t rank = 0; rank < splats.size(); ++rank) {
            if (tile_counts[rank] == 0) { continue; }  // nothing is said of what meets no tile
            errors.note(splats[rank], twin.splats[rank], view, twin.order[rank]);
            ++compared;
        }
        CHECK(2 * compared > splats.size());
        CHECK(errors.other_kind == 0);
        CHECK(errors.edge_on <= (view.name == "cloud" ? 40 : 0));
        for (const auto& [field, error] : errors.worst) {
            CAPTURE(field);
            CHECK(error <= bounds.at(field));
        }
    }
}

}  // namespace passes_test
