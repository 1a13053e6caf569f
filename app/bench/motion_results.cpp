// The results of a bench with head motion.
#include "app/bench/motion_results.h"

#include "app/bench/motion_statistics.h"
#include "app/plot/svg_plot.h"
#include "app/report/text_columns.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

double stageMs(const MotionFrame& frame, const std::string& stage) {
    return sumOf(frame.stage_ms, stage).value_or(0.0);
}

bool isLossy(const Sequence& sequence) { return !sequence.frames[0]->exact; }

Json statisticsJson(const std::vector<double>& values) {
    if (values.empty()) { return Json(); }
    return {{"median", median(values)},
            {"p95", percentile(values, 0.95)},
            {"p99", percentile(values, 0.99)},
            {"worst", std::ranges::max(values)}};
}

// Medians, in the order of the last frame, which has a history if any frame has.
Json passesJson(const Sequence& sequence) {
    Json passes = Json::object();
    for (const auto& [label, ms] : sequence.frames.back()->pass_ms) {
        passes[label] = median(valuesOf(sequence.frames, [&name = label](const MotionFrame& frame) {
            return sumOf(frame.pass_ms, name).value_or(0.0);
        }));
    }
    return passes;
}

// Null if the pictures are equal: JSON has no infinity.
Json psnrJson(double mean_square) { return mean_square > 0.0 ? Json(psnrOf(mean_square)) : Json(); }

std::string psnrText(double mean_square) {
    return mean_square > 0.0 ? fmt::format("{:.2f}", psnrOf(mean_square)) : "equal";
}

void addVisible(Json& json, const Visible& visible) {
    json["bad_share"] = {{"mean", visible.bad}, {"worst", visible.worst_bad}};
    json["worst_tiles_db"] = psnrJson(visible.worst_tiles);
    json["edge"] = visible.edge;
    json["seam"] = visible.seam;
    json["rival"] = visible.rival;
}

void addVisible(std::vector<std::string>& row, const Visible& visible) {
    for (const double percent : {100.0 * visible.bad, 100.0 * visible.worst_bad}) {
        row.push_back(fmt::format("{:.2f}", percent));
    }
    row.push_back(psnrText(visible.worst_tiles));
    row.push_back(fmt::format("{:.2f}", 100.0 * visible.edge));
    for (const double value : {255.0 * visible.seam, visible.rival}) {
        row.push_back(fmt::format("{:.3f}", value));
    }
}

// Its row and, with a headset, that of what is seen through the lenses; what has no column goes to `notes`.
void addRows(TextColumns& columns, std::string& notes, const Sequence& sequence) {
    const std::vector<double> times = valuesOf(sequence.frames, &MotionFrame::total_ms),
                              errors = steadySquares(sequence);
    std::vector<std::string> row{sequence.method};
    for (const double value : {median(times), percentile(times, 0.95), std::ranges::max(times),
                               median(valuesOf(sequence.frames, &MotionFrame::work_rendered))}) {
        row.push_back(fmt::format("{:.3f}", value));
    }
    if (!isLossy(sequence)) { return columns.addRow(std::move(row)); }
    for (const double square : {runSquare(sequence), percentile(errors, 0.95), std::ranges::max(errors)}) {
        row.push_back(psnrText(square));
    }
    row.push_back(fmt::format("{:.6f}", median(flickerOf(sequence))));
    const std::size_t before_visible = row.size();
    addVisible(row, visibleOf(sequence));
    if (const std::vector<double> moved = movedSquares(sequence); !moved.empty()) {
        row.insert(row.end(), {psnrText(movedRunSquare(sequence)), psnrText(std::ranges::max(moved))});
    }
    columns.addRow(std::move(row));
    if (const std::optional<Visible> seen = seenOf(sequence)) {
        std::vector<std::string> through(before_visible);
        through[0] = "  seen through the lenses";
        addVisible(through, *seen);
        columns.addRow(std::move(through));
    }
    if (const std::optional<UnderBound> under = underBoundOf(sequence)) {
        notes += fmt::format(
            "  {}: of the tiles that were not rendered, {:.3f} % are more than {:.0f} dB under its bound;\n"
            "    worst frame {:.3f} %\n",
            sequence.method, 100.0 * under->tiles.underShare(), kMuchUnder_db, 100.0 * under->worst_share);
    }
}

std::string visibleCells(const VisibleErrors& visible) {
    return fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", visible.badShare(),
                       psnrOf(worstTiles(visible.tile_squares, kWorstTiles)), visible.edge, visible.seam,
                       visible.rival);
}

}  // namespace

