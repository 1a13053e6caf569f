// `binosplat view`: a scene in a headset.
#include "app/commands.h"
#include "app/device_options.h"
#include "app/mirror_window.h"
#include "app/simulate.h"
#include "app/viewer.h"
#include "engine/error.h"

namespace binosplat {

void runView(const ViewOptions& given) {
    ViewOptions options = given;
    if (options.simulate) { simulateHeadset(options); }
    const xr::Instance instance;
    ContextOptions context_options = contextOptions(options.run);
    context_options.maker = instance.deviceMaker();
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    if (windows) {
        context_options.instance_extensions = WindowSystem::instanceExtensions();
        context_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    }
    const Context context(context_options);
    {
        xr::Session session(instance, context);
        const glm::uvec2 size_px = instance.recommendedSizePx();
        fmt::print("{}, {}x{} per eye, on {}\n", instance.description(), size_px.x, size_px.y, context.deviceName());
        Viewer(options, session, windows != nullptr).run();
    }
    if (!options.out.empty()) { fmt::print("what the wearer saw: {}\n", options.out.string()); }
    context.requireNoValidationMessages();
}

}  // namespace binosplat
