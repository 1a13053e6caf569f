// glTF files made to measure.
#pragma once

#include "tests/engine/files/packed_bytes.h"
#include "tests/engine/files/ply_files.h"

#include <fmt/ranges.h>

namespace binosplat::test {

// The format's numbers for component types.
inline constexpr int kGltfInt8 = 5120, kGltfUint8 = 5121, kGltfInt16 = 5122, kGltfUint16 = 5123,
                     kGltfFloat = 5126;

class GltfText {
public:
    static inline const std::string kPrefix = "KHR_gaussian_splatting:";
    std::string extension = R"({"kernel":"ellipse","colorSpace":"srgb_rec709_display"})",
                nodes = R"([{"mesh":0}])", roots = "[0]", other_primitives, other_keys;
    int mode = 0;

    // Adds an attribute to the splats' primitive; one of the extension is given by the end of its name.
    void add(const std::string& name, const std::string& type, std::vector<double> values,
             int component = kGltfFloat, bool normalized = false) {
        const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
        while (binary_.size() % 4 != 0) { binary_ += '\0'; }
        const std::size_t begin = binary_.size();
        const char* types[] = {"int8", "uint8", "int16", "uint16", "", "uint", "float"};
        for (const double value : values) {
            appendTyped(binary_, types[component - kGltfInt8], value, Encoding::kLittle);
        }
        const bool is_own = name == "POSITION" || name == "COLOR_0";
        const std::size_t index = attributes_[is_own ? name : kPrefix + name] = views_.size();
        views_.push_back(
            fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", begin, binary_.size() - begin));
        accessors_.push_back(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                                         index, component, values.size() / width, type,
                                         normalized ? R"(,"normalized":true)" : ""));
    }
    void remove(const std::string& name) { attributes_.erase(kPrefix + name); }

    [[nodiscard]] const std::string& binary() const { return binary_; }
    // `buffer` describes the only buffer, without its length.
    [[nodiscard]] std::string json(const std::string& buffer) const {
        std::vector<std::string> attributes;
        for (const auto& [name, index] : attributes_) {
            attributes.push_back(fmt::format("\"{}\":{}", name, index));
        }
        return fmt::format(
            R"({{"asset":{{"version":"2.0"}},"extensionsUsed":["KHR_gaussian_splatting"],"scene":0,)"
            R"("scenes":[{{"nodes":{}}}],"nodes":{},)"
            R"("meshes":[{{"primitives":[{{"mode":{},"attributes":{{{}}},)"
            R"("extensions":{{"KHR_gaussian_splatting":{}}}}}{}]}}],)"
            R"("buffers":[{{"byteLength":{}{}}}],"bufferViews":[{}],"accessors":[{}]{}}})",
            roots, nodes, mode, fmt::join(attributes, ","), extension, other_primitives, binary_.size(),
            buffer, fmt::join(views_, ","), fmt::join(accessors_, ","), other_keys);
    }
    [[nodiscard]] std::string glb() const { return makeGlb(json(""), binary_); }
    [[nodiscard]] std::string embedded() const {
        return json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(binary_) + "\"");
    }

    static std::string makeGlb(std::string text, std::string binary) {
        while (text.size() % 4 != 0) { text += ' '; }
        while (binary.size() % 4 != 0) { binary += '\0'; }
        return "glTF" + littleWord(2) + littleWord(28 + text.size() + binary.size()) +
               littleWord(text.size()) + "JSON" + text + littleWord(binary.size()) + std::string("BIN\0", 4) +
               binary;
    }

private:
    static std::string base64(const std::string& bytes) {
        static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            unsigned word = 0;
            for (std::size_t j = 0; j < 3; ++j) {
                word = word << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
            }
            for (std::size_t j = 0; j < 4; ++j) {
                text += i + j > bytes.size() ? '=' : kLetters[word >> (18 - 6 * j) & 63u];
            }
        }
        return text;
    }

    std::string binary_;
    std::vector<std::string> views_, accessors_;
    std::map<std::string, std::size_t> attributes_;
};

// Three splats, the same as makePly(rest_count, true).
inline GltfText makeGltf(int rest_count = 9) {
    PlyText ply = makePly(rest_count, true);
    GltfText gltf;
    const auto gather = [&](std::initializer_list<std::string> names, auto&& activate) {
        std::vector<double> values;
        for (std::size_t splat = 0; splat < 3; ++splat) {
            for (const std::string& name : names) { values.push_back(activate(ply[name].values[splat])); }
        }
        return values;
    };
    const std::identity same;
    gltf.add("POSITION", "VEC3", gather({"x", "y", "z"}, same));
    gltf.add("ROTATION", "VEC4", gather({"rot_1", "rot_2", "rot_3", "rot_0"}, same));
    gltf.add("SCALE", "VEC3",
             gather({"scale_0", "scale_1", "scale_2"}, [](double value) { return std::exp(value); }));
    gltf.add("OPACITY", "SCALAR",
             gather({"opacity"}, [](double value) { return 1.0 / (1.0 + std::exp(-value)); }));
    gltf.add("SH_DEGREE_0_COEF_0", "VEC3", gather({"f_dc_0", "f_dc_1", "f_dc_2"}, same));
    const int per_channel = rest_count / 3;
    for (int k = 1; k <= per_channel; ++k) {
        const int degree = k < 4 ? 1 : k < 9 ? 2 : 3;
        const auto rest = [&](int channel) {
            return fmt::format("f_rest_{}", channel * per_channel + k - 1);
        };
        gltf.add(fmt::format("SH_DEGREE_{}_COEF_{}", degree, k - degree * degree), "VEC3",
                 gather({rest(0), rest(1), rest(2)}, same));
    }
    return gltf;
}

}  // namespace binosplat::test
