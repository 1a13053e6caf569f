// Uploads a scene to the device.
#include "engine/gpu/gpu_scene.h"

#include "engine/error.h"
#include "engine/gpu/commands.h"

#include <algorithm>
#include <bit>

namespace binosplat {
namespace {

// Splats that are packed and copied at a time: the upload buffer has at most 9 MiB.
constexpr std::uint32_t kUploadSplats = 65536;

// Words of a chunk can then be counted in less than 31 bits, see kMaxItems.
constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{4} << 30;

constexpr auto kPageBits = static_cast<std::uint32_t>(std::countr_zero(gpu::kPageSplats));

// The chunk's splats, starting with the page's first.
gpu::SceneChunk pageOf(const gpu::SceneChunk& chunk, std::uint64_t first, std::uint64_t sh_words) {
    gpu::SceneChunk page = chunk;
    page.positions = chunk.positions.at(first);
    page.rotations = chunk.rotations.at(first);
    page.scales = chunk.scales.at(first);
    page.thicknesses = chunk.thicknesses.at(first);
    page.opacities = chunk.opacities.at(first);
    page.base_colours = chunk.base_colours.at(first);
    page.sh = chunk.sh.at(first * sh_words);
    return page;
}

}  // namespace

GpuScene::GpuScene(const Context& context, const Scene& scene, const Progress& progress, bool keeps_table)
    : traits_(traitsOf(scene)) {
    check(scene.size() <= gpu::kMaxItems, "{}: {} splats, at most {} can be shown", scene.name, scene.size(),
          gpu::kMaxItems);
    splat_count_ = splats_held_ = splats_coming_ = static_cast<std::uint32_t>(scene.size());
    const std::uint32_t least_bits = keeps_table ? kPageBits : 0;
    chunk_bits_ = least_bits;
    while ((1ull << chunk_bits_) < splat_count_) { ++chunk_bits_; }
    const std::uint64_t most_bytes = std::min(context.maxAllocationBytes(), kMaxChunkBytes);
    while (chunk_bits_ > least_bits &&
           ChunkLayout(std::min<std::uint64_t>(1ull << chunk_bits_, splat_count_), traits_).bytes >
               most_bytes) {
        --chunk_bits_;
    }

    std::vector<gpu::SceneChunk> table;
    const std::uint64_t chunk_splats = 1ull << chunk_bits_;
    const std::uint64_t upload_splats = std::clamp<std::uint64_t>(
        context.maxAllocationBytes() / (2 * deviceBytesPerSplat(shDegree(), traits_.isGaussian3d())), 1,
        std::min(kUploadSplats, std::max(splat_count_, 1u)));
    const ChunkLayout upload_layout(upload_splats, traits_);
    const Buffer upload(context, "scene upload", upload_layout.bytes, MemoryKind::kUpload);
    Commands commands(context);
    for (std::uint64_t first = 0; first < splat_count_; first += chunk_splats) {
        const std::uint64_t count = std::min<std::uint64_t>(chunk_splats, splat_count_ - first);
        const std::uint64_t page_splats = keeps_table ? gpu::kPageSplats : 1,
                            room = (count + page_splats - 1) / page_splats * page_splats;
        const ChunkLayout layout(room, traits_);
        const Buffer& buffer =
            buffers_.emplace_back(context, fmt::format("scene chunk {}", buffers_.size()), layout.bytes);
        table.push_back(layout.chunkAt(buffer, 0, 1.0f));
        if (room > count) {  // the rest of the last page is never visible
            commands.begin();
            commands.fillZero(buffer);
            commands.submitAndWait();
        }
        for (std::uint64_t done = 0; done < count; done += upload_splats) {
            const std::uint64_t block = std::min<std::uint64_t>(upload_splats, count - done);
            packSplats(scene, first + done, block, traits_, upload_layout,
                       upload.mapped<std::uint8_t>().data());
            commands.begin();
            const auto copyArray = [&](std::uint64_t from, std::uint64_t to, std::uint64_t bytes_per_splat) {
                commands.copy(upload, buffer, block * bytes_per_splat, from, to + done * bytes_per_splat);
            };
            copyArray(upload_layout.positions, layout.positions, sizeof(glm::vec3));
            copyArray(upload_layout.rotations, layout.rotations, sizeof(glm::vec4));
            copyArray(upload_layout.scales, layout.scales, sizeof(glm::vec2));
            if (traits_.isGaussian3d()) {
                copyArray(upload_layout.thicknesses, layout.thicknesses, sizeof(float));
            }
            copyArray(upload_layout.opacities, layout.opacities, sizeof(float));
            copyArray(upload_layout.base_colours, layout.base_colours, sizeof(glm::uvec2));
            copyArray(upload_layout.sh, layout.sh, layout.sh_bytes_per_splat);
            commands.submitAndWait();
            if (progress) { progress(static_cast<double>(first + done + block) / splat_count_); }
        }
    }
    const std::uint64_t table_bytes = std::max<std::uint64_t>(table.size(), 1) * sizeof(gpu::SceneChunk);
    table.resize(table_bytes / sizeof(gpu::SceneChunk));
    check(table_bytes <= 65536, "{}: {} splats need more than {} allocations of {} MiB", scene.name,
          scene.size(), 65536 / sizeof(gpu::SceneChunk), context.maxAllocationBytes() >> 20);
    if (keeps_table) { keepTable(scene, table); }
    chunk_table_ = Buffer(context, "scene chunks", table_bytes);
    commands.begin();
    commands.update(chunk_table_, table.data(), table_bytes);
    commands.submitAndWait();
    chunks_ = chunk_table_.address<gpu::SceneChunk>();
    chunk_count_ = buffers_.size();
    bytes_ = chunk_table_.bytes();
    for (const Buffer& buffer : buffers_) { bytes_ += buffer.bytes(); }
}

GpuScene GpuScene::asItIs() const {
    GpuScene scene;
    scene.traits_ = traits_;
    scene.splat_count_ = splat_count_;
    scene.splats_held_ = splats_held_;
    scene.splats_coming_ = splats_coming_;
    scene.pages_held_ = pages_held_;
    scene.chunk_bits_ = chunk_bits_;
    scene.chunk_count_ = chunk_count_;
    scene.chunks_ = chunks_;
    scene.pages_ = pages_;
    scene.bytes_ = bytes_;
    scene.is_placed_ = is_placed_;
    return scene;
}

void GpuScene::keepTable(const Scene& scene, const std::vector<gpu::SceneChunk>& chunks) {
    const std::uint64_t sh_words = ChunkLayout(1, traits_).sh_bytes_per_splat / sizeof(std::uint32_t);
    for (std::uint64_t first = 0; first < splat_count_; first += gpu::kPageSplats) {
        table_.chunks.push_back(
            pageOf(chunks[first >> chunk_bits_], first & ((1ull << chunk_bits_) - 1), sh_words));
        PageBounds bounds;
        for (std::uint64_t i = first; i < std::min<std::uint64_t>(first + gpu::kPageSplats, splat_count_);
             ++i) {
            const float thickness = traits_.isGaussian3d() ? scene.thicknesses[i] : 0.0f;
            bounds.add(scene.positions[i], scene.rotations[i], {scene.scales[i], thickness},
                       scene.opacities[i]);
        }
        table_.bounds.push_back(bounds.page());
    }
}

}  // namespace binosplat
