// The results of `stability` as text, CSV and SVG.
#include "app/report/stability_report.h"

#include "app/plot/svg_plot.h"
#include "app/report/text_columns.h"

#include <algorithm>

namespace binosplat {

using stability::Bound;
using stability::CaseScore;
using stability::kModes;
using stability::PictureScore;

namespace {

// Where equal pictures are plotted, slightly above what single precision can resolve.
constexpr double kEqualDb = 150.0;

std::string decibels(double psnr_db) {
    return std::isinf(psnr_db) ? "equal" : fmt::format("{:.1f}", psnr_db);
}
std::string share(double value) { return value == 0.0 ? "0" : fmt::format("{:.2g}", value); }

template <typename Value>
double greatest(const CaseScore& score, Value&& value) {
    double most = 0.0;
    for (const PictureScore& picture : score.pictures) {
        most = std::max(most, static_cast<double>(value(picture)));
    }
    return most;
}

std::string casesTable(const StabilityRun& run) {
    TextColumns columns;
    std::vector<std::string> head{"case"};
    for (const Mode mode : kModes) { head.emplace_back(nameOf(mode)); }
    for (const char* name : {"largest", "off, full", "off, moved", "other tiles", "not finite", "repeats",
                             "bound, full", "bound, moved", ""}) {
        head.emplace_back(name);
    }
    columns.addRow(std::move(head));
    for (const auto& [one, score] : run.cases) {
        std::vector<std::string> row{one.name()};
        for (const Mode mode : kModes) { row.push_back(decibels(score.worstOf(mode).psnr_db)); }
        row.push_back(fmt::format(
            "{:.1e}", greatest(score, [](const PictureScore& p) { return p.moved ? 0.0 : p.largest; })));
        row.push_back(
            share(greatest(score, [](const PictureScore& p) { return p.moved ? 0.0 : p.share_off; })));
        row.push_back(
            share(greatest(score, [](const PictureScore& p) { return p.moved ? p.share_off : 0.0; })));
        row.push_back(share(greatest(score, [](const PictureScore& p) { return p.other_tiles; })));
        row.push_back(
            fmt::format("{:.0f}", greatest(score, [](const PictureScore& p) { return p.not_finite; })));
        row.emplace_back(
            greatest(score, [](const PictureScore& p) { return p.repeats ? 0 : 1; }) > 0.0 ? "NO" : "yes");
        row.push_back(fmt::format("{:.0f}", one.rendered.psnr_db));
        row.push_back(fmt::format("{:.0f}", one.moved.psnr_db));
        row.emplace_back(!score.passes() ? "FAILS" : one.beyond ? "limit" : "");
        columns.addRow(std::move(row));
    }
    return columns.text();
}

std::string pathsTable(const StabilityRun& run) {
    TextColumns columns;
    columns.addRow(
        {"the eye moves by 1e-6 a frame", "change", "twin's", "slack", "worst frame", "not finite", ""});
    for (const auto& [path, score] : run.paths) {
        columns.addRow({path.name, fmt::format("{:.2e}", score.device), fmt::format("{:.2e}", score.twin),
                        fmt::format("{:.1e}", path.slack), decibels(score.psnr_db),
                        fmt::format("{}", score.not_finite), score.passes ? "" : "FAILS"});
    }
    return columns.text();
}

std::string sequencesTable(const StabilityRun& run) {
    TextColumns columns;
    columns.addRow({"frames made from the ones before", "frames", "worst", "bound", "drift", "bound",
                    "beyond", "bound", "bias", "bound", "equal from", "bound", "not finite", "repeats", ""});
    const auto bound = [](double value) {
        return std::isinf(value) ? std::string() : fmt::format("{:.2g}", value);
    };
    for (const auto& [sequence, score] : run.sequences) {
        columns.addRow({sequence.title(), fmt::format("{}", sequence.frames), decibels(score.psnr_db),
                        fmt::format("{:.0f}", sequence.psnr_db), fmt::format("{:.1f}", score.drift_db),
                        bound(sequence.drift_db), fmt::format("{:.3f}", score.beyond), bound(sequence.beyond),
                        fmt::format("{:.4f}", score.bias), bound(sequence.bias),
                        score.equal_from < sequence.frames ? fmt::format("{}", score.equal_from) : "",
                        sequence.equal_from ? fmt::format("{}", *sequence.equal_from) : "",
                        fmt::format("{}", score.not_finite), score.repeats ? "yes" : "NO",
                        score.passes ? "" : "FAILS"});
    }
    return columns.text();
}

std::string reasons(const StabilityRun& run) {
    std::string text, family;
    for (const auto& [one, score] : run.cases) {
        if (one.family == family) { continue; }
        family = one.family;
        text += fmt::format("  {}: {}\n", family, one.reason);
    }
    for (const auto& [path, score] : run.paths) { text += fmt::format("  {}: {}\n", path.name, path.reason); }
    for (const auto& [sequence, score] : run.sequences) {
        if (sequence.name == family) { continue; }
        family = sequence.name;
        text += fmt::format("  {}: {}\n", family, sequence.reason);
    }
    return text;
}

std::string csvRow(const std::string& family, const std::string& parameter, double value,
                   const PictureScore& p, const Bound& bound) {
    return fmt::format(
        "\"{}\",\"{}\",{:.9g},{},{},{:d},{:.2f},{:.3g},{:.3g},{:.3g},{},{:d},{},{},{},{},{:d}\n", family,
        parameter, value, nameOf(p.mode), p.eye, p.moved, p.psnr_db, p.share_off, p.largest, p.other_tiles,
        p.not_finite, p.repeats, bound.psnr_db, bound.share_off, bound.largest, bound.other_tiles, p.passes);
}

void addPanels(std::vector<PlotPanel>& panels, const StabilityRun& run) {
    for (const auto& [sequence, score] : run.sequences) {
        if (panels.empty() || panels.back().title != sequence.name) {
            panels.push_back(
                {.title = sequence.name, .x_label = "frame", .y_label = "PSNR against the full render, dB"});
            panels.back().x_scale = panels.back().y_scale = Scale::kLinear;
        }
        PlotLine& line = lineOf(panels.back(), std::string(nameOf(sequence.mode)));
        const auto& frames = score.frames;
        for (std::size_t f = 0; f + 1 < frames.size(); f += 2) {  // both eyes of each
            const double worse = std::min(frames[f].picture.psnr_db, frames[f + 1].picture.psnr_db);
            line.points.emplace_back(frames[f].frame, std::min(worse, kEqualDb));
        }
    }
}

}  // namespace

std::vector<std::string> StabilityRun::failures() const {
    std::vector<std::string> names;
    for (const auto& [one, score] : cases) {
        if (!score.passes()) { names.push_back(one.name()); }
    }
    for (const auto& [path, score] : paths) {
        if (!score.passes) { names.push_back(path.name); }
    }
    for (const auto& [sequence, score] : sequences) {
        if (!score.passes) { names.push_back(sequence.title()); }
    }
    return names;
}

std::string stabilityTable(const StabilityRun& run) {
    return fmt::format(
        "device: {}\nPSNR in dB against the float64 twin, of the worse eye; off: share of the values that "
        "differ by more than 2/255; "
        "full:\n"
        "eyes that are rendered; moved: the eye that is reprojected from the other, over tiles that both or "
        "neither render "
        "again\n\n{}\n{}\n"
        "PSNR in dB of the worse eye against the full render of the same frame; drift: how much worse the "
        "last frames are than the first;\n"
        "beyond: the most by which a value exceeds the range of the full render within 3 pixels; bias: how "
        "far the mean of all values is "
        "off;\n"
        "equal from: the frame from which all equal the full render\n\n{}\n"
        "what bounds them\n{}",
        run.device, casesTable(run), pathsTable(run), sequencesTable(run), reasons(run));
}

std::string stabilityCsv(const StabilityRun& run) {
    std::string csv =
        "family,parameter,value,mode,eye,moved,psnr_db,share_off,largest,other_tiles,not_finite,repeats,"
        "bound_psnr_db,bound_share_off,"
        "bound_largest,bound_other_tiles,passes\n";
    for (const auto& [one, score] : run.cases) {
        for (const PictureScore& p : score.pictures) {
            csv += csvRow(one.family, one.parameter, one.value, p, p.moved ? one.moved : one.rendered);
        }
    }
    for (const auto& [sequence, score] : run.sequences) {
        for (const auto& [frame, p] : score.frames) {
            csv += csvRow(sequence.name, "frame", frame, p, {sequence.psnr_db, 1.0});
        }
    }
    return csv;
}

std::string stabilityPlot(const StabilityRun& run) {
    std::vector<PlotPanel> panels;
    for (const auto& [one, score] : run.cases) {
        if (one.parameter.empty()) { continue; }
        if (panels.empty() || panels.back().title != one.family) {
            panels.push_back(
                {.title = one.family, .x_label = one.parameter, .y_label = "PSNR against the twin, dB"});
            panels.back().y_scale = Scale::kLinear;
        }
        PlotPanel& panel = panels.back();
        const auto add = [&panel, x = one.value](const std::string& label, double psnr_db, bool dots) {
            PlotLine& line = lineOf(panel, label);
            line.dots = dots;
            line.points.emplace_back(x, std::min(psnr_db, kEqualDb));
        };
        for (const Mode mode : kModes) { add(std::string(nameOf(mode)), score.worstOf(mode).psnr_db, true); }
        add("bound, rendered eyes", one.rendered.psnr_db, false);
        add("bound, moved eye", one.moved.psnr_db, false);
    }
    addPanels(panels, run);
    return drawPlot("Against the float64 twin and full renders, on " + run.device, panels);
}

}  // namespace binosplat