std::string motionCsv(const MotionRun& run) {
    std::string csv = "device,motion,point,method,mode,time_s,gpu_total_ms";
    for (const char* stage : kStages) { csv += fmt::format(",{} ms", stage); }
    csv +=
        ",mean_square,psnr_db,flicker,full_change,bad_share,worst_tiles_db,edge,seam,rival,psnr_left_db,psnr_"
        "right_db,mse_left,mse_right,"
        "flicker_left,"
        "flicker_right,work_rendered,pixels_warped";
    const bool is_streamed =
        std::ranges::any_of(run.frames, [](const MotionFrame& frame) { return frame.streaming.has_value(); });
    if (is_streamed) {
        csv += ",splats_read,splats_resident,chunks_resident,frames_waited_for_loading,scene_frames_late";
    }
    const bool moves = std::ranges::any_of(
        run.frames, [](const MotionFrame& frame) { return frame.moved_square.has_value(); });
    if (moves) { csv += ",moved_share,psnr_moved_db"; }
    const bool is_bounded =
        std::ranges::any_of(run.frames, [](const MotionFrame& frame) { return frame.bounded.has_value(); });
    if (is_bounded) { csv += ",tiles_kept,tiles_under_bound"; }
    const bool is_governed =
        std::ranges::any_of(run.frames, [](const MotionFrame& frame) { return frame.chosen.has_value(); });
    if (is_governed) { csv += ",warp_error,half_loss,resolution,error_bound_db"; }
    const bool is_seen =
        std::ranges::any_of(run.frames, [](const MotionFrame& frame) { return frame.seen.has_value(); });
    csv += is_seen ? ",seen_bad_share,seen_worst_tiles_db,seen_edge,seen_seam,seen_rival\n" : "\n";
    for (const MotionFrame& frame : run.frames) {
        csv += fmt::format("{},{},{},{},{},{:.6f},{:.6g}", csvCell(run.device), csvCell(run.motion),
                           csvCell(frame.point), csvCell(frame.method), nameOf(frame.mode), frame.time_s,
                           frame.total_ms);
        for (const char* stage : kStages) { csv += fmt::format(",{:.6g}", stageMs(frame, stage)); }
        csv += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g}", frame.worseSquare(), psnrOf(frame.worseSquare()),
                           frame.worseFlicker(), frame.full_change);
        csv += visibleCells(frame.visible);
        const auto& [left, right] = frame.mean_square;
        csv += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}", psnrOf(left),
                           psnrOf(right), left, right, frame.flicker[0], frame.flicker[1],
                           frame.work_rendered, frame.pixels_warped);
        if (is_streamed) {
            const FrameCounters::Streaming streaming = frame.streaming.value_or(FrameCounters::Streaming());
            csv += fmt::format(",{},{},{},{},{}", frame.splats_read, streaming.splats_resident,
                               streaming.chunks_resident, streaming.frames_waited_for_loading,
                               streaming.scene_frames_late);
        }
        if (moves) {
            csv += fmt::format(
                ",{:.6g},{}", frame.moved_share,
                frame.moved_square ? fmt::format("{:.6g}", psnrOf(*frame.moved_square)) : std::string());
        }
        if (is_bounded) {
            csv += frame.bounded ? fmt::format(",{},{}", frame.bounded->kept, frame.bounded->under) : ",,";
        }
        if (is_governed) {
            csv += frame.chosen
                       ? fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g}", frame.warp_error, frame.half_loss,
                                     frame.chosen->resolution_scale, frame.chosen->error_bound_db)
                       : ",,,,";
        }
        if (is_seen) { csv += visibleCells(frame.seen.value_or(VisibleErrors())); }
        csv += '\n';
    }
    return csv;
}

