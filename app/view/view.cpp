// `binosplat view`: a scene in a headset.
#include "app/view/view.h"

#include "app/options/camera_options.h"
#include "app/options/device_options.h"
#include "app/terminal/interrupt.h"
#include "app/view/simulate.h"
#include "app/view/viewer.h"
#include "app/view/window/mirror_window.h"
#include "app/view/window/waiting_window.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "xr/extensions/vulkan_enable2.h"

#include <chrono>
#include <csignal>
#include <memory>

namespace binosplat {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks(200);

ViewSettings startSettings(const ViewOptions& options) {
    ViewSettings settings;
    settings.stereo = options.run.stereo;
    settings = readViewSettings(options.tables, settings);
    if (options.browse) { settings.page = PanelPage::kScenes; }
    if (options.hide_panel) { settings.panel = false; }
    if (options.hide_hands) { settings.hands = false; }
    if (environment("BINOSPLAT_VISIBILITY_MASK") == "0") { settings.visibility_mask = false; }
    return settings;
}

// Called until the headset is there; throws Interrupted on Ctrl-C, Escape or the window's close button. The first call opens the window.
void waitForHeadset(const std::string& runtime, std::unique_ptr<WaitingWindow>& window) {
    if (!window) {
        FrameLog::print(runtime + " has no headset yet: waiting for it (Ctrl-C ends)");
        window = std::make_unique<WaitingWindow>();
    }
    stopIfInterrupted();
    if (window->wait(kBetweenLooks)) { throw Interrupted{SIGINT}; }
}

void showScene(const ViewOptions& options, const ViewSettings& settings, xr::Instance& instance) {
    ContextOptions context_options = contextOptions(options.run);
    context_options.maker = xr::deviceMaker(instance);
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    if (windows) {
        context_options.instance_extensions = WindowSystem::instanceExtensions();
        context_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    }
    const Context context(context_options);
    const glm::uvec2 size_px = instance.recommendedSizePx();
    FrameLog::print(fmt::format("{}, {}x{} per eye, on {}", instance.description(), size_px.x, size_px.y, context.deviceName()));
    Viewer(options, settings, instance, context, windows != nullptr).run();
    if (!options.out.empty()) { fmt::print("what the wearer saw: {}\n", options.out.string()); }
    context.requireNoValidationMessages();
}

void viewOnce(ViewOptions options) {
    if (options.simulate) { simulateHeadset(options); }
    readCameraFiles(options.run.camera);  // reports their errors before waiting for a headset
    const ViewSettings settings = startSettings(options);
    xr::InstanceOptions instance_options;
    instance_options.visibility_mask = settings.visibility_mask;
    instance_options.eye_tracking = settings.eye_tracking;
    instance_options.foveated_inset = settings.wantsInset();
    std::unique_ptr<WaitingWindow> waiting;
    instance_options.wait_for_headset = [&waiting](const std::string& runtime) { waitForHeadset(runtime, waiting); };
    std::unique_ptr<xr::Instance> instance;
    try {
        instance = std::make_unique<xr::Instance>(instance_options);
        waiting.reset();
        showScene(options, settings, *instance);
    } catch (const Interrupted&) {  // while waiting for a headset
        fmt::print("0 frames; stopped before there was a headset\n");
    } catch (const xr::Lost& lost) { throw Error(ExitCode::kNoDevice, lost.what()); } catch (const xr::InstanceLost& lost) {
        throw Error(ExitCode::kNoDevice, lost.what());
    } catch (const xr::RuntimeFailed&) {
        // The runtime has printed where and why.
        check(!options.simulate || options.script.empty(),
              "--simulate: the simulated headset does not begin with {}, see docs/simulated_script.md", options.script);
        check(!options.simulate || options.out.empty(), "--out: the simulated headset does not begin with {}", options.out.string());
        throw;
    }
}

}  // namespace

void runView(const ViewOptions& options) {
    try {
        viewOnce(options);
    } catch (const Error& error) {
        const bool lacks_headset = error.code() == ExitCode::kNoDevice && !options.simulate;
        if (!lacks_headset || !askUser(fmt::format("{}\n\nShow the scene in a window, without a headset?", error.what()))) { throw; }
        ViewOptions in_window = options;
        in_window.simulate = true;
        viewOnce(in_window);
    }
}

}  // namespace binosplat
