// JSON, buffers, nodes and attributes of a glTF.
#include "engine/files/gltf_document.h"

#include "engine/error.h"
#include "engine/files/json_node.h"
#include "engine/files/quantized.h"
#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

// In memory it is ten times as long; splats belong in a buffer.
constexpr std::uint64_t kMostTextBytes = std::uint64_t{32} << 20;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;  // "JSON", "BIN\0"
// For all nodes together: a file of a few megabytes may name each of a million primitives a million times.
constexpr std::uint64_t kMostPrimitives = std::uint64_t{1} << 18;
constexpr const char* kPrefix = "KHR_gaussian_splatting:";

// The text to parse, and the chunk of a GLB that holds its first buffer.
struct Content {
    std::vector<std::byte> text;
    std::optional<GltfBuffer> chunk;
};

std::vector<std::byte> readText(InputFile& file, std::uint64_t bytes) {
    check(bytes <= kMostTextBytes, "{}: has {} bytes of JSON, expected at most {}", file.name(), bytes,
          kMostTextBytes);
    check(bytes <= file.bytesLeft(), "{}: ends after {} bytes, expected {} of JSON", file.name(),
          file.bytesLeft(), bytes);
    std::vector<std::byte> text(bytes);
    const std::size_t got = file.read(text);
    check(got == bytes, "{}: ends after {} of {} bytes of JSON", file.name(), got, bytes);
    return text;
}

Content readContent(InputFile& file) {
    if (file.peek(4) != "glTF") { return {readText(file, file.sizeBytes()), std::nullopt}; }
    // A GLB: header of magic, version and length; chunks of length, type and bytes.
    const std::span<const std::byte> header = file.readBlock(20);
    check(header.size() == 20, "{}: ends after {} bytes, expected a GLB's header of 20", file.name(),
          header.size());
    const auto version = loadLittle<std::uint32_t>(header, 4),
               text_bytes = loadLittle<std::uint32_t>(header, 12);
    check(version == 2, "{}: a GLB of version {}, expected 2", file.name(), version);
    check(loadLittle<std::uint32_t>(header, 16) == kJsonChunk,
          "{}: the first chunk is of another type, expected JSON", file.name());
    Content content{readText(file, text_bytes), std::nullopt};
    while (file.bytesLeft() > 0) {
        const std::span<const std::byte> chunk = file.readBlock(8);
        check(chunk.size() == 8, "{}: ends within a chunk's header", file.name());
        const std::uint64_t bytes = loadLittle<std::uint32_t>(chunk, 0);
        check(bytes <= file.bytesLeft(), "{}: ends after {} bytes of a chunk of {}", file.name(),
              file.bytesLeft(), bytes);
        if (loadLittle<std::uint32_t>(chunk, 4) == kBinaryChunk && !content.chunk) {
            content.chunk.emplace(file, file.positionBytes(), bytes);
        }
        file.skip(bytes);
    }
    return content;
}

std::vector<GltfBuffer> openBuffers(const InputFile& file, const nlohmann::json& document,
                                    std::optional<GltfBuffer> chunk) {
    std::vector<GltfBuffer> buffers;
    const JsonNode root{document, file.name()};
    const std::size_t count = root.has("buffers") ? root.at("buffers").arraySize() : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const JsonNode node = root.at("buffers").at(i);
        if (node.has("uri")) {
            buffers.push_back(openGltfUri(file, node.at("uri").text(), node.place()));
        } else {
            check(i == 0 && chunk, "{}: has no uri, expected one{}", node.place(),
                  i == 0 ? ", or the binary chunk of a GLB" : "");
            buffers.push_back(std::move(*chunk));
        }
        const std::uint64_t bytes = node.at("byteLength").count();
        check(bytes <= buffers.back().sizeBytes(), "{}: byteLength is {}, but only {} bytes are there",
              node.place(), bytes, buffers.back().sizeBytes());
    }
    return buffers;
}

std::uint64_t componentBytes(gltf::Component component) {
    switch (component) {
        case gltf::Component::kInt8:
        case gltf::Component::kUint8:
            return 1;
        case gltf::Component::kInt16:
        case gltf::Component::kUint16:
            return 2;
        case gltf::Component::kUint32:
        case gltf::Component::kFloat32:
            break;
    }
    return 4;
}

