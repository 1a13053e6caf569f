// Renders a scene for two eyes and writes left.png and right.png: stereo SCENE [EYE_X EYE_Y EYE_Z LOOK_X LOOK_Y LOOK_Z]
#include <binosplat.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace engine = binosplat::engine;

int main(int count, char** words) {
    if (count != 2 && count != 8) {
        std::fprintf(stderr, "stereo SCENE [EYE_X EYE_Y EYE_Z LOOK_X LOOK_Y LOOK_Z]\n");
        return 2;
    }
    try {
        engine::Renderer renderer;
        renderer.load(words[1]);
        std::printf("%zu splats on %s\n", renderer.splatCount(), renderer.deviceName().c_str());

        engine::Settings settings;
        settings.width = 512;
        settings.height = 384;
        const double eye_distance = 0.063, fov_x_rad = 1.2;
        engine::Views views = renderer.startViews(eye_distance, fov_x_rad, settings.width, settings.height);
        if (count == 8) {
            const auto number = [&](int i) { return std::atof(words[i]); };
            views = engine::lookAt({number(2), number(3), number(4)}, {number(5), number(6), number(7)}, {0, -1, 0}, eye_distance,
                                   fov_x_rad, settings.width, settings.height);
        }
        renderer.render(views, settings);
        std::printf("%.2f ms\n", renderer.gpuMs());
        engine::writePicture("left", renderer.read(0));
        engine::writePicture("right", renderer.read(1));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stereo: %s\n", error.what());
        return 1;
    }
    return 0;
}
