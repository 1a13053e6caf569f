// Running the catalogue.
#include "app/stability_cases/run_case.h"

#include "app/stability_cases/score_picture.h"
#include "engine/twin/stereo.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace binosplat::stability {
namespace {

constexpr Side kDominant = kLeft;
constexpr int kMarginPx = 8;  // small pictures have small borders

// The twin's pictures of a stage; full renders are made only once.
class TwinPictures {
public:
    explicit TwinPictures(const Stage& stage) : stage_(stage) { settings_.near = stage.near; }

    [[nodiscard]] const std::vector<glm::dvec4>& middle() { return full(2, stage_.middle); }
    [[nodiscard]] const std::vector<glm::dvec4>& of(int eye) {
        return full(eye, stage_.eyes[static_cast<std::size_t>(eye)]);
    }
    [[nodiscard]] reference::StereoPictures moved(Mode mode) const {
        reference::StereoSettings stereo{.margin_px = kMarginPx, .center_rois = true};
        stereo.choice = choiceOf(mode);
        return reference::renderStereo(stage_.scene, {stage_.eyes[kDominant], stage_.eyes[1 - kDominant]},
                                       stereo, settings_);
    }

private:
    const std::vector<glm::dvec4>& full(int slot, const Eye& eye) {
        std::optional<std::vector<glm::dvec4>>& picture = full_[static_cast<std::size_t>(slot)];
        if (!picture) { picture = reference::render(stage_.scene, eye, settings_).rgba; }
        return *picture;
    }

    const Stage& stage_;
    reference::Settings settings_;
    std::array<std::optional<std::vector<glm::dvec4>>, 3> full_;
};

void compareMoved(PictureScore& score, const Image& image, const std::vector<std::uint32_t>& kinds,
                  const reference::StereoPictures& twin) {
    std::vector<bool> alike;
    for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
        alike.push_back(kinds.empty() ||
                        (kinds[t] != 0) == (twin.tile_kinds[t] != reference::TileKind::kNone));
    }
    const auto others = std::ranges::count(alike, false);
    score.other_tiles = static_cast<double>(others) / static_cast<double>(alike.size());
    compareWithTwin(score, image, twin.affiliated, alike);
}

FrameSettings settingsOf(Mode mode, double near) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = kDominant;
    settings.near = near;
    settings.stereo.margin_px = kMarginPx;
    settings.stereo.center_rois = true;
    return settings;
}

bool makesFromOther(Mode mode) {
    return mode == Mode::kReproject || mode == Mode::kPaper || mode == Mode::kPredicted;
}

bool keeps(const PictureScore& score, const Bound& bound) {
    return score.repeats && score.not_finite == 0 && score.psnr_db >= bound.psnr_db &&
           score.share_off <= bound.share_off && score.largest <= bound.largest &&
           score.other_tiles <= bound.other_tiles;
}

struct Rendered {
    std::vector<Image> pictures;
    std::uint64_t depths_not_finite;
};
Rendered renderOnce(StereoFrame& frame, std::span<const Eye> eyes, const FrameSettings& settings) {
    frame.render(eyes, settings);
    Rendered rendered{{}, countNotFinite(frame.readDominantDepth())};
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        rendered.pictures.push_back(frame.readPicture(static_cast<int>(e)));
    }
    return rendered;
}