// A primitive, and how messages call it.
struct Place {
    const gltf::Model& model;
    const std::vector<GltfBuffer>& buffers;
    const gltf::Primitive& primitive;
    std::string name;
};

enum class Integers { kNone, kNormalized, kAny };

// Empty if the primitive has no such attribute.
std::optional<GltfColumn> findColumn(const Place& place, const std::string& attribute, int components,
                                     Integers integers) {
    const auto found = place.primitive.attributes.find(attribute);
    if (found == place.primitive.attributes.end()) { return std::nullopt; }
    const gltf::Accessor& accessor = place.model.accessors[found->second];
    const std::string name = fmt::format("{}: {} (accessors[{}])", place.name, attribute, found->second);
    check(accessor.components == components ||
              (components == 4 && attribute == "COLOR_0" && accessor.components == 3),
          "{}: has {} components a splat, expected {}", name, accessor.components, components);
    check(!accessor.is_sparse, "{}: is sparse, expected one value after the other", name);
    const bool is_float = accessor.component == gltf::Component::kFloat32;
    check(is_float || (integers != Integers::kNone && (integers == Integers::kAny || accessor.normalized)),
          "{}: holds {}integers, expected {}", name, accessor.normalized ? "normalized " : "",
          integers == Integers::kNone ? "floats" : "floats or normalized integers");
    check(accessor.view.has_value(), "{}: has no bufferView; compressed splats cannot be read", name);
    const gltf::BufferView& view = place.model.views[*accessor.view];
    const GltfBuffer& buffer = place.buffers[view.buffer];
    const std::uint64_t row = componentBytes(accessor.component) *
                              static_cast<std::uint64_t>(accessor.components),
                        stride = view.stride == 0 ? row : view.stride, size = buffer.sizeBytes();
    check(view.offset <= size && view.bytes <= size - view.offset,
          "{}: bufferViews[{}] ends beyond its buffer of {} bytes", name, *accessor.view, size);
    const bool fits =
        accessor.count == 0 ||
        (stride >= row && accessor.offset <= view.bytes && row <= view.bytes - accessor.offset &&
         (accessor.count - 1) <= (view.bytes - accessor.offset - row) / stride);
    check(fits,
          "{}: {} values of {} bytes, {} apart, from byte {} on do not fit the {} bytes of bufferViews[{}]",
          name, accessor.count, row, stride, accessor.offset, view.bytes, *accessor.view);
    return GltfColumn(buffer, view.offset + accessor.offset, stride, accessor);
}

GltfColumn requireColumn(const Place& place, const std::string& attribute, int components,
                         Integers integers) {
    std::optional<GltfColumn> column = findColumn(place, attribute, components, integers);
    check(column.has_value(), "{}: has no attribute {}, expected one", place.name, attribute);
    return std::move(*column);
}

// All coefficients of the degrees in the file; each degree must be whole, with none missing below it.
std::vector<GltfColumn> findHarmonics(const Place& place) {
    std::vector<GltfColumn> columns;
    int degree = -1;
    for (int band = 0; band <= kMaxShDegree; ++band) {
        for (int k = 0; k <= 2 * band; ++k) {
            const std::string attribute = fmt::format("{}SH_DEGREE_{}_COEF_{}", kPrefix, band, k);
            std::optional<GltfColumn> column = findColumn(place, attribute, 3, Integers::kNormalized);
            if (!column && k == 0) { break; }
            check(column.has_value(), "{}: has no attribute {}, expected all of its degree", place.name,
                  attribute);
            check(degree >= band - 1,
                  "{}: has harmonics of degree {}, but none of degree {}, expected all below", place.name,
                  band, degree + 1);
            degree = band;
            columns.push_back(std::move(*column));
        }
    }
    return columns;
}

