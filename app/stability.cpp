// `binosplat stability`: the stiff and extreme cases on this device, compared with their float64 twins.
#include "app/commands.h"
#include "app/report/stability_report.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"

namespace binosplat {

void runStability(const StabilityOptions& options) {
    OutputFiles files(options.out);
    const Context context({.device = options.device});
    const auto cases = stability::makeCatalogue();
    const auto paths = stability::makePaths();
    const auto sequences = stability::makeSequences();
    const std::size_t all = cases.size() + paths.size() + sequences.size();
    StabilityRun run{context.deviceName(), {}, {}, {}};
    {
        ProgressLine line("stability");
        stability::CaseRunner runner(context);
        std::size_t done = 0;
        const auto runEach = [&](const auto& those, auto& scored) {
            for (const auto& one : those) {
                scored.emplace_back(one, runner.run(one));
                line.show(static_cast<double>(++done) / static_cast<double>(all));
            }
        };
        runEach(cases, run.cases);
        runEach(paths, run.paths);
        runEach(sequences, run.sequences);
    }
    const std::string table = stabilityTable(run);
    writeText(files.staging() / "stability.txt", table);
    writeText(files.staging() / "stability.csv", stabilityCsv(run));
    writeText(files.staging() / "stability.svg", stabilityPlot(run));
    context.requireNoValidationMessages();
    files.publish();
    fmt::print("{}", table);
    const std::vector<std::string> failures = run.failures();
    check(failures.empty(), "stability: {} of {} cases miss their bounds, the first is: {}", failures.size(),
          all, failures.empty() ? "" : failures.front());
}

}  // namespace binosplat
