// From JSON to the model, with every index checked.
#include "engine/files/gltf_parser.h"

#include "engine/error.h"
#include "engine/files/json_node.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace binosplat::gltf {

namespace {

constexpr const char* kExtension = "KHR_gaussian_splatting";

// The element at the index that `node` holds as `key`; there are `size` of them.
std::size_t indexOf(const JsonNode& index, std::size_t size, const std::string& place, const char* what) {
    const std::uint64_t value = index.count();
    check(value < size, "{}: names {} {} of {}", place, what, value, size);
    return value;
}

std::uint64_t countOr(const JsonNode& node, const char* key, std::uint64_t otherwise) {
    return node.has(key) ? node.at(key).count() : otherwise;
}

std::vector<std::size_t> indicesOf(const JsonNode& node, const char* key, std::size_t size,
                                   const char* what) {
    std::vector<std::size_t> indices;
    const std::size_t count = node.has(key) ? node.at(key).arraySize() : 0;
    for (std::size_t i = 0; i < count; ++i) {
        indices.push_back(indexOf(node.at(key).at(i), size, node.place(), what));
    }
    return indices;
}

std::string textOf(const JsonNode& node, const char* key) {
    return node.has(key) && node.at(key).value.is_string() ? node.at(key).text() : "";
}

BufferView viewOf(const JsonNode& node, std::size_t buffers) {
    const std::uint64_t stride = countOr(node, "byteStride", 0);
    check(stride <= 252, "{}: byteStride is {}, expected 4 to 252", node.place(), stride);
    return {indexOf(node.at("buffer"), buffers, node.place(), "buffer"), countOr(node, "byteOffset", 0),
            node.at("byteLength").count(), stride};
}

Accessor accessorOf(const JsonNode& node, std::size_t views) {
    Accessor result;
    if (node.has("bufferView")) {
        result.view = indexOf(node.at("bufferView"), views, node.place(), "bufferView");
    }
    result.offset = countOr(node, "byteOffset", 0);
    result.count = node.at("count").count();
    const std::uint64_t component = node.at("componentType").count();
    check((component >= 5120 && component <= 5123) || component == 5125 || component == 5126,
          "{}: componentType is {}, expected 5120 to 5123, 5125 or 5126", node.place(), component);
    result.component = static_cast<Component>(component);
    result.normalized = node.has("normalized") && node.at("normalized").flag();
    result.is_sparse = node.has("sparse");
    constexpr std::array<std::pair<std::string_view, int>, 7> kTypes{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 0}, {"MAT3", 0}, {"MAT4", 0}}};
    const std::string type = node.at("type").text();
    const auto* found = std::ranges::find(kTypes, type, &std::pair<std::string_view, int>::first);
    check(found != kTypes.end(), "{}: type is {}, expected SCALAR, VEC2 to VEC4 or MAT2 to MAT4",
          node.place(), type.substr(0, 40));
    result.components = found->second;
    return result;
}

Primitive primitiveOf(const JsonNode& node, std::size_t accessors) {
    Primitive result;
    if (node.has("attributes")) {
        const JsonNode attributes = node.at("attributes");
        attributes.requireObject();
        for (const auto& [name, index] : attributes.value.items()) {
            result.attributes.emplace(name,
                                      indexOf(attributes.at(name), accessors, node.place(), "accessor"));
        }
    }
    constexpr std::uint64_t kPoints = 0, kTriangles = 4;
    result.is_points = countOr(node, "mode", kTriangles) == kPoints;
    if (!node.has("extensions") || !node.at("extensions").has(kExtension)) { return result; }
    const JsonNode splatting = node.at("extensions").at(kExtension);
    splatting.requireObject();
    result.splatting = Splatting{textOf(splatting, "kernel"),
                                 textOf(splatting, "colorSpace"),
                                 textOf(splatting, "projection"),
                                 textOf(splatting, "sortingMethod"),
                                 {}};
    if (splatting.has("extensions")) {
        const JsonNode extensions = splatting.at("extensions");
        extensions.requireObject();
        for (const auto& [name, content] : extensions.value.items()) {
            result.splatting->extensions.push_back(name);
        }
    }
    return result;
}

