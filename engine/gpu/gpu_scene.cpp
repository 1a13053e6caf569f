// Packing a scene for the device, and bringing it there.
#include "engine/gpu/gpu_scene.h"

#include "engine/error.h"
#include "engine/gpu/commands.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace binosplat {
namespace {

// Splats that are packed and copied at a time: the upload buffer is at most 9 MiB.
constexpr std::uint32_t kUploadSplats = 65536;
// Splats that say where the scene's middle is.
constexpr std::size_t kOriginSamples = 1u << 20;

std::uint64_t shWords(int sh_degree) { return static_cast<std::uint64_t>(3 * (shCoefficientCount(sh_degree) - 1) + 1) / 2; }

// Where the arrays of a chunk of `capacity` splats lie in its buffer.
struct ChunkLayout {
    explicit ChunkLayout(std::uint64_t capacity, int sh_degree) {
        const auto place = [&](std::uint64_t bytes_per_splat) {
            const std::uint64_t at = bytes;
            bytes += (capacity * bytes_per_splat + 15) / 16 * 16;
            return at;
        };
        positions = place(sizeof(glm::vec3));
        rotations = place(sizeof(glm::vec4));
        scales = place(sizeof(glm::vec2));
        opacities = place(sizeof(float));
        base_colours = place(sizeof(glm::uvec2));
        sh = place(shWords(sh_degree) * sizeof(std::uint32_t));
    }
    std::uint64_t positions = 0, rotations = 0, scales = 0, opacities = 0, base_colours = 0, sh = 0, bytes = 0;
};

// Half floats end at 65504; what lies beyond stays finite.
std::uint32_t packHalves(float low, float high) {
    return glm::packHalf2x16(glm::clamp(glm::vec2(low, high), glm::vec2(-65504.0f), glm::vec2(65504.0f)));
}

// Zero, or where most splats are if they are far off: along each axis the median, since the middle of the bounds would lie far off
// with the farthest splat. Positions that differ by less than a factor of two have exact differences, so that nothing is rounded
// for most splats of a far-off scene; those of a scene about zero stay as they are.
constexpr double kFarOff = 16.0;  // median deviations
glm::dvec3 originFor(const Scene& scene) {
    if (scene.size() == 0) { return glm::dvec3(0.0); }
    const std::size_t stride = scene.size() / kOriginSamples + 1;
    std::vector<float> values;
    glm::dvec3 origin;
    for (int axis = 0; axis < 3; ++axis) {
        values.clear();
        for (std::size_t i = 0; i < scene.size(); i += stride) { values.push_back(scene.positions[i][axis]); }
        const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), half, values.end());
        const float median = *half;
        for (float& value : values) { value = std::abs(value - median); }
        std::nth_element(values.begin(), half, values.end());
        origin[axis] = std::abs(static_cast<double>(median)) > kFarOff * static_cast<double>(*half) ? static_cast<double>(median) : 0.0;
    }
    return origin;
}

// Writes splats [first, first + count) of `scene` to `to`, laid out as `layout` (of at least `count` splats).
void packSplats(const Scene& scene, std::uint64_t first, std::uint64_t count, const glm::dvec3& origin, const ChunkLayout& layout,
                std::uint8_t* to) {
    const auto put = [&]<typename T>(std::uint64_t array, std::uint64_t i, const T& value) {
        std::memcpy(to + array + i * sizeof(T), &value, sizeof(T));
    };
    const int coefficients = shCoefficientCount(scene.sh_degree);
    const std::uint64_t sh_words = shWords(scene.sh_degree);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t splat = first + i;
        const glm::quat& q = scene.rotations[splat];
        put(layout.positions, i, glm::vec3(glm::dvec3(scene.positions[splat]) - origin));
        put(layout.rotations, i, glm::vec4(q.x, q.y, q.z, q.w));
        put(layout.scales, i, scene.scales[splat]);
        put(layout.opacities, i, scene.opacities[splat]);
        const float* sh = scene.sh.data() + splat * static_cast<std::uint64_t>(coefficients) * 3;
        put(layout.base_colours, i, glm::uvec2(packHalves(sh[0], sh[1]), packHalves(sh[2], 0.0f)));
        const std::uint64_t halves = 3 * static_cast<std::uint64_t>(coefficients - 1);
        for (std::uint64_t w = 0; w < sh_words; ++w) {
            put(layout.sh, i * sh_words + w, packHalves(sh[3 + 2 * w], 2 * w + 1 < halves ? sh[4 + 2 * w] : 0.0f));
        }
    }
}

}  // namespace

std::uint64_t deviceBytesPerSplat(int sh_degree) { return 48 + shWords(sh_degree) * sizeof(std::uint32_t); }

GpuScene::GpuScene(const Context& context, const Scene& scene, const Progress& progress)
    : sh_degree_(scene.sh_degree), origin_(originFor(scene)) {
    check(scene.size() < (1u << 31), "{}: {} splats, at most {} can be shown", scene.name, scene.size(), (1u << 31) - 1);
    splat_count_ = static_cast<std::uint32_t>(scene.size());
    while ((1ull << chunk_bits_) < splat_count_) { ++chunk_bits_; }
    while (chunk_bits_ > 0 &&
           ChunkLayout(std::min<std::uint64_t>(1ull << chunk_bits_, splat_count_), sh_degree_).bytes > context.maxAllocationBytes()) {
        --chunk_bits_;
    }

    std::vector<gpu::SceneChunk> table;
    const std::uint64_t chunk_splats = 1ull << chunk_bits_;
    const std::uint64_t upload_splats = std::clamp<std::uint64_t>(context.maxAllocationBytes() / (2 * deviceBytesPerSplat(sh_degree_)), 1,
                                                                  std::min(kUploadSplats, std::max(splat_count_, 1u)));
    const ChunkLayout upload_layout(upload_splats, sh_degree_);
    const Buffer upload(context, "scene upload", upload_layout.bytes, MemoryKind::kUpload);
    Commands commands(context);
    for (std::uint64_t first = 0; first < splat_count_; first += chunk_splats) {
        const std::uint64_t count = std::min<std::uint64_t>(chunk_splats, splat_count_ - first);
        const ChunkLayout layout(count, sh_degree_);
        const Buffer& buffer = buffers_.emplace_back(context, fmt::format("scene chunk {}", buffers_.size()), layout.bytes);
        table.push_back({buffer.address<gpu::vec3>(layout.positions), buffer.address<gpu::vec4>(layout.rotations),
                         buffer.address<gpu::vec2>(layout.scales), buffer.address<float>(layout.opacities),
                         buffer.address<gpu::uvec2>(layout.base_colours), buffer.address<std::uint32_t>(layout.sh)});
        for (std::uint64_t done = 0; done < count; done += upload_splats) {
            const std::uint64_t block = std::min<std::uint64_t>(upload_splats, count - done);
            packSplats(scene, first + done, block, origin_, upload_layout, upload.mapped<std::uint8_t>().data());
            commands.begin();
            const auto copyArray = [&](std::uint64_t from, std::uint64_t to, std::uint64_t bytes_per_splat) {
                commands.copy(upload, buffer, block * bytes_per_splat, from, to + done * bytes_per_splat);
            };
            copyArray(upload_layout.positions, layout.positions, sizeof(glm::vec3));
            copyArray(upload_layout.rotations, layout.rotations, sizeof(glm::vec4));
            copyArray(upload_layout.scales, layout.scales, sizeof(glm::vec2));
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
