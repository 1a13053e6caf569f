// From tinygltf's model to ours, with every index checked: the library takes any.
#include "engine/scene/gltf_parser.h"

#include "engine/error.h"

#ifdef BINOSPLAT_GLTF

#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>  // which the library leaves out without its files

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace binosplat {

void requireGltfParser(const std::string& /*source*/) {}

namespace gltf {

namespace {

constexpr const char* kExtension = "KHR_gaussian_splatting";

std::size_t indexOf(int index, std::size_t size, const std::string& place, const char* what) {
    check(index >= 0 && static_cast<std::size_t>(index) < size, "{}: names {} {} of {}", place, what, index, size);
    return static_cast<std::size_t>(index);
}

BufferView viewOf(const tinygltf::BufferView& view, std::size_t buffers, const std::string& place) {
    return {indexOf(view.buffer, buffers, place, "buffer"), view.byteOffset, view.byteLength, view.byteStride};
}

Accessor accessorOf(const tinygltf::Accessor& accessor, std::size_t views, const std::string& place) {
    Accessor result;
    if (accessor.bufferView != -1) { result.view = indexOf(accessor.bufferView, views, place, "bufferView"); }
    result.offset = accessor.byteOffset;
    result.count = accessor.count;
    const int type = accessor.componentType;
    check(type == 5120 || type == 5121 || type == 5122 || type == 5123 || type == 5125 || type == 5126,
          "{}: componentType is {}, expected 5120 to 5123, 5125 or 5126", place, type);
    result.component = static_cast<Component>(type);
    result.normalized = accessor.normalized;
    result.is_sparse = accessor.sparse.isSparse;
    const bool is_matrix = accessor.type >= TINYGLTF_TYPE_MAT2 && accessor.type <= TINYGLTF_TYPE_MAT4;
    result.components = is_matrix ? 0 : tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    return result;
}

std::string textOf(const tinygltf::Value& object, const char* key) {
    const tinygltf::Value& value = object.Get(std::string(key));
    return value.IsString() ? value.Get<std::string>() : "";
}

Primitive primitiveOf(const tinygltf::Primitive& primitive, std::size_t accessors, const std::string& place) {
    Primitive result;
    for (const auto& [name, index] : primitive.attributes) {
        result.attributes.emplace(name, indexOf(index, accessors, place, "accessor"));
    }
    result.is_points = primitive.mode == TINYGLTF_MODE_POINTS;
    if (const auto found = primitive.extensions.find(kExtension); found != primitive.extensions.end()) {
        const tinygltf::Value& value = found->second;
        check(value.IsObject(), "{}: {} is no object, expected one", place, kExtension);
        result.splatting = Splatting{
            textOf(value, "kernel"), textOf(value, "colorSpace"), textOf(value, "projection"), textOf(value, "sortingMethod"), {}};
        if (value.Get("extensions").IsObject()) { result.splatting->extensions = value.Get("extensions").Keys(); }
    }
    return result;
}

glm::dmat4 transformOf(const tinygltf::Node& node, const std::string& place) {
    const auto requireSize = [&](const std::vector<double>& values, std::size_t size, const char* what) {
        check(values.empty() || values.size() == size, "{}: {} has {} numbers, expected {}", place, what, values.size(), size);
        check(std::ranges::all_of(values, [](double v) { return std::abs(v) < 1e30; }), "{}: {} has a number over 1e30", place, what);
    };
    requireSize(node.matrix, 16, "matrix");
    requireSize(node.translation, 3, "translation");
    requireSize(node.rotation, 4, "rotation");
    requireSize(node.scale, 3, "scale");
    glm::dmat4 transform(1.0);
    if (!node.matrix.empty()) {
        for (int i = 0; i < 16; ++i) { transform[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)]; }
        return transform;
    }
    if (!node.rotation.empty()) {
        glm::dquat rotation = glm::identity<glm::dquat>();
        rotation.x = node.rotation[0], rotation.y = node.rotation[1], rotation.z = node.rotation[2], rotation.w = node.rotation[3];
        check(glm::length(rotation) > 0.0, "{}: rotation has length 0, expected a unit quaternion", place);
        transform = glm::mat4_cast(glm::normalize(rotation));
    }
    for (int i = 0; i < 3; ++i) {
        if (!node.scale.empty()) { transform[i] *= node.scale[static_cast<std::size_t>(i)]; }
        if (!node.translation.empty()) { transform[3][i] = node.translation[static_cast<std::size_t>(i)]; }
    }
    return transform;
}

Node nodeOf(const tinygltf::Node& node, const tinygltf::Model& model, const std::string& place) {
    Node result;
    result.parent_from_node = transformOf(node, place);
    if (node.mesh != -1) { result.mesh = indexOf(node.mesh, model.meshes.size(), place, "mesh"); }
    for (const int child : node.children) { result.children.push_back(indexOf(child, model.nodes.size(), place, "node")); }
    return result;
}

}  // namespace

Model parse(const std::string& text, const std::string& file) {
    tinygltf::TinyGLTF parser;
    tinygltf::Model read;
    std::string errors, warnings;
    const bool whole = parser.LoadASCIIFromString(&read, &errors, &warnings, text.data(), static_cast<unsigned>(text.size()), "");
    check(whole, "{}: not a whole glTF 2.0: {}", file, errors.substr(0, 200));

    Model model;
    const auto each = [&](const auto& items, const char* name, auto&& put) {
        for (std::size_t i = 0; i < items.size(); ++i) { put(items[i], fmt::format("{}: {}[{}]", file, name, i)); }
    };
    each(read.bufferViews, "bufferViews",
         [&](const auto& view, const std::string& place) { model.views.push_back(viewOf(view, read.buffers.size(), place)); });
    each(read.accessors, "accessors", [&](const auto& accessor, const std::string& place) {
        model.accessors.push_back(accessorOf(accessor, read.bufferViews.size(), place));
    });
    each(read.meshes, "meshes", [&](const auto& mesh, const std::string& place) {
        std::vector<Primitive>& primitives = model.meshes.emplace_back();
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            primitives.push_back(primitiveOf(mesh.primitives[i], read.accessors.size(), fmt::format("{}.primitives[{}]", place, i)));
        }
    });
    each(read.nodes, "nodes", [&](const auto& node, const std::string& place) { model.nodes.push_back(nodeOf(node, read, place)); });
    model.required_extensions = read.extensionsRequired;

    if (read.scenes.empty()) {  // then every node without a parent counts
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const Node& node : model.nodes) {
            for (const std::size_t child : node.children) { is_child[child] = true; }
        }
        for (std::size_t i = 0; i < model.nodes.size(); ++i) {
            if (!is_child[i]) { model.roots.push_back(i); }
        }
        return model;
    }
    const std::size_t scene = read.defaultScene == -1 ? 0 : indexOf(read.defaultScene, read.scenes.size(), file, "scene");
    for (const int node : read.scenes[scene].nodes) {
        model.roots.push_back(indexOf(node, model.nodes.size(), fmt::format("{}: scenes[{}]", file, scene), "node"));
    }
    return model;
}

}  // namespace gltf

std::optional<std::vector<std::byte>> decodeDataUri(const std::string& uri) {
    std::vector<unsigned char> bytes;
    std::string type;
    if (!tinygltf::IsDataURI(uri) || !tinygltf::DecodeDataURI(&bytes, type, uri, 0, false)) { return std::nullopt; }
    const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
    return std::vector<std::byte>(begin, begin + bytes.size());
}

}  // namespace binosplat

#else

namespace binosplat {

void requireGltfParser(const std::string& source) {
    fail("{}: a glTF scene, which this build cannot read: configure with BINOSPLAT_GLTF=ON, or convert it to PLY or SPZ", source);
}
gltf::Model gltf::parse(const std::string& /*text*/, const std::string& file) { fail("{}: this build is without tinygltf", file); }
std::optional<std::vector<std::byte>> decodeDataUri(const std::string& /*uri*/) { return std::nullopt; }

}  // namespace binosplat

#endif
