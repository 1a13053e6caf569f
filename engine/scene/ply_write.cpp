// Writing of PLY: inverse activations into blocks, a temporary file beside the target, one rename at the end.
#include "engine/error.h"
#include "engine/scene/ply.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace binosplat {

namespace {

// The half-written file: gone with this object unless it was renamed to its target.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& target) : target_(target), path_(fmt::format("{}.part{}", target, ::getpid())) {
        std::error_code unreadable;  // opening says why
        check(!std::filesystem::is_directory(target, unreadable), "{}: is a directory, expected a file name to write to", target);
        // Renaming over a device would replace it.
        const bool plain = !std::filesystem::exists(target, unreadable) || std::filesystem::is_regular_file(target, unreadable);
        check(plain, "{}: is not a regular file, expected a file name to write to", target);
        file_ = std::fopen(path_.c_str(), "wb");
        check(file_ != nullptr, "{}: cannot be written: {}", target, std::strerror(errno));
    }
    ~TemporaryFile() {
        if (file_ != nullptr) { std::fclose(file_); }
        if (!renamed_) { std::remove(path_.c_str()); }
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(const void* data, std::size_t bytes) {
        check(std::fwrite(data, 1, bytes, file_) == bytes, "{}: writing failed: {}", target_, std::strerror(errno));
    }
    void commit() {
        const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
        check(closed, "{}: writing failed: {}", target_, std::strerror(errno));
        check(std::rename(path_.c_str(), target_.c_str()) == 0, "{}: cannot be put in place: {}", target_, std::strerror(errno));
        renamed_ = true;
    }

private:
    std::string target_, path_;
    std::FILE* file_ = nullptr;
    bool renamed_ = false;
};

// sigmoid(+-100) and exp(-200) are exactly 1, 0 and 0 in float32.
float storedOpacity(float opacity) {
    if (!(opacity > 0.0f)) { return -100.0f; }
    if (opacity >= 1.0f) { return 100.0f; }
    const double o = opacity;
    return static_cast<float>(std::log(o / (1.0 - o)));
}
float storedScale(float scale) { return scale > 0.0f ? std::log(scale) : -200.0f; }

std::string makeHeader(const Scene& scene) {
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", scene.size());
    const auto property = [&header](const std::string& name) { header += "property float " + name + "\n"; };
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) { property(name); }
    for (int i = 0; i < 3 * (shCoefficientCount(scene.sh_degree) - 1); ++i) { property(fmt::format("f_rest_{}", i)); }
    for (const char* name : {"opacity", "scale_0", "scale_1", "rot_0", "rot_1", "rot_2", "rot_3"}) { property(name); }
    return header + "end_header\n";
}

// Appends one splat's row; returns the place behind it.
float* putRow(const Scene& scene, std::size_t splat, float* row) {
    const auto put = [&row](std::initializer_list<float> values) { row = std::copy(values.begin(), values.end(), row); };
    const glm::vec3& p = scene.positions[splat];
    const glm::quat& q = scene.rotations[splat];
    const glm::vec3 normal = q * glm::vec3(0.0f, 0.0f, 1.0f);
    const auto coefficients = static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
    const float* sh = scene.sh.data() + splat * coefficients * 3;
    put({p.x, p.y, p.z, normal.x, normal.y, normal.z, sh[0], sh[1], sh[2]});
    for (std::size_t channel = 0; channel < 3; ++channel) {
        for (std::size_t k = 1; k < coefficients; ++k) { *row++ = sh[3 * k + channel]; }
    }
    put({storedOpacity(scene.opacities[splat]), storedScale(scene.scales[splat].x), storedScale(scene.scales[splat].y), q.w, q.x, q.y,
         q.z});
    return row;
}

}  // namespace

void writePly(const Scene& scene, const std::string& path, const Progress& progress) {
    TemporaryFile file(path);
    const std::string header = makeHeader(scene);
    file.write(header.data(), header.size());

    constexpr std::size_t kBlockRows = 4096;
    const std::size_t width = 16 + 3 * (static_cast<std::size_t>(shCoefficientCount(scene.sh_degree)) - 1);
    std::vector<float> rows(kBlockRows * width);
    for (std::size_t done = 0; done < scene.size();) {
        if (progress) { progress(static_cast<double>(done) / static_cast<double>(scene.size())); }
        const std::size_t end = std::min(scene.size(), done + kBlockRows);
        float* row = rows.data();
        for (; done < end; ++done) { row = putRow(scene, done, row); }
        const auto count = static_cast<std::size_t>(row - rows.data());
        if constexpr (std::endian::native == std::endian::big) {
            for (float& value : rows) {
                auto bytes = std::bit_cast<std::array<std::byte, 4>>(value);
                std::reverse(bytes.begin(), bytes.end());
                value = std::bit_cast<float>(bytes);
            }
        }
        file.write(rows.data(), count * sizeof(float));
    }
    file.commit();
    if (progress) { progress(1.0); }
}

}  // namespace binosplat
