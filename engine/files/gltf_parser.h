// The structure of a glTF, without the bytes of its buffers.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace binosplat::gltf {

struct BufferView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0, bytes = 0, stride = 0;  // stride 0: one value after the other
};

// As the format numbers them.
enum class Component {
    kInt8 = 5120,
    kUint8 = 5121,
    kInt16 = 5122,
    kUint16 = 5123,
    kUint32 = 5125,
    kFloat32 = 5126
};

struct Accessor {
    std::optional<std::size_t> view;
    std::uint64_t offset = 0, count = 0;
    Component component = Component::kFloat32;
    bool normalized = false, is_sparse = false;
    int components = 0;  // 1 of a SCALAR, 2 to 4 of a VEC, 0 of a matrix
};

// The extension's keys; empty if absent.
struct Splatting {
    std::string kernel, colour_space, projection, sorting;
    std::vector<std::string> extensions;  // of the extension
};

struct Primitive {
    std::map<std::string, std::size_t> attributes;
    bool is_points = false;
    std::optional<Splatting> splatting;
};

struct Node {
    glm::dmat4 parent_from_node{1.0};
    std::optional<std::size_t> mesh;
    std::vector<std::size_t> children;
};

struct Model {
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<std::vector<Primitive>> meshes;
    std::vector<Node> nodes;
    std::vector<std::size_t> roots;  // of the default scene
    std::vector<std::string> required_extensions;
};

// `file` is the name for messages. Every index in the model is valid for its arrays, or for the document's
// buffers.
Model parse(const nlohmann::json& document, const std::string& file);

}  // namespace binosplat::gltf
