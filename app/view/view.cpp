// `binosplat view`: a scene in a headset or in a window.
#include "app/view/view.h"

#include "app/desktop/desktop.h"
#include "app/options/camera_options.h"
#include "app/options/device_options.h"
#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "app/view/scenes/view_scenes.h"
#include "app/view/settings/device_defaults.h"
#include "app/view/simulate.h"
#include "app/view/viewer.h"
#include "app/view/window/mirror_window.h"
#include "app/view/window/waiting_window.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "xr/extensions/vulkan_enable2.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <future>
#include <memory>
#include <thread>

namespace binosplat {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks(200);
// A headset that has not answered by then is not waited for, if the scene can be shown in a window.
constexpr std::chrono::seconds kLongestWait(2);

// Called until the headset is there; throws Interrupted on Ctrl-C, Escape or the window's close button. The
// first call opens the window.
void waitForHeadset(const std::string& runtime, std::unique_ptr<WaitingWindow>& window) {
    if (!window) {
        FrameLog::print(runtime + " has no headset yet: waiting for it (Ctrl-C to stop)");
        window = std::make_unique<WaitingWindow>();
    }
    stopIfInterrupted();
    if (window->wait(kBetweenLooks)) { throw Interrupted{SIGINT, {}}; }
}

// Settings that suit the device, where the user has not chosen.
ViewSettings suitDevice(ViewOptions& options, const Context& context) {
    const auto properties = context.physicalDevice().getProperties();
    const DeviceDefaults device =
        defaultsOf(context.deviceName(), properties.deviceType == vk::PhysicalDeviceType::eIntegratedGpu,
                   context.deviceMemoryBytes());
    if (!options.run.load.sh_degree) { options.run.load.sh_degree = device.sh_degree; }
    options.run.load.most_splats = device.most_splats;
    const auto namesRate = [](const SettingsTable& table) { return table.settings.contains("refresh-rate"); };
    if (std::ranges::none_of(options.tables, namesRate)) { options.usual_rate_hz = device.refresh_rate; }
    if (const std::string words = describeDefaults(device); !words.empty()) {
        FrameLog::print(
            fmt::format("{}: a small device, starts with {}, see docs/arm.md", context.deviceName(), words));
    }
    return startSettings(options, context.isSoftware(), device);
}

void showScene(ViewOptions options, xr::Instance& instance) {
    ContextOptions context_options = contextOptions(options.run);
    context_options.maker = xr::deviceMaker(instance);
    const std::unique_ptr<WindowSystem> windows = WindowSystem::find();
    if (windows) {
        context_options.instance_extensions = WindowSystem::instanceExtensions();
        context_options.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    }
    const Context context(context_options);
    const glm::uvec2 size_px = instance.recommendedSizePx();
    FrameLog::print(fmt::format("{}, {}x{} per eye, on {}", instance.description(), size_px.x, size_px.y,
                                context.deviceName()));
    const ViewSettings settings = suitDevice(options, context);
    std::unique_ptr<EventWindow> window;
    try {
        if (windows) { window = std::make_unique<EventWindow>(MirrorWindow::sizeFor(kPanelPx)); }
    } catch (const Error& error) { FrameLog::print(fmt::format("no window: {}", error.what())); }
    // Frames have a thread of their own, since a window's events may hold this one up.
    std::future<void> shown = std::async(std::launch::async, [&] {
        const auto end = [](EventWindow* held) { held->end(); };
        const std::unique_ptr<EventWindow, decltype(end)> held(window.get());
        Viewer(options, settings, instance, context, window.get()).run();
    });
    if (window) { window->run(); }
    shown.get();
    if (!options.out.empty()) { fmt::print("what the wearer saw: {}\n", options.out.string()); }
    context.requireNoValidationMessages();
}

// If the scene can be shown in a window, a runtime is asked in a thread of its own: one that hangs is left
// alone until the program ends.
std::unique_ptr<xr::Instance> askRuntime(xr::InstanceOptions options) {
    options.wait_for_headset = [begin = std::chrono::steady_clock::now()](const std::string& runtime) {
        stopIfInterrupted();
        if (std::chrono::steady_clock::now() - begin > kLongestWait) {
            throw Error(ExitCode::kNoDevice, runtime + " has no headset");
        }
        std::this_thread::sleep_for(kBetweenLooks);
    };
    std::packaged_task<std::unique_ptr<xr::Instance>()> ask(
        [options] { return std::make_unique<xr::Instance>(options); });
    std::future<std::unique_ptr<xr::Instance>> answer = ask.get_future();
    std::thread(std::move(ask)).detach();
    const auto latest = std::chrono::steady_clock::now() + kLongestWait + 2 * kBetweenLooks;
    while (answer.wait_for(kBetweenLooks) != std::future_status::ready) {
        stopIfInterrupted();
        if (std::chrono::steady_clock::now() > latest) {
            throw Error(ExitCode::kNoDevice, "the OpenXR runtime does not answer");
        }
    }
    return answer.get();
}

// Sets `has_headset` once there is one.
void viewInHeadset(ViewOptions options, bool& has_headset) {
    if (options.simulate) { simulateHeadset(options); }
    readCameraFiles(options.run.camera);  // reports their errors before waiting for a headset
    const ViewSettings settings = startSettings(options);
    xr::InstanceOptions instance_options;
    instance_options.depth = settings.submit_depth;
    instance_options.visibility_mask = settings.visibility_mask;
    instance_options.eye_tracking = settings.eye_tracking;
    instance_options.foveated_inset = settings.wantsInset();
    std::unique_ptr<WaitingWindow> waiting;
    const bool must_have_one = options.simulate || options.headset_only || !hasDisplay();
    instance_options.wait_for_headset = [&waiting](const std::string& runtime) {
        waitForHeadset(runtime, waiting);
    };
    std::unique_ptr<xr::Instance> instance;
    try {
        instance =
            must_have_one ? std::make_unique<xr::Instance>(instance_options) : askRuntime(instance_options);
        waiting.reset();
        has_headset = true;
        showScene(options, *instance);
    } catch (const Interrupted&) {  // while waiting for a headset
        fmt::print("0 frames; stopped before there was a headset\n");
    } catch (const xr::Lost& lost) {
        throw Error(ExitCode::kNoDevice, lost.what());
    } catch (const xr::InstanceLost& lost) {
        throw Error(ExitCode::kNoDevice, lost.what());
    } catch (const xr::RuntimeFailed&) {
        // The runtime has printed where and why.
        check(!options.simulate || options.script.empty(),
              "--simulate: the simulated headset does not start with {}, see docs/simulated_script.md",
              options.script);
        check(!options.simulate || options.out.empty(), "--out: the simulated headset does not start with {}",
              options.out.string());
        throw;
    }
}

}  // namespace