GltfSplats openSplats(const Place& place, const glm::dmat4& world_from_node) {
    check(place.primitive.is_points, "{}: its mode is another, expected 0 (points)", place.name);
    for (const std::string& extension : place.primitive.splatting->extensions) {
        check(extension.find("compression") == std::string::npos,
              "{}: is compressed by {}, which cannot be read", place.name, extension);
    }
    const std::string prefix = kPrefix;
    GltfSplats splats{requireColumn(place, "POSITION", 3, Integers::kAny),
                      requireColumn(place, prefix + "ROTATION", 4, Integers::kNormalized),
                      requireColumn(place, prefix + "SCALE", 3, Integers::kAny),
                      requireColumn(place, prefix + "OPACITY", 1, Integers::kNormalized),
                      findHarmonics(place),
                      std::nullopt,
                      world_from_node,
                      false};
    if (splats.sh.empty()) { splats.colour = findColumn(place, "COLOR_0", 4, Integers::kNormalized); }
    check(!splats.sh.empty() || splats.colour,
          "{}: has neither {}SH_DEGREE_0_COEF_0 nor COLOR_0, expected colours", place.name, kPrefix);
    const auto requireCount = [&](const GltfColumn& column) {
        check(column.count() == splats.count(),
              "{}: has {} positions and {} values of another attribute, expected as many", place.name,
              splats.count(), column.count());
    };
    for (const GltfColumn* column : {&splats.rotation, &splats.scale, &splats.opacity}) {
        requireCount(*column);
    }
    for (const GltfColumn& column : splats.sh) { requireCount(column); }
    if (splats.colour) { requireCount(*splats.colour); }
    return splats;
}

// What the primitives ask for, and which of it is unknown.
class Wishes {
public:
    explicit Wishes(const std::string& file) : file_(file) {}

    static bool isLinear(const gltf::Splatting& asked) { return asked.colour_space == kLinear; }

    void add(const gltf::Splatting& asked, std::uint64_t splats) {
        const auto noteOther = [&](const char* key, const std::string& value, std::string_view known,
                                   const char* instead) {
            if (value != known && !value.empty()) {
                others_.insert(
                    fmt::format("{}: {} is {}, which is not known: {}", file_, key, value, instead));
            }
        };
        noteOther("kernel", asked.kernel, "ellipse", "drawn as ellipse");
        noteOther("projection", asked.projection, "perspective", "drawn as perspective");
        if (isLinear(asked)) {
            linear_ += splats;
        } else {
            encoded_ += splats;
            noteOther("colorSpace", asked.colour_space, kEncoded, "shown as srgb_rec709_display");
        }
        if (asked.sorting == "zDepth") {
            by_depth_ = true;
        } else {
            by_distance_ = true;
            noteOther("sortingMethod", asked.sorting, "cameraDistance", "sorted as cameraDistance");
        }
    }

    void finish(GltfDocument& document) {
        // Splats are blended in one colour space; the smaller group is converted to the other's.
        document.is_linear = linear_ > encoded_;
        if (linear_ > 0 && encoded_ > 0) {
            const auto [kept, converted] =
                document.is_linear ? std::pair(kLinear, kEncoded) : std::pair(kEncoded, kLinear);
            others_.insert(
                fmt::format("{}: {} of {} splats have colours in {} and were converted to {}, that of the "
                            "others, in which all are blended; "
                            "where a colour depends on the direction, approximately",
                            file_, std::min(linear_, encoded_), linear_ + encoded_, converted, kept));
        }
        document.by_distance = by_distance_;
        if (by_distance_ && by_depth_) {
            others_.insert(
                fmt::format("{}: two values of sortingMethod, all sorted as cameraDistance", file_));
        }
        document.notes.insert(document.notes.end(), others_.begin(), others_.end());
    }

private:
    static constexpr const char *kLinear = "lin_rec709_display", *kEncoded = "srgb_rec709_display";

    const std::string& file_;
    std::uint64_t linear_ = 0, encoded_ = 0;  // splats
    bool by_distance_ = false, by_depth_ = false;
    std::set<std::string> others_;
};

