// `binosplat view`: a scene in a headset.
#include "app/commands.h"
#include "app/mirror_window.h"
#include "app/simulate.h"
#include "app/viewer.h"
#include "engine/error.h"

namespace binosplat {

namespace {

// The validation layers are for finding our mistakes: what they say is an error, not a remark.
void requireNoValidationMessages(const Context& context) {
    const std::vector<std::string> messages = context.validationMessages();
    check(messages.empty(), "Vulkan validation: {} messages, the first: {}", messages.size(), messages.empty() ? "" : messages.front());
}

}  // namespace

void runView(const ViewOptions& given) {
    ViewOptions options = given;
    if (options.simulate) { simulateHeadset(options); }
    const xr::Instance instance;
    ContextOptions context_options;
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
    requireNoValidationMessages(context);
}

}  // namespace binosplat
