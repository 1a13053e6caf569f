// `binosplat kernels`: the driver's statistics of every kernel in every specialization that a mode uses. Makes only pipelines, so that it
// also runs on drivers without their GPU.
#include "app/commands.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/passes/passes.h"
#include "engine/passes/past_passes.h"
#include "engine/passes/present.h"
#include "engine/passes/warp_passes.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

KernelTable allKernels(const Context& context) {
    KernelTable table = passKernels(context);
    append(table, warpKernels(context));
    append(table, pastKernels(context.isSoftware()));
    append(table, presentKernels());
    return table;
}

std::string lineOfKernel(const KernelVariant& variant, const Json& statistics) {
    std::string text = variant.shader;
    for (const auto& [name, value] : variant.constants) { text += fmt::format(" {}={}", name, value); }
    text += "\n";
    for (const auto& [name, value] : statistics.items()) { text += fmt::format("    {:<40} {}\n", name, value.dump()); }
    return text;
}

}  // namespace

void runKernels(const KernelsOptions& options) {
    std::optional<OutputFiles> files;
    if (!options.out.empty()) { files.emplace(options.out); }
    const Context context({.device = options.device, .device_extensions = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME}});
    const bool has_statistics = context.hasKernelStatistics();
    Json kernels = Json::array();
    std::string text;
    std::optional<ProgressLine> progress("kernels");
    const KernelTable variants = allKernels(context);
    // Lives until the next one is made: RADV frees its code memory once no kernel is left in it, and would allocate another 8 MiB for the
    // next kernel.
    Kernel last;
    for (const KernelVariant& variant : variants) {
        Kernel kernel(context, variant, has_statistics ? Kernel::Keep::kStatistics : Kernel::Keep::kNothing);
        Json constants = Json::object(), statistics = Json::object();
        for (const auto& [name, value] : variant.constants) { constants[name] = value; }
        for (const auto& [name, value] : has_statistics ? kernel.statistics(context) : KernelStatistics{}) {
            std::visit([&, &key = name](const auto& number) { statistics[key] = number; }, value);
        }
        text += lineOfKernel(variant, statistics);
        kernels.push_back({{"shader", variant.shader}, {"constants", constants}, {"statistics", statistics}});
        progress->show(static_cast<double>(kernels.size()) / static_cast<double>(variants.size()));
        last = std::move(kernel);
    }
    progress.reset();
    context.requireNoValidationMessages();
    stopIfInterrupted();
    if (files) {
        const Json all{{"device", context.deviceName()}, {"kernels", kernels}};
        writeText(files->staging() / "kernels.json", all.dump(2) + "\n");
        files->publish();
    }
    fmt::print("{}{} kernels on {}{}\n", text, kernels.size(), context.deviceName(),
               has_statistics ? "" : ", which gives no statistics (VK_KHR_pipeline_executable_properties)");
}

}  // namespace binosplat
