// Packing a scene for the device, and bringing it there.
#include "engine/gpu/gpu_scene.h"

#include "engine/error.h"
#include "engine/gpu/commands.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace binosplat {
namespace {

// Splats that are packed and copied at a time: the upload buffer is at most 9 MiB.
constexpr std::uint32_t kUploadSplats = 65536;

// Words of a chunk are then counted in less than 31 bits, see kMaxItems.
constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{4} << 30;

std::uint64_t shWords(int sh_degree) { return static_cast<std::uint64_t>(3 * (shCoefficientCount(sh_degree) - 1) + 1) / 2; }

// Where the arrays of a chunk of `capacity` splats lie in its buffer.
struct ChunkLayout {
    ChunkLayout(std::uint64_t capacity, int sh_degree, bool gaussian_3d) {
        const auto place = [&](std::uint64_t bytes_per_splat) {
            const std::uint64_t at = bytes;
            bytes += (capacity * bytes_per_splat + 15) / 16 * 16;
            return at;
        };
        positions = place(sizeof(glm::vec3));
        rotations = place(sizeof(glm::vec4));
        scales = place(sizeof(glm::vec2));
        thicknesses = place(gaussian_3d ? sizeof(float) : 0);
        opacities = place(sizeof(float));
        base_colours = place(sizeof(glm::uvec2));
        sh = place(shWords(sh_degree) * sizeof(std::uint32_t));
    }
    std::uint64_t positions = 0, rotations = 0, scales = 0, thicknesses = 0, opacities = 0, base_colours = 0, sh = 0, bytes = 0;
};

// Half floats end at 65504; what lies beyond stays finite.
std::uint32_t packHalves(float low, float high) {
    return glm::packHalf2x16(glm::clamp(glm::vec2(low, high), glm::vec2(-65504.0f), glm::vec2(65504.0f)));
}

// The rotation as the device holds it: x, y, z, w of unit length. Nothing for a splat that cannot be shown.
std::optional<glm::vec4> rotationToShow(const Scene& scene, std::uint64_t splat) {
    const glm::vec3& p = scene.positions[splat];
    const glm::vec2& scale = scene.scales[splat];
    const auto values = static_cast<std::uint64_t>(3 * shCoefficientCount(scene.sh_degree));
    // v * 0 is 0 for a finite v and NaN otherwise, and a sum keeps a NaN.
    float zero = (p.x + p.y + p.z) * 0.0f + (scale.x + scale.y) * 0.0f + scene.opacities[splat] * 0.0f;
    if (scene.isGaussian3d()) { zero += scene.thicknesses[splat] * 0.0f; }
    for (std::uint64_t i = splat * values; i < (splat + 1) * values; ++i) { zero += scene.sh[i] * 0.0f; }
    const glm::quat& q = scene.rotations[splat];
    const glm::dvec4 rotation(q.x, q.y, q.z, q.w);
    const double length = glm::length(rotation);
    if (!(zero == 0.0f && length > 0.0 && std::isfinite(length))) { return std::nullopt; }
    return glm::vec4(rotation / length);
}

// Writes splats [first, first + count) of `scene` to `to`, laid out as `layout` (of at least `count` splats).
void packSplats(const Scene& scene, std::uint64_t first, std::uint64_t count, const ChunkLayout& layout, std::uint8_t* to) {
    const auto put = [&]<typename T>(std::uint64_t array, std::uint64_t i, const T& value) {
        std::memcpy(to + array + i * sizeof(T), &value, sizeof(T));
    };
    const int coefficients = shCoefficientCount(scene.sh_degree);
    const std::uint64_t sh_words = shWords(scene.sh_degree);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t splat = first + i;
        const std::optional<glm::vec4> rotation = rotationToShow(scene, splat);
        put(layout.positions, i, scene.positions[splat]);
        put(layout.rotations, i, rotation.value_or(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)));
        put(layout.scales, i, scene.scales[splat]);
        if (scene.isGaussian3d()) { put(layout.thicknesses, i, scene.thicknesses[splat]); }
        put(layout.opacities, i, rotation ? scene.opacities[splat] : 0.0f);
        const float* sh = scene.sh.data() + splat * static_cast<std::uint64_t>(coefficients) * 3;
        put(layout.base_colours, i, glm::uvec2(packHalves(sh[0], sh[1]), packHalves(sh[2], 0.0f)));
        const std::uint64_t halves = 3 * static_cast<std::uint64_t>(coefficients - 1);
        for (std::uint64_t w = 0; w < sh_words; ++w) {
            put(layout.sh, i * sh_words + w, packHalves(sh[3 + 2 * w], 2 * w + 1 < halves ? sh[4 + 2 * w] : 0.0f));
        }
    }
}

}  // namespace

