// Facts about files that are dropped on the window. What a desktop and a window say to each other meanwhile is GLFW's business: here GLFW
// only says that it has happened.
#include "tests/app/view/view_window.h"

#include <GLFW/glfw3.h>

TEST_SUITE_BEGIN("view_drop");

namespace view_drop_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// In the fork that is the viewer: files, with a colon between, that are dropped at the tenth look for events.
constexpr const char* kDropped = "BINOSPLAT_TEST_DROPPED";
constexpr int kAtPoll = 10;

GLFWwindow* window_of_drop = nullptr;
GLFWdropfun tell_of_drop = nullptr;

template <typename Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void drop(const std::string& list) {
    std::vector<std::string> files;
    std::istringstream stream(list);
    for (std::string file; std::getline(stream, file, ':');) { files.push_back(file); }
    std::vector<const char*> paths;
    for (const std::string& file : files) { paths.push_back(file.c_str()); }
    tell_of_drop(window_of_drop, static_cast<int>(paths.size()), paths.data());
}

}  // namespace

// The linker takes these two before GLFW's own.
extern "C" GLFWdropfun glfwSetDropCallback(GLFWwindow* window, GLFWdropfun callback) {
    window_of_drop = window;
    tell_of_drop = callback;
    return next<decltype(&glfwSetDropCallback)>("glfwSetDropCallback")(window, callback);
}

extern "C" void glfwPollEvents() {
    static int polls = 0;
    next<decltype(&glfwPollEvents)>("glfwPollEvents")();
    const char* const files = std::getenv(kDropped);
    if (files != nullptr && tell_of_drop != nullptr && ++polls == kAtPoll) { drop(files); }
}

TEST_CASE("the last of the scenes dropped on the window is shown, and one that cannot be read is named and changes nothing") {
    if (!haveScreen() || run_in_fork == nullptr) { return; }
    const Workplace work;
    std::filesystem::create_directory(work.base / "screen");
    const Screen screen(work.base / "screen");
    for (const char* name : {"a", "b"}) { REQUIRE(work.run(fmt::format("scene one-splat --out {}.ply", name)).exit_code == 0); }
    std::ofstream(work.path / "broken.ply") << "ply\nnonsense\n";
    const auto dropping = [&](const std::string& name, const std::string& files) {
        return runView(work, name, "rate 45\nsize 64 64\nframes none\nat 4 exit\n", "builtin:slanted-wall --load-first --mode mono",
                       fmt::format("XDG_CONFIG_HOME=\"$PWD/../config\" WAYLAND_DISPLAY= SIMULATED_OPENXR_CLOCK=real DISPLAY={} {}={}",
                                   screen.name, kDropped, files));
    };
    const ViewRun run = dropping("good", "a.ply:b.ply");
    INFO(run.outcome.output);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.errors.empty());
    CHECK(run.outcome.output.find("shows b.ply") != std::string::npos);
    CHECK(run.outcome.output.find("a.ply") == std::string::npos);
    const ViewRun bad = dropping("bad", "broken.ply");
    INFO(bad.outcome.output);
    CHECK(bad.outcome.exit_code == 0);
    CHECK(bad.outcome.output.find("broken.ply:") != std::string::npos);
    CHECK(bad.outcome.output.find("shows broken.ply") == std::string::npos);
}

}  // namespace view_drop_test
