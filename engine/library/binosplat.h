// The engine as a library: scenes of Gaussian splats, rendered for two eyes on a Vulkan device. This header is all of it; it needs only the
// standard library. With CMake: find_package(binosplat), then link binosplat::engine. An example: tests/packages/engine/stereo.cpp.
//
// Lengths are in the scene's units; angles in radians. Camera axes are OpenCV's: x right, y down, z forward. Whatever fails (a file, a
// value, the device, its memory) throws std::runtime_error, whose what() is one line: what is wrong, where, and what was expected. A
// Renderer is used by one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#if defined(__GNUC__) && !defined(_WIN32)
#define BINOSPLAT_API __attribute__((visibility("default")))
#else
#define BINOSPLAT_API
#endif

namespace binosplat::engine {

// How the two pictures are made; docs/how-it-works.md says what each does.
enum class Method {
    kTwoPass,    // both eyes in full, one after the other
    kShared,     // both eyes in full, culled and sorted together: the same pictures in less time
    kPaper,      // the right eye warped from the left one, its borders rendered again (Zhu and Zhou)
    kPredicted,  // and the tiles with the greatest expected error, up to the budget
    kTemporal,   // both eyes warped from the pair before, and such tiles of both; the first pair is kShared's
};

// An eye: where it is and what it sees.
struct View {
    std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};  // world from camera: a unit quaternion w, x, y, z
    std::array<double, 3> position{};                       // in the coordinates of the scene's file
    // Signed angles from the optical axis, as in OpenXR: of a usual eye, left and down are negative.
    double left_rad = -0.5, right_rad = 0.5, up_rad = 0.5, down_rad = -0.5;
};

// By eye: 0 is the left one, 1 the right one. They may be canted and have different angles.
using Views = std::array<View, 2>;

// Two eyes side by side, `eye_distance` apart about `eye`, with square pixels for pictures of `width` by `height`. `up` points up.
BINOSPLAT_API Views lookAt(const std::array<double, 3>& eye, const std::array<double, 3>& look, const std::array<double, 3>& up,
                           double eye_distance, double fov_x_rad, unsigned width, unsigned height);

struct Settings {
    Method method = Method::kPredicted;
    unsigned width = 1024, height = 1024;  // pixels of each eye, 1 to 16384
    double budget = 0.2;                   // 0 to 1: share of an eye's work (kPredicted) or of both eyes' (kTemporal) that mends the warp
    std::optional<double> near;            // nearest depth that is drawn, more than 0; absent: 0.2, or a fifth of a smaller scene's size
    std::array<double, 3> background{};    // red, green, blue, as they are displayed
    bool half_floats = false;              // pictures of 11 bits a value, for display: half the memory, and less time
};

// Rows from top to bottom, four floats a pixel: red, green, blue as they are displayed (sRGB, usually 0 to 1, not clamped) with the
// background behind them, and alpha, the share of the pixel that splats cover. values[(y * width + x) * 4 + channel].
struct Picture {
    unsigned width = 0, height = 0;
    std::vector<float> values;
};

class BINOSPLAT_API Renderer {
public:
    // Opens a Vulkan device: `device` is its number or a part of its name; empty: the first discrete GPU, or else the first that will do.
    explicit Renderer(const std::string& device = "");
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    // Loads a scene in place of the one before: a file of any format that the README lists, a folder, builtin:NAME, or an address on the
    // web of such a file (docs/web.md: what is sent and what is kept; needs libcurl). If it fails, the scene before stays.
    void load(const std::string& scene);

    [[nodiscard]] std::string deviceName() const;
    [[nodiscard]] std::size_t splatCount() const;
    // Where to begin, judged from the scene: a built-in scene's own view, else inside of a room or in front of an object.
    [[nodiscard]] Views startViews(double eye_distance, double fov_x_rad, unsigned width, unsigned height) const;

    // Renders a pair of the loaded scene and waits for it. For kTemporal call it frame after frame, with views that move little.
    void render(const Views& views, const Settings& settings = {});
    // From the last rendered pair; `eye` is 0 or 1.
    [[nodiscard]] Picture read(int eye);
    // Milliseconds that the device took for that pair; 0 if it has no timestamps.
    [[nodiscard]] double gpuMs() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// Writes a picture with 8 bits a channel and no alpha, as PNG (as PPM if the library was built without OpenImageIO and libpng), and returns
// the file's name. A failed write leaves no file.
BINOSPLAT_API std::filesystem::path writePicture(const std::filesystem::path& path_without_extension, const Picture& picture);

}  // namespace binosplat::engine
