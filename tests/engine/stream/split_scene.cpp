// Thins each leaf, and bundles what StreamedWriter makes of it.
#include "tests/engine/stream/split_scene.h"

#include "engine/files/sog_files.h"
#include "engine/files/sog_pack.h"
#include "engine/files/streamed_write.h"
#include "engine/scene/pick_splats.h"

#include <cmath>
#include <fstream>
#include <iterator>

namespace binosplat::test {

namespace {

namespace fs = std::filesystem;

std::string textIn(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void bundle(const fs::path& chunk) {
    std::vector<NamedBytes> files;
    for (const auto& entry : fs::directory_iterator(chunk)) {
        const std::string text = textIn(entry.path());
        const auto bytes = std::as_bytes(std::span(text));
        files.push_back({entry.path().filename().string(), {bytes.begin(), bytes.end()}});
    }
    const std::string name = chunk.string() + ".sog";
    const std::vector<std::byte> packed = packSogBundle(files, name);
    std::ofstream(name, std::ios::binary)
        .write(reinterpret_cast<const char*>(packed.data()), static_cast<std::streamsize>(packed.size()));
    fs::remove_all(chunk);
}

// Adds to `to` what stands for each `group` splats of a leaf along a Morton curve: its first, larger, with
// the mean of their colours.
void addThinned(const Scene& leaf, std::size_t group, Scene& to) {
    const std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(leaf));
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(leaf.sh_degree));
    for (std::size_t begin = 0; begin < order.size(); begin += group) {
        const auto splats = std::span(order).subspan(begin, std::min(group, order.size() - begin));
        const auto size = static_cast<float>(splats.size());
        Scene one = pickSplats(leaf, splats.first(1));
        one.scales[0] *= std::sqrt(size);
        for (std::size_t i = 0; i < width; ++i) {
            one.sh[i] = 0.0f;
            for (const std::uint32_t splat : splats) { one.sh[i] += leaf.sh[splat * width + i] / size; }
        }
        appendSplats(to, one);
    }
}

}  // namespace

void splitScene(const Scene& scene, const std::string& folder, const SplitSettings& settings) {
    const fs::path meta_path = fs::path(folder) / "lod-meta.json";
    StreamedWriter writer(meta_path,
                          {.chunk_splats = settings.chunk_splats, .leaf_splats = settings.leaf_splats});
    writer.cutLeaves(scene.positions);
    // Of at most as many splats as a leaf has, so one to a leaf.
    const auto leaves = writer.sortInto(writer.cutBlocks(settings.leaf_splats), scene.positions);
    for (std::uint32_t level = 0; level < settings.levels; ++level) {
        Scene thinned = pickSplats(scene, {});
        for (const std::vector<std::uint32_t>& leaf : leaves) {
            addThinned(pickSplats(scene, leaf), std::size_t{1} << level, thinned);
        }
        writer.add(level, thinned);
    }
    writer.finish();

    std::string meta = textIn(meta_path);
    const std::string end = "/meta.json\"";
    for (std::size_t at = 0; (at = meta.find(end, at)) != std::string::npos;) {
        const std::size_t begin = meta.rfind('"', at) + 1;
        bundle(fs::path(folder) / meta.substr(begin, at - begin));
        meta.replace(at, end.size() - 1, ".sog");
    }
    std::ofstream(meta_path, std::ios::binary) << meta;
}

}  // namespace binosplat::test
