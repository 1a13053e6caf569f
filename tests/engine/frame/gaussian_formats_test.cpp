// One scene of 3D Gaussians in every format that holds one, and against pictures that another renderer made of it.
#include "engine/picture/image_io.h"
#include "engine/picture/metrics.h"
#include "engine/reference/reference.h"
#include "engine/scene/ply.h"
#include "engine/scene/spz.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/scene/ply_files.h"
#include "tests/shared_data.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

TEST_SUITE_BEGIN("gaussian_formats");

namespace gaussian_formats_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr double kShConstant = 0.28209479177387814;

const View kWhole{{0.0, -0.6, -1.6}, {0.0, -0.4, 0.0}, {0.0, -1.0, 0.0}, 60.0};
const View kNear{{0.3, -0.7, -0.8}, {0.0, -0.6, 0.0}, {0.0, -1.0, 0.0}, 90.0};

// The constant band alone, since .splat has no more.
Scene withoutHarmonics(const Scene& scene) {
    Scene plain = scene;
    const auto stride = static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree));
    plain.sh.clear();
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) { plain.sh.push_back(scene.sh[i * stride + channel]); }
    }
    plain.sh_degree = 0;
    return plain;
}

std::uint32_t level(double share, int bits) {
    const double most = static_cast<double>((1u << bits) - 1);
    return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * most));
}

template <typename T>
void put(std::string& bytes, T value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

// r, g, b, opacity, 0 to 1.
glm::dvec4 shownColour(const Scene& scene, std::size_t i) {
    glm::dvec4 colour(0.0, 0.0, 0.0, scene.opacities[i]);
    for (int channel = 0; channel < 3; ++channel) {
        colour[channel] = 0.5 + kShConstant * scene.sh[3 * i + static_cast<std::size_t>(channel)];
    }
    return colour;
}

glm::vec3 scalesOf(const Scene& scene, std::size_t i) { return {scene.scales[i], scene.thicknesses[i]}; }

// 32 bytes a splat: position, scales, colour, rotation.
std::string makeSplatFile(const Scene& scene) {
    std::string bytes;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) { put(bytes, scene.positions[i][axis]); }
        for (int axis = 0; axis < 3; ++axis) { put(bytes, scalesOf(scene, i)[axis]); }
        for (int channel = 0; channel < 4; ++channel) { put(bytes, static_cast<std::uint8_t>(level(shownColour(scene, i)[channel], 8))); }
        const glm::quat& q = scene.rotations[i];
        for (const float part : {q.w, q.x, q.y, q.z}) {
            put(bytes, static_cast<std::uint8_t>(std::clamp(std::lround(128.0f * part + 128.0f), 0l, 255l)));
        }
    }
    return bytes;
}

std::uint32_t packVector(const glm::dvec3& share) { return level(share.x, 11) << 21 | level(share.y, 10) << 11 | level(share.z, 11); }

std::uint32_t packRotation(const glm::quat& rotation) {
    std::array<float, 4> q{rotation.w, rotation.x, rotation.y, rotation.z};
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(q, {}, [](float part) { return std::abs(part); }) - q.begin());
    std::uint32_t word = static_cast<std::uint32_t>(largest);
    for (std::size_t i = 0; i < 4; ++i) {
        if (i != largest) { word = word << 10 | level(std::copysign(1.0, q[largest]) * q[i] / std::sqrt(2.0) + 0.5, 10); }
    }
    return word;
}

// PlayCanvas' compressed PLY: chunks of 256 splats relative to their bounds.
std::string makeCompressedPly(const Scene& scene) {
    const std::size_t chunks = (scene.size() + 255) / 256;
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement chunk {}\n", chunks);
    for (const char* what : {"", "scale_"}) {
        for (const char* end : {"min_", "max_"}) {
            for (const char* axis : {"x", "y", "z"}) { header += fmt::format("property float {}{}{}\n", end, what, axis); }
        }
    }
    header += fmt::format("element vertex {}\n", scene.size());
    for (const char* name : {"position", "rotation", "scale", "color"}) { header += fmt::format("property uint packed_{}\n", name); }
    std::string bounds, words;
    for (std::size_t first = 0; first < scene.size(); first += 256) {
        const std::size_t end = std::min(scene.size(), first + 256);
        glm::dvec3 low(1e9), high(-1e9), low_scale(1e9), high_scale(-1e9);
        for (std::size_t i = first; i < end; ++i) {
            const glm::dvec3 position(scene.positions[i]), scale(glm::log(glm::dvec3(scalesOf(scene, i))));
            low = glm::min(low, position), high = glm::max(high, position);
            low_scale = glm::min(low_scale, scale), high_scale = glm::max(high_scale, scale);
        }
        for (const glm::dvec3& bound : {low, high, low_scale, high_scale}) {
            for (int axis = 0; axis < 3; ++axis) { put(bounds, static_cast<float>(bound[axis])); }
        }
        for (std::size_t i = first; i < end; ++i) {
            put(words, packVector((glm::dvec3(scene.positions[i]) - low) / (high - low)));
            put(words, packRotation(scene.rotations[i]));
            put(words, packVector((glm::log(glm::dvec3(scalesOf(scene, i))) - low_scale) / (high_scale - low_scale)));
            const glm::dvec4 colour = shownColour(scene, i);
            put(words, level(colour.r, 8) << 24 | level(colour.g, 8) << 16 | level(colour.b, 8) << 8 | level(colour.a, 8));
        }
    }
    return header + "end_header\n" + bounds + words;
}

