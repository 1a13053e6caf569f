// Reads the options, runs one command, and turns errors into one line and an exit code.
#include "app/program.h"
#include "app/bench/bench.h"
#include "app/commands.h"
#include "app/options/options.h"
#include "app/terminal/interrupt.h"
#include "app/view/view.h"
#include "engine/gpu/device_error.h"
#include "engine/platform.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <variant>

namespace binosplat {

namespace {

template <typename... Handlers>
struct Match : Handlers... {
    using Handlers::operator()...;
};
template <typename... Handlers>
Match(Handlers...) -> Match<Handlers...>;  // clang needs it before its 17th version

void run(int argument_count, const char* const* arguments) {
    std::visit(Match{[](const RenderOptions& options) { runRender(options); },
                     [](const BenchOptions& options) { runBench(options); },
                     [](const ViewOptions& options) { runView(options); },
                     [](const InfoOptions& options) { runInfo(options); },
                     [](const SceneOptions& options) { runScene(options); },
                     [](const ConvertOptions& options) { runConvert(options); },
                     [](const CompareOptions& options) { runCompare(options); },
                     [](const StabilityOptions& options) { runStability(options); },
                     [](const KernelsOptions& options) { runKernels(options); },
                     [](const HelpText& help) { fmt::print("{}", help.text); }},
               parseOptions(argument_count, arguments));
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        fail("standard output: cannot be written ({})", std::strerror(errno));
    }
}

int report(ExitCode code, std::string message) {
    std::ranges::replace(message, '\n', ' ');
    tellUser("binosplat: " + message);
    return static_cast<int>(code);
}

}  // namespace

int runProgram(int argument_count, const char* const* arguments) {
    letLongWritesFail();
    const Interrupt interrupt;
    try {
        run(argument_count, arguments);
        return static_cast<int>(ExitCode::kDone);
    } catch (const Error& error) {
        return report(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return report(ExitCode::kBadInput,
                      "memory: not enough for this scene and picture size, must be smaller");
    } catch (const vk::SystemError& error) {
        const Error explained = deviceError("Vulkan", error);
        return report(explained.code(), explained.what());
    } catch (const Interrupted& stop) {
        fmt::print(stderr, "binosplat: stopped by {}, {}\n", stop.signal == SIGINT ? "SIGINT" : "SIGTERM",
                   stop.written.empty() ? "nothing was written" : stop.written);
        return 128 + stop.signal;  // as in a shell
    } catch (const std::exception& error) { return report(ExitCode::kBadInput, error.what()); }
}

}  // namespace binosplat