std::string motionJson(const MotionRun& run) {
    Json results = Json::array();
    for (const Sequence& sequence : sequencesOf(run)) {
        Json stages = Json::object();
        for (const char* stage : kStages) {
            const std::vector<double> values =
                valuesOf(sequence.frames, [&](const MotionFrame& frame) { return stageMs(frame, stage); });
            if (std::ranges::max(values) > 0.0) { stages[stage] = statisticsJson(values); }
        }
        Json json{{"point", sequence.point},
                  {"method", sequence.method},
                  {"mode", nameOf(sequence.frames[0]->mode)},
                  {"frames", sequence.frames.size()},
                  {"gpu_total_ms", statisticsJson(valuesOf(sequence.frames, &MotionFrame::total_ms))},
                  {"stage_ms", stages},
                  {"pass_ms", passesJson(sequence)}};
        if (isLossy(sequence)) {
            const std::vector<double> errors = steadySquares(sequence);
            json["psnr_db"] = {{"median", psnrJson(median(errors))},
                               {"p95", psnrJson(percentile(errors, 0.95))},
                               {"p99", psnrJson(percentile(errors, 0.99))},
                               {"worst", psnrJson(std::ranges::max(errors))},
                               {"run", psnrJson(runSquare(sequence))},
                               {"first", psnrJson(sequence.frames.front()->worseSquare())}};
            if (const std::vector<double> moved = movedSquares(sequence); !moved.empty()) {
                json["psnr_moved_db"] = {{"run", psnrJson(movedRunSquare(sequence))},
                                         {"worst", psnrJson(std::ranges::max(moved))}};
                json["moved_share"] =
                    statisticsJson(valuesOf(steadyFrames(sequence), &MotionFrame::moved_share));
            }
            json["flicker"] = statisticsJson(flickerOf(sequence));
            addVisible(json, visibleOf(sequence));
            if (const std::optional<Visible> seen = seenOf(sequence)) { addVisible(json["seen"], *seen); }
            if (const std::optional<UnderBound> under = underBoundOf(sequence)) {
                json["under_bound"] = {{"share", under->tiles.underShare()},
                                       {"worst", under->worst_share},
                                       {"tiles_kept", under->tiles.kept},
                                       {"tiles_under", under->tiles.under}};
            }
        }
        json["work_rendered"] = statisticsJson(valuesOf(sequence.frames, &MotionFrame::work_rendered));
        json["full_change"] = statisticsJson(valuesOf(sequence.frames, &MotionFrame::full_change));
        results.push_back(json);
    }
    const Json root{
        {"device", run.device}, {"config", run.config}, {"motion", run.motion}, {"results", results}};
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string motionTable(const MotionRun& run, std::size_t most_columns) {
    std::string table = fmt::format("device: {}, motion: {}\n", run.device, run.motion);
    const bool moves = std::ranges::any_of(
        run.frames, [](const MotionFrame& frame) { return frame.moved_square.has_value(); });
    const std::vector<Sequence> sequences = sequencesOf(run);
    for (auto begin = sequences.begin(), end = begin; begin != sequences.end(); begin = end) {
        end = std::find_if(begin, sequences.end(),
                           [&](const Sequence& other) { return other.point != begin->point; });
        table += fmt::format(
            "\n{}, {} poses\n"
            "  dB: PSNR of the run, and what 95 % of the frames and all reach in both eyes; bad: tiles\n"
            "  under 30 dB, mean and worst frame; tiles: the worst 0.1 % of them; edge: lost edges;\n"
            "  seam: steps between tiles; rival: sharpness that differs between the eyes\n",
            begin->point, begin->frames.size());
        TextColumns columns;
        std::vector<std::string> head{"method",  "ms median", "ms p95",   "ms worst", "work",
                                      "dB run",  "dB 95",     "dB worst", "flicker",  "bad %",
                                      "worst %", "dB tiles",  "edge %",   "seam",     "rival"};
        if (moves) { head.insert(head.end(), {"dB moved", "worst"}); }
        columns.addRow(std::move(head));
        std::string notes;
        for (auto sequence = begin; sequence != end; ++sequence) { addRows(columns, notes, *sequence); }
        table += columns.text(most_columns) + notes;
    }
    return table;
}

std::string motionPlot(const MotionRun& run) {
    std::vector<PlotPanel> panels;
    const auto panelOf = [&](const std::string& title, const char* y_label) -> PlotPanel& {
        const auto found = std::ranges::find(panels, title, &PlotPanel::title);
        if (found != panels.end()) { return *found; }
        PlotPanel& panel =
            panels.emplace_back(PlotPanel{.title = title, .x_label = "time, s", .y_label = y_label});
        panel.x_scale = panel.y_scale = Scale::kLinear;
        return panel;
    };
    const auto add = [&](const std::string& title, const char* y_label, const MotionFrame& frame,
                         double value) {
        PlotLine& line = lineOf(panelOf(title, y_label), frame.method);
        line.dots = false;
        line.points.emplace_back(frame.time_s, value);
    };
    for (const MotionFrame& frame : run.frames) {
        add(frame.point + ": time", "GPU time of the pair, ms", frame, frame.total_ms);
        if (frame.exact) { continue; }
        add(frame.point + ": error", "PSNR of the worse eye, dB", frame, psnrOf(frame.worseSquare()));
    }
    // Error against run time: from the run's PSNR down to the worst frame's, and from the mean share of bad
    // tiles up to the worst frame's.
    const std::string x_label = "median GPU time of the pair, ms";
    for (const Sequence& sequence : sequencesOf(run)) {
        const double square = runSquare(sequence);
        if (!isLossy(sequence) || !(square > 0.0)) { continue; }
        PlotPanel& panel =
            panelOf(sequence.point + ": run", "PSNR of the run, down to the worst frame's, dB");
        panel.x_label = x_label;
        const double time_ms = median(valuesOf(sequence.frames, &MotionFrame::total_ms));
        lineOf(panel, sequence.method).points = {
            {time_ms, psnrOf(square)}, {time_ms, psnrOf(std::ranges::max(steadySquares(sequence)))}};
        PlotPanel& tiles =
            panelOf(sequence.point + ": bad tiles", "tiles under 30 dB, up to the worst frame, %");
        tiles.x_label = x_label;
        const Visible visible = visibleOf(sequence);
        lineOf(tiles, sequence.method).points = {{time_ms, 100.0 * visible.bad},
                                                 {time_ms, 100.0 * visible.worst_bad}};
    }
    return drawPlot("Measured on " + run.device + " with " + run.motion, panels);
}

}  // namespace binosplat
