// `binosplat bench --photos`: the affiliated eye stands where a photograph was taken, and the dominant one
// beside it (the paper's protocol, so that PSNR and SSIM are against the photograph).
#include "app/bench/bench.h"
#include "app/bench/bench_point.h"
#include "app/load.h"
#include "app/options/device_options.h"
#include "app/scores/metrics.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "engine/places/standpoint.h"
#include "engine/setup/output_files.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// One method at one camera.
struct PhotoRow {
    std::string scene, camera, method;
    Mode mode;
    double total_ms = 0.0;
    double psnr_db = 0.0, ssim = 0.0;  // against the photograph, both clamped to 0 to 1
    double mean_square_to_full = 0.0;  // against the full render of the same eye
    std::optional<double> lpips;       // against the photograph, if there are weights
};

// Camera files name pictures with or without their extension.
fs::path findPhoto(const fs::path& folder, const std::string& name) {
    if (fs::is_regular_file(folder / name)) { return folder / name; }
    for (const char* extension : {".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG", ".ppm", ".exr", ".pfm"}) {
        if (const fs::path path = folder / (name + extension); fs::is_regular_file(path)) { return path; }
    }
    fail("{}: not found, must be the photograph of a camera (with .png, .jpg, .ppm, .exr or .pfm)",
         (folder / name).string());
}

// Both eyes with the affiliated one at the photograph's camera.
Cameras besidePhoto(const Eye& photo, double eye_distance, int affiliated, double near) {
    const glm::dvec3 right = photo.world_from_camera.orientation * glm::dvec3(1.0, 0.0, 0.0);
    Eye middle = photo;
    middle.world_from_camera.position += (affiliated == kRight ? -0.5 : 0.5) * eye_distance * right;
    Cameras cameras{middle, stereoPair(middle, eye_distance), eye_distance, std::nullopt};
    cameras.eyes[static_cast<std::size_t>(affiliated)] = photo;
    cameras.near = near;
    return cameras;
}

struct Means {
    std::string scene, method;
    Mode mode;
    std::size_t cameras = 0;
    double psnr_db = 0.0, ssim = 0.0;
    std::vector<double> total_ms, lpips;  // of each camera; no LPIPS without its weights
};

// Means over the cameras, by scene and method.
std::vector<Means> meansOf(const std::vector<PhotoRow>& rows) {
    std::vector<Means> means;
    for (const PhotoRow& row : rows) {
        const auto found = std::ranges::find_if(
            means, [&](const Means& one) { return one.scene == row.scene && one.method == row.method; });
        Means& one = found != means.end()
                         ? *found
                         : means.emplace_back(Means{row.scene, row.method, row.mode, 0, 0.0, 0.0, {}, {}});
        ++one.cameras;
        one.psnr_db += row.psnr_db;
        one.ssim += row.ssim;
        one.total_ms.push_back(row.total_ms);
        if (row.lpips) { one.lpips.push_back(*row.lpips); }
    }
    for (Means& one : means) {
        one.psnr_db /= static_cast<double>(one.cameras);
        one.ssim /= static_cast<double>(one.cameras);
    }
    return means;
}

// Empty if LPIPS was not measured.
std::optional<double> meanLpips(const Means& means) {
    if (means.lpips.empty()) { return std::nullopt; }
    return std::accumulate(means.lpips.begin(), means.lpips.end(), 0.0) /
           static_cast<double>(means.lpips.size());
}

const Means& fullOf(const std::vector<Means>& means, const Means& like) {
    return *std::ranges::find_if(
        means, [&](const Means& one) { return one.scene == like.scene && one.mode == Mode::kShared; });
}

std::string photosCsv(const std::string& device, const std::vector<PhotoRow>& rows) {
    std::string csv =
        "device,scene,camera,method,mode,gpu_total_ms,psnr_db_to_photo,ssim_to_photo,psnr_db_to_full";
    const bool with_lpips =
        std::ranges::any_of(rows, [](const PhotoRow& row) { return row.lpips.has_value(); });
    csv += with_lpips ? ",lpips_to_photo\n" : "\n";
    for (const PhotoRow& row : rows) {
        csv += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g}", csvCell(device), csvCell(row.scene),
                           csvCell(row.camera), csvCell(row.method), nameOf(row.mode), row.total_ms,
                           row.psnr_db, row.ssim, psnrOf(row.mean_square_to_full));
        if (with_lpips) { csv += row.lpips ? fmt::format(",{:.6g}", *row.lpips) : ","; }
        csv += "\n";
    }
    return csv;
}