std::uint64_t deviceBytesPerSplat(int sh_degree, bool gaussian_3d) {
    return (gaussian_3d ? 52 : 48) + shWords(sh_degree) * sizeof(std::uint32_t);
}

GpuScene::GpuScene(const Context& context, const Scene& scene, const Progress& progress) : sh_degree_(scene.sh_degree) {
    const bool gaussian_3d = scene.isGaussian3d();
    is_light_ = scene.is_linear;
    if (scene.by_distance) { usual_order_ = Order::kDistance; }
    if (gaussian_3d) { splat_kind_ = scene.antialiased ? gpu::kAntialiasedGaussians : gpu::kGaussians; }
    check(scene.size() <= gpu::kMaxItems, "{}: {} splats, at most {} can be shown", scene.name, scene.size(), gpu::kMaxItems);
    splat_count_ = static_cast<std::uint32_t>(scene.size());
    while ((1ull << chunk_bits_) < splat_count_) { ++chunk_bits_; }
    const std::uint64_t most_bytes = std::min(context.maxAllocationBytes(), kMaxChunkBytes);
    while (chunk_bits_ > 0 &&
           ChunkLayout(std::min<std::uint64_t>(1ull << chunk_bits_, splat_count_), sh_degree_, gaussian_3d).bytes > most_bytes) {
        --chunk_bits_;
    }

    std::vector<gpu::SceneChunk> table;
    const std::uint64_t chunk_splats = 1ull << chunk_bits_;
    const std::uint64_t upload_splats =
        std::clamp<std::uint64_t>(context.maxAllocationBytes() / (2 * deviceBytesPerSplat(sh_degree_, gaussian_3d)), 1,
                                  std::min(kUploadSplats, std::max(splat_count_, 1u)));
    const ChunkLayout upload_layout(upload_splats, sh_degree_, gaussian_3d);
    const Buffer upload(context, "scene upload", upload_layout.bytes, MemoryKind::kUpload);
    Commands commands(context);
    for (std::uint64_t first = 0; first < splat_count_; first += chunk_splats) {
        const std::uint64_t count = std::min<std::uint64_t>(chunk_splats, splat_count_ - first);
        const ChunkLayout layout(count, sh_degree_, gaussian_3d);
        const Buffer& buffer = buffers_.emplace_back(context, fmt::format("scene chunk {}", buffers_.size()), layout.bytes);
        table.push_back({buffer.address<gpu::vec3>(layout.positions), buffer.address<gpu::vec4>(layout.rotations),
                         buffer.address<gpu::vec2>(layout.scales), buffer.address<float>(layout.thicknesses),
                         buffer.address<float>(layout.opacities), buffer.address<gpu::uvec2>(layout.base_colours),
                         buffer.address<std::uint32_t>(layout.sh)});
        for (std::uint64_t done = 0; done < count; done += upload_splats) {
            const std::uint64_t block = std::min<std::uint64_t>(upload_splats, count - done);
            packSplats(scene, first + done, block, upload_layout, upload.mapped<std::uint8_t>().data());
            commands.begin();
            const auto copyArray = [&](std::uint64_t from, std::uint64_t to, std::uint64_t bytes_per_splat) {
                commands.copy(upload, buffer, block * bytes_per_splat, from, to + done * bytes_per_splat);
            };
            copyArray(upload_layout.positions, layout.positions, sizeof(glm::vec3));
            copyArray(upload_layout.rotations, layout.rotations, sizeof(glm::vec4));
            copyArray(upload_layout.scales, layout.scales, sizeof(glm::vec2));
            if (gaussian_3d) { copyArray(upload_layout.thicknesses, layout.thicknesses, sizeof(float)); }
            copyArray(upload_layout.opacities, layout.opacities, sizeof(float));
            copyArray(upload_layout.base_colours, layout.base_colours, sizeof(glm::uvec2));
            copyArray(upload_layout.sh, layout.sh, shWords(sh_degree_) * sizeof(std::uint32_t));
            commands.submitAndWait();
            if (progress) { progress(static_cast<double>(first + done + block) / splat_count_); }
        }
    }
    const std::uint64_t table_bytes = std::max<std::uint64_t>(table.size(), 1) * sizeof(gpu::SceneChunk);
    table.resize(table_bytes / sizeof(gpu::SceneChunk));
    check(table_bytes <= 65536, "{}: {} splats need more than {} allocations of {} MiB", scene.name, scene.size(),
          65536 / sizeof(gpu::SceneChunk), context.maxAllocationBytes() >> 20);
    chunk_table_ = Buffer(context, "scene chunks", table_bytes);
    commands.begin();
    commands.update(chunk_table_, table.data(), table_bytes);
    commands.submitAndWait();
}

std::uint64_t GpuScene::bytes() const {
    std::uint64_t total = chunk_table_.bytes();
    for (const Buffer& buffer : buffers_) { total += buffer.bytes(); }
    return total;
}

}  // namespace binosplat
