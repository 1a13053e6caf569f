// Runs sequences: each frame is made from the previous ones, and some are compared with a full render.
#include "app/stability_cases/score_picture.h"

#include <algorithm>
#include <cmath>

namespace binosplat::stability {
namespace {

constexpr int kPlayedTwice = 60;  // frames at most

FrameSettings settingsOf(const Sequence& sequence, const Stage& stage) {
    FrameSettings settings;
    settings.mode = sequence.mode;
    settings.near = stage.near;
    settings.keep_history = true;
    settings.stereo.budget = sequence.budget;
    settings.half_floats = sequence.half_floats;
    return settings;
}

std::vector<glm::dvec4> coloursOf(const Image& image) {
    std::vector<glm::dvec4> colours;
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        const float* rgba = &image.values[4 * i];
        colours.emplace_back(rgba[0], rgba[1], rgba[2], rgba[3]);
    }
    return colours;
}

// The least and the greatest value of each channel over this many pixels on either side along an axis.
void widen(std::vector<glm::dvec4>& least, std::vector<glm::dvec4>& most, glm::ivec2 size, glm::ivec2 axis,
           int reach) {
    const std::vector<glm::dvec4> least_before = least, most_before = most;
    const auto at = [&](const glm::ivec2& pixel) {
        return static_cast<std::size_t>(pixel.y * size.x + pixel.x);
    };
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            for (int step = -reach; step <= reach; ++step) {
                const std::size_t beside =
                    at(glm::clamp(glm::ivec2(x, y) + step * axis, glm::ivec2(0), size - 1));
                least[at({x, y})] = glm::min(least[at({x, y})], least_before[beside]);
                most[at({x, y})] = glm::max(most[at({x, y})], most_before[beside]);
            }
        }
    }
}

double beyondOf(const Image& image, const std::vector<glm::dvec4>& full) {
    constexpr int kReach = 3;
    std::vector<glm::dvec4> least = full, most = full;
    const glm::ivec2 size(image.size_px);
    widen(least, most, size, {1, 0}, kReach);
    widen(least, most, size, {0, 1}, kReach);
    const std::vector<glm::dvec4> shown = coloursOf(image);
    double beyond = 0.0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const glm::dvec4 off = glm::max(shown[i] - most[i], least[i] - shown[i]);
        beyond = std::max({beyond, off.r, off.g, off.b, off.a});
    }
    return beyond;
}

double biasOf(const Image& image, const std::vector<glm::dvec4>& full) {
    const std::vector<glm::dvec4> shown = coloursOf(image);
    glm::dvec4 sum(0.0);
    for (std::size_t i = 0; i < shown.size(); ++i) { sum += shown[i] - full[i]; }
    return std::abs(sum.r + sum.g + sum.b + sum.a) / (4.0 * static_cast<double>(shown.size()));
}

// Of the scored frames from `begin` to `end`, both eyes of each.
double worstOf(const std::vector<SequenceScore::Frame>& frames, std::size_t begin, std::size_t end) {
    double worst = HUGE_VAL;
    for (std::size_t i = begin; i < end; ++i) { worst = std::min(worst, frames[i].picture.psnr_db); }
    return worst;
}

}  // namespace

void CaseRunner::play(const Sequence& sequence, int frames,
                      const std::function<void(int, const std::array<Eye, 2>&)>& after) {
    Stage stage = sequence.make();
    show(stage);
    showIn(full_);
    const FrameSettings settings = settingsOf(sequence, stage);
    for (int frame = 0; frame < frames; ++frame) {
        if (frame == sequence.exchanged_at) {
            stage = sequence.make_other();
            show(stage);
            showIn(full_);
        }
        const std::array<Eye, 2> eyes = sequence.eyes(stage, frame);
        frame_->render(eyes, settings);
        after(frame, eyes);
    }
}

SequenceScore CaseRunner::run(const Sequence& sequence) {
    SequenceScore score;
    const auto shownTo = [&](int eye) { return frame_->readPicture(eye); };
    const int played_twice = std::min(sequence.frames, kPlayedTwice);
    std::array<Image, 2> first;
    play(sequence, sequence.frames, [&](int frame, const std::array<Eye, 2>& eyes) {
        if (frame == played_twice - 1) { first = {shownTo(kLeft), shownTo(kRight)}; }
        if (frame < sequence.first_scored || (frame - sequence.first_scored) % sequence.score_every != 0) {
            return;
        }
        FrameSettings full_settings;
        full_settings.mode = Mode::kShared;
        full_->render(eyes, full_settings);
        for (const int eye : {kLeft, kRight}) {
            const Image shown = shownTo(eye), full = full_->readPicture(eye);
            PictureScore picture{
                .mode = sequence.mode, .eye = eye == kLeft ? "left" : "right", .moved = true};
            const std::vector<glm::dvec4> wanted = coloursOf(full);
            compareWithTwin(picture, shown, wanted);
            picture.not_finite = countNotFinite(shown);
            score.not_finite += picture.not_finite;
            score.beyond = std::max(score.beyond, beyondOf(shown, wanted));
            score.bias = std::max(score.bias, biasOf(shown, wanted));
            if (shown.values != full.values) { score.equal_from = frame + 1; }
            score.frames.push_back({frame, std::move(picture)});
        }
    });
    play(sequence, played_twice, [](int, const std::array<Eye, 2>&) {});
    score.repeats =
        shownTo(kLeft).values == first[kLeft].values && shownTo(kRight).values == first[kRight].values;

    const std::size_t scored = score.frames.size(), third = std::max<std::size_t>(scored / 3, 1);
    score.psnr_db = worstOf(score.frames, 0, scored);
    const double last_db = worstOf(score.frames, scored - third, scored);
    score.drift_db = std::isinf(last_db) ? 0.0 : worstOf(score.frames, 0, third) - last_db;
    for (SequenceScore::Frame& frame : score.frames) {
        frame.picture.repeats = score.repeats;
        frame.picture.passes =
            score.repeats && frame.picture.not_finite == 0 && frame.picture.psnr_db >= sequence.psnr_db;
    }
    score.passes =
        std::ranges::all_of(score.frames,
                            [](const SequenceScore::Frame& frame) { return frame.picture.passes; }) &&
        score.drift_db <= sequence.drift_db && score.beyond <= sequence.beyond &&
        score.bias <= sequence.bias && score.equal_from <= sequence.equal_from.value_or(sequence.frames);
    return score;
}

}  // namespace binosplat::stability
