// From the options to the window.
#include "app/desktop/desktop.h"

#include "app/desktop/desktop_shell.h"
#include "app/options/device_options.h"
#include "app/view/window/mirror_window.h"
#include "engine/error.h"

namespace binosplat {

void runDesktop(const ViewOptions& options, const ViewSettings& settings) {
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    if (windows == nullptr) {
        throw Error(ExitCode::kNoDevice, WindowSystem::whyNone() + "; use `binosplat render`");
    }
    ContextOptions context_options = contextOptions(options.run);
    context_options.instance_extensions = WindowSystem::instanceExtensions();
    context_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    const Context context(context_options);
    FrameLog::print(fmt::format("a window, on {}", context.deviceName()));
    DesktopShell(options, settings, context).run();
    context.requireNoValidationMessages();
}

}  // namespace binosplat
