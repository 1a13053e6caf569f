// `binosplat stability`: the stiff and extreme cases on the present device, beside their float64 twins.
#include "app/commands.h"
#include "app/report/stability_report.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"

namespace binosplat {

void runStability(const StabilityOptions& options) {
    OutputFiles files(options.out);
    const Context context({.device = options.device});
    StabilityRun run{context.deviceName(), stability::makeCatalogue(), {}, stability::makePaths(), {}, stability::makeSequences(), {}};
    {
        ProgressLine line("stability");
        stability::CaseRunner runner(context);
        const auto all = static_cast<double>(run.cases.size() + run.paths.size() + run.sequences.size());
        for (const stability::Case& one : run.cases) {
            run.scores.push_back(runner.run(one));
            line.show(static_cast<double>(run.scores.size()) / all);
        }
        for (const stability::Path& path : run.paths) {
            run.path_scores.push_back(runner.run(path));
            line.show(static_cast<double>(run.scores.size() + run.path_scores.size()) / all);
        }
        for (const stability::Sequence& sequence : run.sequences) {
            run.sequence_scores.push_back(runner.run(sequence));
            line.show(static_cast<double>(run.scores.size() + run.path_scores.size() + run.sequence_scores.size()) / all);
        }
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
          run.cases.size() + run.paths.size() + run.sequences.size(), failures.empty() ? "" : failures.front());
}

}  // namespace binosplat