std::string photosJson(const std::string& device, const std::vector<Means>& means) {
    Json results = Json::array();
    for (const Means& one : means) {
        const Means& full = fullOf(means, one);
        results.push_back({{"scene", one.scene},
                           {"method", one.method},
                           {"mode", nameOf(one.mode)},
                           {"cameras", one.cameras},
                           {"gpu_total_ms", median(one.total_ms)},
                           {"psnr_db_to_photo", one.psnr_db},
                           {"ssim_to_photo", one.ssim},
                           {"psnr_db_lost", full.psnr_db - one.psnr_db},
                           {"ssim_lost", full.ssim - one.ssim}});
        if (const std::optional<double> ours = meanLpips(one), theirs = meanLpips(full); ours && theirs) {
            results.back()["lpips_to_photo"] = *ours;
            results.back()["lpips_lost"] = *ours - *theirs;
        }
    }
    return Json{{"device", device}, {"results", results}}.dump(2, ' ', false,
                                                               Json::error_handler_t::replace) +
           "\n";
}

std::string photosTable(const std::string& device, const std::vector<Means>& means) {
    std::string table = fmt::format(
        "device: {}; against photographs, means over cameras; lost: worse than the full render\n", device);
    for (const Means& one : means) {
        const Means& full = fullOf(means, one);
        table += fmt::format(
            "  {:<24} {:<28} {:>4} cameras  {:>10.3f} ms  {:>6.2f} dB  SSIM {:.4f}  lost {:>6.2f} dB, {:.4f}",
            one.scene, one.method, one.cameras, median(one.total_ms), one.psnr_db, one.ssim,
            full.psnr_db - one.psnr_db, full.ssim - one.ssim);
        if (const std::optional<double> ours = meanLpips(one), theirs = meanLpips(full); ours && theirs) {
            table += fmt::format("  LPIPS {:.4f}  lost {:.4f}", *ours, *ours - *theirs);
        }
        table += "\n";
    }
    return table;
}

}  // namespace

void benchPhotos(const BenchOptions& options, const BenchPlan& plan) {
    requireScenes(plan);
    const std::vector<FileCamera> cameras = readCameraFile(options.run.camera.cameras_file, glm::dvec3(0.0));
    std::vector<fs::path> photos;
    for (std::size_t i = 0; i < cameras.size(); i += options.every) {
        photos.push_back(findPhoto(options.photos_folder, cameras[i].name));
    }
    OutputFiles files(options.out);
    const Context context(contextOptions(options.run));
    const double eye_distance =
        options.run.stereo.ipd_m.value_or(kDefaultIpdMetres) / options.run.metres_per_unit;
    const int affiliated = 1 - options.run.stereo.dominant;
    const BenchMethod shared = plainMethod(Mode::kShared, options.run);

    std::vector<PhotoRow> rows;
    for (const std::string& source : plan.scenes) {
        Scene scene = loadAs(options.run, source);
        const double near = options.run.camera.near ? *options.run.camera.near : usualNear(scene);
        const glm::dvec3 origin = scene.origin;
        const GpuScene gpu_scene(context, std::exchange(scene, {}));
        MethodFrames frames(context, gpu_scene);
        ProgressLine progress("photographs");
        for (std::size_t i = 0; i < photos.size(); ++i) {
            const FileCamera& camera = cameras[i * options.every];
            const Image photo = readPicture(photos[i]);
            Eye taken = resize(camera.eye, photo.size_px);
            taken.world_from_camera.position -= origin;
            const Cameras eyes = besidePhoto(taken, eye_distance, affiliated, near);
            const Image full = frames.render(eyes, options.run.camera, shared).readPicture(affiliated);
            for (const BenchMethod& method : plan.methods) {
                if (method.stereo.mode == Mode::kMono) { continue; }
                for (std::uint32_t warm_up = 0; i == 0 && warm_up < plan.warm_up; ++warm_up) {
                    frames.render(eyes, options.run.camera, method);
                }
                const MethodFrames::Rendered rendered = frames.render(eyes, options.run.camera, method);
                const Image picture = rendered.readPicture(affiliated);
                const PhotoScores scores =
                    compareWithPhoto(picture, photo, plan.lpips ? &*plan.lpips : nullptr);
                rows.push_back({nameIn(plan, source), camera.name, method.name, method.stereo.mode,
                                rendered.result.gpu_total_ms, scores.psnr_db, scores.ssim,
                                compare(picture, full).mean_square, scores.lpips});
            }
            progress.show(static_cast<double>(i + 1) / static_cast<double>(photos.size()));
        }
    }
    const std::vector<Means> means = meansOf(rows);
    writeText(files.staging() / "photos.csv", photosCsv(context.deviceName(), rows));
    writeText(files.staging() / "photos.json", photosJson(context.deviceName(), means));
    context.requireNoValidationMessages();
    stopIfInterrupted();
    files.publish();
    fmt::print("{}", photosTable(context.deviceName(), means));
}

}  // namespace binosplat
