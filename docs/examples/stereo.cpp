// Renders a scene for two eyes and writes left.png and right.png:
//   stereo SCENE [EYE_X EYE_Y EYE_Z LOOK_X LOOK_Y LOOK_Z]
#include <binosplat.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int count, char** words) {
    if (count != 2 && count != 8) {
        std::fprintf(stderr, "stereo SCENE [EYE_X EYE_Y EYE_Z LOOK_X LOOK_Y LOOK_Z]\n");
        return 2;
    }
    try {
        bsp::Device device;
        bsp::Scene scene(device, words[1]);
        scene.wait();
        std::printf("%llu splats on %s\n", static_cast<unsigned long long>(scene.properties().splats),
                    device.name().c_str());

        const double eye_distance = 0.063, fov_x_rad = 1.2;
        bsp::Views views = scene.startViews(eye_distance, fov_x_rad, 512, 384);
        if (count == 8) {
            const auto number = [&](int i) { return std::atof(words[i]); };
            const double eye[]{number(2), number(3), number(4)}, look[]{number(5), number(6), number(7)},
                up[]{0, -1, 0};
            views = bsp::lookAt(eye, look, up, eye_distance, fov_x_rad, 512, 384);
        }
        bsp::Renderer renderer(device);
        std::printf("%.2f ms\n", renderer.render(scene, views).gpu_ms);
        bsp::writePicture("left", renderer.colour(views[0], 0));
        bsp::writePicture("right", renderer.colour(views[1], 1));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stereo: %s\n", error.what());
        return 1;
    }
    return 0;
}
