// The panel's picture, in every format that runtimes have.
#include "app/view/panel/canvas.h"
#include "app/view/panel/panel_content.h"
#include "app/view/panel/panel_style.h"
#include "tests/engine/gpu/device_image.h"

SUITE(canvas) {

TEST_CASE_FIXTURE(Gpu, "the panel has the same colours where the runtime has no sRGB images, as light") {
    const auto drawn = [&](vk::Format format) {
        Canvas canvas(context(), kPanelPx, format);
        ViewSettings settings;
        SceneChooser chooser;
        PanelStatus status;
        status.has_scene = true;
        canvas.begin({}, 0.01);
        static_cast<void>(drawPanel(kPanelPx, settings, chooser, status));
        canvas.end();
        const test::DeviceImage image(context(), kPanelPx, format);
        const Buffer bytes = allocate<std::uint32_t>("panel", std::size_t{kPanelPx.x} * kPanelPx.y);
        run([&](Commands& commands) {
            canvas.record(commands);
            canvas.copyTo(commands, *image.image);
            image.copyLevel(commands, 0, kPanelPx, bytes, 0);
        });
        return readBack<std::uint32_t>(bytes, std::size_t{kPanelPx.x} * kPanelPx.y);
    };
    using Format = vk::Format;
    for (const auto& [encoded, linear] : {std::pair(Format::eR8G8B8A8Srgb, Format::eR8G8B8A8Unorm),
                                          std::pair(Format::eB8G8R8A8Srgb, Format::eB8G8R8A8Unorm)}) {
        const std::vector<std::uint32_t> seen = drawn(encoded), light = drawn(linear);
        std::set<std::uint32_t> colours;
        double farthest = 0.0;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            colours.insert(seen[i]);
            for (const int shift : {0, 8, 16}) {
                const double value = (seen[i] >> shift & 255) / 255.0;
                const double expected =
                    value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
                farthest = std::max(farthest, std::abs((light[i] >> shift & 255) - 255.0 * expected));
            }
        }
        // Its edges and round corners lie within the picture, so that compositors smooth them.
        for (const std::vector<std::uint32_t>& picture : {seen, light}) {
            const auto alpha = [&](glm::uint x, glm::uint y) { return picture[y * kPanelPx.x + x] >> 24; };
            const glm::uvec2 middle = kPanelPx / 2u, last = kPanelPx - 1u;
            CHECK(these(alpha(1, middle.y), alpha(middle.x, 1), alpha(4, 4)) == these(0u, 0u, 0u));
            CHECK(these(alpha(last.x, middle.y), alpha(middle.x, last.y)) == these(0u, 0u));
            CHECK(these(alpha(3, middle.y), alpha(middle.x, last.y - 3), alpha(9, 9)) ==
                  these(255u, 255u, 255u));
        }
        CHECK(colours.size() > 20);
        CHECK(farthest < 1.0);
    }
}

}  // SUITE(canvas)