// None: the node has none.
std::vector<double> numbersOf(const JsonNode& node, const char* key, std::size_t size) {
    std::vector<double> numbers;
    if (!node.has(key)) { return numbers; }
    const JsonNode array = node.at(key);
    array.requireArray(size);
    for (const nlohmann::json& value : array.value) {
        check(value.is_number() && std::abs(value.get<double>()) < 1e30,
              "{}: is {}, expected numbers under 1e30", array.place(), array.value.dump().substr(0, 200));
        numbers.push_back(value.get<double>());
    }
    return numbers;
}

glm::dmat4 transformOf(const JsonNode& node) {
    const std::vector<double> matrix = numbersOf(node, "matrix", 16),
                              translation = numbersOf(node, "translation", 3),
                              turn = numbersOf(node, "rotation", 4), scale = numbersOf(node, "scale", 3);
    glm::dmat4 transform(1.0);
    if (!matrix.empty()) {
        for (int i = 0; i < 16; ++i) { transform[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)]; }
        return transform;
    }
    if (!turn.empty()) {
        glm::dquat rotation = glm::identity<glm::dquat>();
        rotation.x = turn[0], rotation.y = turn[1], rotation.z = turn[2], rotation.w = turn[3];
        check(glm::length(rotation) > 0.0, "{}: rotation has length 0, expected a unit quaternion",
              node.place());
        transform = glm::mat4_cast(glm::normalize(rotation));
    }
    for (int i = 0; i < 3; ++i) {
        if (!scale.empty()) { transform[i] *= scale[static_cast<std::size_t>(i)]; }
        if (!translation.empty()) { transform[3][i] = translation[static_cast<std::size_t>(i)]; }
    }
    return transform;
}

Node nodeOf(const JsonNode& node, std::size_t meshes, std::size_t nodes) {
    Node result;
    result.parent_from_node = transformOf(node);
    if (node.has("mesh")) { result.mesh = indexOf(node.at("mesh"), meshes, node.place(), "mesh"); }
    result.children = indicesOf(node, "children", nodes, "node");
    return result;
}

}  // namespace

Model parse(const nlohmann::json& document, const std::string& file) {
    const JsonNode root{document, file};
    root.requireObject();
    const std::string version = root.at("asset").at("version").text();
    check(version.starts_with("2."), "{}: asset.version is {}, expected 2.0", file, version.substr(0, 40));

    Model model;
    const auto sizeOf = [&](const char* key) { return root.has(key) ? root.at(key).arraySize() : 0; };
    const auto each = [&](const char* key, auto&& put) {
        for (std::size_t i = 0; i < sizeOf(key); ++i) { put(root.at(key).at(i)); }
    };
    each("bufferViews",
         [&](const JsonNode& node) { model.views.push_back(viewOf(node, sizeOf("buffers"))); });
    each("accessors",
         [&](const JsonNode& node) { model.accessors.push_back(accessorOf(node, model.views.size())); });
    each("meshes", [&](const JsonNode& node) {
        std::vector<Primitive>& primitives = model.meshes.emplace_back();
        const JsonNode array = node.at("primitives");
        for (std::size_t i = 0; i < array.arraySize(); ++i) {
            primitives.push_back(primitiveOf(array.at(i), model.accessors.size()));
        }
    });
    each("nodes", [&](const JsonNode& node) {
        model.nodes.push_back(nodeOf(node, model.meshes.size(), sizeOf("nodes")));
    });
    each("extensionsRequired",
         [&](const JsonNode& node) { model.required_extensions.push_back(node.text()); });

    if (sizeOf("scenes") == 0) {  // then every node without a parent counts
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const Node& node : model.nodes) {
            for (const std::size_t child : node.children) { is_child[child] = true; }
        }
        for (std::size_t i = 0; i < model.nodes.size(); ++i) {
            if (!is_child[i]) { model.roots.push_back(i); }
        }
        return model;
    }
    const std::size_t scene =
        root.has("scene") ? indexOf(root.at("scene"), sizeOf("scenes"), file, "scene") : 0;
    model.roots = indicesOf(root.at("scenes").at(scene), "nodes", model.nodes.size(), "node");
    return model;
}

}  // namespace binosplat::gltf