ViewSettings startSettings(const ViewOptions& options, bool is_software, const DeviceDefaults& device) {
    ViewSettings settings;
    // No setting makes a software device fast enough.
    settings.quality = is_software ? Quality::kOff : device.quality;
    settings.resolution_scale = device.resolution_scale;
    settings.stereo = options.run.stereo;
    if (options.simulate) { settings.first_steps = FirstStepsShown::kNever; }  // a script needs none
    settings = readViewSettings(options.tables, settings);
    if (options.browse) { settings.page = PanelPage::kScenes; }
    if (options.hide_panel) { settings.panel = false; }
    if (options.hide_hands) { settings.hands = false; }
    if (environment("BINOSPLAT_VISIBILITY_MASK") == "0") { settings.visibility_mask = false; }
    return settings;
}

void runView(const ViewOptions& asked) {
    ViewOptions options = asked;
    if (const std::string first = firstSceneIn(asked.scene); !first.empty()) {
        options.scene = first;
        options.browse = true;
    }
    const auto showInWindow = [&] {
        readCameraFiles(options.run.camera);
        runDesktop(options, startSettings(options));
    };
    if (options.desktop) { return showInWindow(); }
    bool has_headset = false;
    try {
        viewInHeadset(options, has_headset);
    } catch (const Error& error) {
        const bool must_have_one = has_headset || options.simulate || options.headset_only;
        if (must_have_one || error.code() != ExitCode::kNoDevice) { throw; }
        if (!hasDisplay() || !WindowSystem::find()) {
            throw Error(ExitCode::kNoDevice,
                        fmt::format("{}; no headset: {}", WindowSystem::whyNone(), error.what()));
        }
        // Without what could be done about that.
        const std::string why = error.what();
        FrameLog::print("the scene is shown in a window; no headset: " + why.substr(0, why.find("; ")));
        showInWindow();
    }
}

}  // namespace binosplat