// Walks the scene's nodes, each of which has at most one parent.
void placeParts(const gltf::Model& model, const std::string& file, GltfDocument& document) {
    std::vector<std::pair<std::size_t, glm::dmat4>> open;
    for (const std::size_t root : model.roots) { open.emplace_back(root, glm::dmat4(1.0)); }
    std::reverse(open.begin(), open.end());
    std::vector<bool> seen(model.nodes.size(), false);
    std::uint64_t left_out = 0, primitives_met = 0;
    Wishes wishes(file);
    while (!open.empty()) {
        const auto [index, world_from_parent] = open.back();
        open.pop_back();
        check(!seen[index], "{}: nodes[{}]: is a child twice, expected a tree", file, index);
        seen[index] = true;
        const gltf::Node& node = model.nodes[index];
        const glm::dmat4 world_from_node = world_from_parent * node.parent_from_node;
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            open.emplace_back(*child, world_from_node);
        }
        if (!node.mesh) { continue; }
        const std::vector<gltf::Primitive>& primitives = model.meshes[*node.mesh];
        primitives_met += primitives.size();
        check(primitives_met <= kMostPrimitives,
              "{}: its nodes have {} primitives and more, expected at most {}", file, primitives_met,
              kMostPrimitives);
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            if (!primitives[i].splatting) {
                ++left_out;
                continue;
            }
            const Place place{model, document.buffers, primitives[i],
                              fmt::format("{}: meshes[{}].primitives[{}]", file, *node.mesh, i)};
            const glm::dmat3 linear(world_from_node);
            check(std::abs(glm::determinant(linear)) > 1e-30 && std::isfinite(glm::determinant(linear)),
                  "{}: nodes[{}]: its transform has no inverse, expected splats that keep their extent", file,
                  index);
            document.parts.push_back(openSplats(place, world_from_node));
            document.parts.back().is_linear = Wishes::isLinear(*primitives[i].splatting);
            wishes.add(*primitives[i].splatting, document.parts.back().count());
        }
    }
    check(!document.parts.empty(),
          "{}: a glTF without splats: none of its {} primitives has the extension KHR_gaussian_splatting",
          file, left_out);
    if (left_out > 0) {
        document.notes.push_back(
            fmt::format("{}: {} primitives without KHR_gaussian_splatting (meshes, points) were left out",
                        file, left_out));
    }
    wishes.finish(document);
}

}  // namespace

void GltfColumn::read(std::uint64_t first, std::size_t rows, std::vector<float>& values) const {
    const auto width = static_cast<std::size_t>(accessor_.components);
    values.resize(rows * width);
    if (rows == 0) { return; }
    const std::uint64_t item = componentBytes(accessor_.component);
    bytes_.resize((rows - 1) * stride_ + width * item);
    buffer_->read(offset_ + first * stride_, bytes_);
    const auto convert = [&]<typename T>(T /*type*/, float most) {
        for (std::size_t row = 0; row < rows; ++row) {
            for (std::size_t i = 0; i < width; ++i) {
                const auto value = static_cast<float>(loadLittle<T>(bytes_, row * stride_ + i * sizeof(T)));
                values[row * width + i] = accessor_.normalized ? std::max(value / most, -1.0f) : value;
            }
        }
    };
    switch (accessor_.component) {
        case gltf::Component::kInt8:
            return convert(std::int8_t{}, 127.0f);
        case gltf::Component::kUint8:
            return convert(std::uint8_t{}, 255.0f);
        case gltf::Component::kInt16:
            return convert(std::int16_t{}, 32767.0f);
        case gltf::Component::kUint16:
            return convert(std::uint16_t{}, 65535.0f);
        case gltf::Component::kUint32:
            return convert(std::uint32_t{}, 4294967295.0f);
        case gltf::Component::kFloat32:
            for (std::size_t row = 0; row < rows; ++row) {
                for (std::size_t i = 0; i < width; ++i) {
                    values[row * width + i] = loadLittle<float>(bytes_, row * stride_ + 4 * i);
                }
            }
    }
}

GltfDocument openGltf(InputFile& file) {
    Content content = readContent(file);
    const nlohmann::json document = parseJson(content.text, file.name(), "a glTF scene");
    content.text = {};
    const gltf::Model model = gltf::parse(document, file.name());
    for (const std::string& extension : model.required_extensions) {
        check(extension == "KHR_gaussian_splatting" || extension == "KHR_mesh_quantization",
              "{}: requires the extension {}, which is not known", file.name(), extension.substr(0, 100));
    }
    GltfDocument result;
    result.buffers = openBuffers(file, document, std::move(content.chunk));
    result.bytes = file.sizeBytes();
    for (const GltfBuffer& buffer : result.buffers) { result.bytes += buffer.sizeBytes(); }
    placeParts(model, file.name(), result);
    for (const GltfSplats& part : result.parts) {
        while (static_cast<std::size_t>(shCoefficientCount(result.sh_degree)) < part.sh.size()) {
            ++result.sh_degree;
        }
    }
    return result;
}

}  // namespace binosplat
