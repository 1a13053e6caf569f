// A glTF that has been checked as a whole: the splats that its nodes place, in columns whose bytes are known
// to exist.
#pragma once

#include "engine/files/gltf_buffers.h"
#include "engine/files/gltf_parser.h"
#include "engine/files/input_file.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// One attribute of all splats of a primitive.
class GltfColumn {
public:
    // `components` is the accessor's. Its bytes are within the buffer, which must outlive the column.
    GltfColumn(const GltfBuffer& buffer, std::uint64_t offset, std::uint64_t stride,
               const gltf::Accessor& accessor)
        : buffer_(&buffer), offset_(offset), stride_(stride), accessor_(accessor) {}

    [[nodiscard]] std::uint64_t count() const { return accessor_.count; }
    [[nodiscard]] int components() const { return accessor_.components; }
    // The values of `rows` splats from `first` on, `components` each; integers are kept or scaled to -1 to 1,
    // as the accessor says.
    void read(std::uint64_t first, std::size_t rows, std::vector<float>& values) const;

private:
    const GltfBuffer* buffer_;
    std::uint64_t offset_, stride_;
    gltf::Accessor accessor_;
    mutable std::vector<std::byte> bytes_;
};

// A primitive at a node.
struct GltfSplats {
    GltfColumn position, rotation, scale, opacity;
    // One column per coefficient, starting with the constant one; empty: `colour` stands for that one.
    std::vector<GltfColumn> sh;
    std::optional<GltfColumn> colour;
    glm::dmat4 world_from_node{1.0};
    bool is_linear = false;  // its colours are linear; otherwise display-encoded

    [[nodiscard]] std::uint64_t count() const { return position.count(); }
};

struct GltfDocument {
    std::vector<GltfBuffer> buffers;
    std::vector<GltfSplats> parts;
    std::uint64_t bytes = 0;   // of the file and all buffers
    int sh_degree = 0;         // the highest of the parts'
    bool is_linear = false;    // most splats' colours are linear, and the scene's will be
    bool by_distance = false;  // the blending order
    std::vector<std::string> notes;
};

// Throws Error for anything that violates the format, before any splat is read.
GltfDocument openGltf(InputFile& file);

}  // namespace binosplat