double psnrDb(const Scene& a, const Scene& b) {
    const Eye eye = eyeOf(kWhole, {256, 256});
    return compare(toImage(reference::render(a, eye, {})), toImage(reference::render(b, eye, {})), 3).psnrDb();
}

}  // namespace

TEST_CASE("a scene of 3D Gaussians is the same picture as PLY, SPZ, .splat and compressed PLY, but for what they round" *
          needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Folder folder;
    Scene scene = withoutHarmonics(loadScene((*data / "playbot/playbot_lod3_sog").string()));
    REQUIRE(scene.isGaussian3d());
    writePly(scene, folder.file("a.ply"));
    const Scene ply = loadScene(folder.file("a.ply"));
    writeSpz(scene, folder.file("a.spz"));
    const Scene spz = loadScene(folder.file("a.spz")), splat = loadScene(folder.write("a.splat", makeSplatFile(scene))),
                compressed = loadScene(folder.write("a.compressed.ply", makeCompressedPly(scene)));
    for (const Scene* other : {&ply, &spz, &splat, &compressed}) {
        REQUIRE(other->isGaussian3d());
        REQUIRE(other->size() == scene.size());
    }
    const double as_ply = psnrDb(scene, ply), as_spz = psnrDb(scene, spz), as_splat = psnrDb(scene, splat),
                 as_compressed = psnrDb(scene, compressed);
    MESSAGE(fmt::format("against SOG: PLY {:.1f} dB, SPZ {:.1f} dB, .splat {:.1f} dB, compressed PLY {:.1f} dB", as_ply, as_spz, as_splat,
                        as_compressed));
    CHECK(as_ply > 100.0);
    CHECK(as_spz > 40.0);
    CHECK(as_splat > 40.0);
    CHECK(as_compressed > 40.0);
    Scene flat = scene;
    LoadNotes notes;
    flatten(flat, notes);
    CHECK(psnrDb(scene, flat) < 35.0);  // so that the measure can fail
}

TEST_CASE("the flag of antialiased scenes goes through SPZ") {
    const Folder folder;
    for (const bool antialiased : {false, true}) {
        const Scene scene = viewGaussians({32, 32}, antialiased).scene;
        writeSpz(scene, folder.file("a.spz"));
        CHECK(loadScene(folder.file("a.spz")).antialiased == antialiased);
        std::filesystem::remove(folder.file("a.spz"));
    }
}

TEST_CASE_FIXTURE(Gpu, "twin and device draw the pictures of an independent renderer" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    Scene scene = loadScene((*data / "playbot/playbot_lod3_sog").string());
    FrameSettings settings;
    settings.mode = Mode::kMono;
    struct Case {
        std::string name;
        View view;
        bool antialiased;
    };
    for (const auto& [name, view, antialiased] :
         {Case{"playbot_lod3_3dgs.pfm", kWhole, false}, Case{"playbot_lod3_3dgs_near.pfm", kNear, false},
          Case{"playbot_lod3_3dgs_antialiased.pfm", kWhole, true}}) {
        CAPTURE(name);
        scene.antialiased = antialiased;
        const Eye eye = eyeOf(view, {400, 400});
        const Image theirs = readPicture(*data / "reference" / name);
        const double twin = compare(toImage(reference::render(scene, eye, {})), theirs, 3).psnrDb(),
                     device = compare(renderMono(context(), scene, eye, settings).picture, theirs, 3).psnrDb();
        MESSAGE(fmt::format("{}: twin {:.1f} dB, device {:.1f} dB", name, twin, device));
        CHECK(twin > 60.0);
        CHECK(device > 60.0);
    }
}

}  // namespace gaussian_formats_test