void runMode(CaseScore& result, StereoFrame& frame, const Stage& stage, const Case& one, Mode mode,
             TwinPictures& twins) {
    const std::span<const Eye> eyes =
        mode == Mode::kMono ? std::span<const Eye>(&stage.middle, 1) : std::span<const Eye>(stage.eyes);
    const FrameSettings settings = settingsOf(mode, stage.near);
    const Rendered first = renderOnce(frame, eyes, settings);
    const std::vector<std::uint32_t> kinds = frame.readTileKinds();
    const Rendered second = renderOnce(frame, eyes, settings);
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        PictureScore score{.mode = mode,
                           .eye = mode == Mode::kMono ? "middle"
                                  : e == kLeft        ? "left"
                                                      : "right"};
        const Image& picture = first.pictures[e];
        score.moved = makesFromOther(mode) && e != kDominant;
        score.not_finite = countNotFinite(picture) + (score.moved ? 0 : first.depths_not_finite);
        score.repeats = second.pictures[e].values == picture.values &&
                        second.depths_not_finite == first.depths_not_finite;
        if (score.moved) {
            compareMoved(score, picture, kinds, twins.moved(mode));
        } else {
            compareWithTwin(score, picture,
                            mode == Mode::kMono ? twins.middle() : twins.of(static_cast<int>(e)));
        }
        score.passes = keeps(score, score.moved ? one.moved : one.rendered);
        result.pictures.push_back(std::move(score));
    }
}

// The greatest difference of a value.
double changeOf(const std::vector<glm::dvec4>& a, const std::vector<glm::dvec4>& b) {
    double change = 0.0;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
        const glm::dvec4 difference = glm::abs(a[i] - b[i]);
        change = std::max({change, difference.r, difference.g, difference.b, difference.a});
    }
    return change;
}

}  // namespace

bool CaseScore::passes() const { return std::ranges::all_of(pictures, &PictureScore::passes); }

const PictureScore& CaseScore::worstOf(Mode mode) const {
    const PictureScore* worst = nullptr;
    for (const PictureScore& picture : pictures) {
        if (picture.mode == mode && (worst == nullptr || picture.psnr_db < worst->psnr_db)) {
            worst = &picture;
        }
    }
    return *worst;
}

StereoFrame& CaseRunner::show(const Stage& stage) {
    scene_.emplace(context_, stage.scene);
    return showIn(frame_);
}

StereoFrame& CaseRunner::showIn(std::optional<StereoFrame>& frame) {
    if (frame) {
        frame->show(*scene_);
    } else {
        frame.emplace(context_, *scene_);
    }
    return *frame;
}

CaseScore CaseRunner::run(const Case& one) {
    const Stage stage = one.make();
    StereoFrame& frame = show(stage);
    TwinPictures twins(stage);
    CaseScore result;
    for (const Mode mode : kModes) { runMode(result, frame, stage, one, mode, twins); }
    return result;
}

PathScore CaseRunner::run(const Path& path) {
    const Stage stage = path.make();
    StereoFrame& frame = show(stage);
    reference::Settings twin_settings;
    twin_settings.near = stage.near;
    PathScore score{.psnr_db = HUGE_VAL};
    std::vector<glm::dvec4> device_before, twin_before;
    for (int step = 0; step < path.frames; ++step) {
        Eye eye = stage.middle;
        eye.world_from_camera.position +=
            eye.world_from_camera.orientation * (static_cast<double>(step) * path.step);
        const Rendered rendered =
            renderOnce(frame, std::span<const Eye>(&eye, 1), settingsOf(Mode::kMono, stage.near));
        const Image& picture = rendered.pictures.front();
        std::vector<glm::dvec4> twin = reference::render(stage.scene, eye, twin_settings).rgba, device;
        for (std::size_t i = 0; i < twin.size(); ++i) {
            const float* rgba = &picture.values[4 * i];
            device.emplace_back(rgba[0], rgba[1], rgba[2], rgba[3]);
        }
        PictureScore here;
        compareWithTwin(here, picture, twin);
        score.psnr_db = std::min(score.psnr_db, here.psnr_db);
        score.not_finite += countNotFinite(picture) + rendered.depths_not_finite;
        if (step > 0) {
            score.device = std::max(score.device, changeOf(device_before, device));
            score.twin = std::max(score.twin, changeOf(twin_before, twin));
        }
        device_before = std::move(device);
        twin_before = std::move(twin);
    }
    score.passes = score.not_finite == 0 && score.device <= score.twin + path.slack;
    return score;
}

}  // namespace binosplat::stability
