// Frames that the caller waits for, and their pictures.
#include "engine/library/objects.h"
#include "engine/library/structures.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace binosplat;

namespace {

constexpr std::size_t kMostViews = 4;
constexpr double kUsualBudget = 0.2;
constexpr std::size_t kFirstTargetSize = offsetof(bsp_target, flags) + sizeof(std::uint32_t);

Mode modeOf(bsp_mode mode) {
    switch (mode) {
        case BSP_MODE_USUAL:
        case BSP_MODE_PREDICTED:
            return Mode::kPredicted;
        case BSP_MODE_TWO_PASS:
            return Mode::kTwoPass;
        case BSP_MODE_SHARED:
            return Mode::kShared;
        case BSP_MODE_PAPER:
            return Mode::kPaper;
        case BSP_MODE_TEMPORAL:
            return Mode::kTemporal;
    }
    fail("mode is {}, must be one of bsp_mode", static_cast<int>(mode));
}

// The smallest near depth of its scenes.
double usualNear(const AskedFrame& asked) {
    double near = asked.scenes.empty() ? kUsualNear : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < asked.scenes.size(); ++i) {
        const double scale = asked.placed.empty() ? 1.0 : asked.placed[i].world_from_scene.scale;
        near = std::min(near, scale * asked.scenes[i]->properties.near);
    }
    return near;
}

FrameSettings settingsOf(const bsp_frame_info& frame, const AskedFrame& asked) {
    check(frame.budget <= 1.0, "budget is {}, must be at most 1", frame.budget);
    const double near = frame.near_depth == 0.0 ? usualNear(asked) : frame.near_depth;
    check(std::isfinite(near) && near > 0.0, "near_depth is {}, must be more than 0", near);
    const glm::dvec3 background(frame.background[0], frame.background[1], frame.background[2]);
    check(std::isfinite(background.x + background.y + background.z), "background is not finite");
    FrameSettings settings;
    settings.mode = modeOf(frame.mode);
    settings.near = near;
    settings.background = background;
    settings.keep_history = hasHistory(settings.mode);
    settings.times_passes = false;
    settings.keep_depth = settings.keep_both_depths = (frame.flags & BSP_FRAME_DEPTH) != 0;
    settings.surface_depths = !settings.keep_depth;  // for a target, by which its owner may reproject it
    settings.half_floats = (frame.flags & BSP_FRAME_HALF_FLOATS) != 0;
    settings.stereo.budget = frame.budget == 0.0 ? kUsualBudget : std::max(frame.budget, 0.0);
    settings.stereo.move_cost = kDefaultMoveCost;
    check(frame.error_bound_db >= 0.0 && frame.error_bound_db <= 60.0,
          "error_bound_db is {}, must be 0 to 60", frame.error_bound_db);
    settings.stereo.error_bound_db = frame.error_bound_db;
    check(frame.foveation_rad >= 0.0 && frame.foveation_rad < std::numbers::pi,
          "foveation_rad is {}, must be 0 to pi", frame.foveation_rad);
    settings.half_periphery = frame.foveation_rad > 0.0;
    return settings;
}

// The angle within which foveation changes nothing; empty without foveation.
std::optional<Gaze> gazeOf(const bsp_view& view, double foveation_rad) {
    if (foveation_rad == 0.0) { return std::nullopt; }
    const glm::dvec3 gaze(view.gaze[0], view.gaze[1], view.gaze[2]);
    const double length = glm::length(gaze);
    check(std::isfinite(length), "gaze of a view is not finite");
    return Gaze{length > 0.0 ? gaze : glm::dvec3(0.0, 0.0, 1.0), foveation_rad};
}

// The eyes, and their targets if wanted.
void readViews(const bsp_frame_info& frame, bool with_targets, AskedFrame& asked) {
    check(frame.view_count >= 1 && frame.view_count <= kMostViews, "there are {} views, must be 1 to {}",
          frame.view_count, kMostViews);
    checkHeader(frame.views, BSP_TYPE_VIEW, kFirstViewSize, "bsp_view");
    for (std::size_t i = 0; i < frame.view_count; ++i) {
        const auto* view = reinterpret_cast<const bsp_view*>(
            reinterpret_cast<const unsigned char*>(frame.views) + i * frame.views->size);
        const auto known = readStructure(view, BSP_TYPE_VIEW, kFirstViewSize, "bsp_view");
        asked.eyes.push_back(eyeOf(known, asked.origin));
        asked.gazes.push_back(gazeOf(known, frame.foveation_rad));
        check(i % 2 == 0 || asked.eyes[i].size_px == asked.eyes[i - 1].size_px,
              "views {} and {} have different sizes, must be equal: they are a pair", i - 1, i);
        if (!with_targets) { continue; }
        const auto* target = reinterpret_cast<const bsp_target*>(findNext(known.next, BSP_TYPE_TARGET));
        check(target != nullptr, "view {} has no bsp_target, must have one", i);
        const auto known_target = readStructure(target, BSP_TYPE_TARGET, kFirstTargetSize, "bsp_target");
        checkTarget(known_target, asked.settings.half_floats, asked.settings.background != glm::dvec3(0.0));
        asked.targets.push_back(known_target);
        asked.settings.keep_depth = asked.settings.keep_both_depths =
            asked.settings.keep_depth || known_target.depth != VK_NULL_HANDLE;
    }
}

}  // namespace

bsp_frame_info binosplat::readFrame(const bsp_frame_info* frame) {
    return readStructure(frame, BSP_TYPE_FRAME_INFO, offsetof(bsp_frame_info, mode), "bsp_frame_info");
}

bsp_frame_result binosplat::resultOf(const FrameResult& result, double share_there) {
    bsp_frame_result told{};
    told.gpu_ms = result.gpu_total_ms;
    for (const TargetCounters& target : result.counters.targets) {
        told.splats_visible = std::max(told.splats_visible, target.splats_visible);
        told.tile_pairs += target.tile_pairs;
    }
    told.work_rendered = result.work_rendered;
    if (result.counters.ahead) { told.frames_cut_short = result.counters.ahead->frames_cut_short; }
    told.peak_device_bytes = result.peak_gpu_bytes;
    told.share_there = share_there;
    return told;
}

bsp_renderer_t::bsp_renderer_t(bsp_device_t& of_device)
    : device(of_device),
      uploads_(of_device.context),
      on_device_(&of_device.empty),
      targets_(of_device.context) {
    part(0);
    const std::lock_guard lock(device.renderers_mutex);
    device.renderers.insert(this);
}

bsp_renderer_t::~bsp_renderer_t() {
    const std::lock_guard lock(device.renderers_mutex);
    device.renderers.erase(this);
    dropAll();
}

void bsp_renderer_t::dropAll() noexcept {
    for (auto& [number, lent] : lent_) {
        (void)guarded([&] { return drop(lent), BSP_SUCCESS; });
    }
    lent_.clear();
    while (!parts_.empty()) { parts_.pop_back(); }  // the first one last
    group_.reset();
    on_device_ = &device.empty;
    views_read_ = 0;
    const std::lock_guard lock(shown_mutex_);
    shown_.clear();
}

StereoFrame& bsp_renderer_t::part(std::size_t index) {
    while (parts_.size() <= index) {
        parts_.push_back(parts_.empty() ? std::make_unique<StereoFrame>(device.context, *on_device_)
                                        : StereoFrame::beside(*parts_.front()));
        parts_.back()->leaveChanges();
    }
    return *parts_[index];
}

AskedFrame bsp_renderer_t::ask(const bsp_frame_info& frame, bool with_targets) const {
    AskedFrame asked;
    asked.is_cut = (frame.flags & BSP_FRAME_CUT) != 0;
    asked.settles = (frame.flags & BSP_FRAME_SETTLED) != 0;
    check(std::isfinite(frame.time_s), "time_s is not finite");
    asked.time_s = frame.time_s;
    readScenes(frame, asked);
    asked.settings = ::settingsOf(frame, asked);
    readViews(frame, with_targets, asked);
    return asked;
}

std::span<const Eye> bsp_renderer_t::eyesOf(const AskedFrame& asked, std::size_t index) {
    return std::span(asked.eyes).subspan(2 * index, std::min<std::size_t>(asked.eyes.size() - 2 * index, 2));
}

FrameSettings bsp_renderer_t::settingsOf(const AskedFrame& asked, std::size_t index) {
    FrameSettings settings = asked.settings;
    for (std::size_t e = 0; e < eyesOf(asked, index).size(); ++e) {
        settings.gazes[e] = asked.gazes[2 * index + e];
    }
    if (eyesOf(asked, index).size() == 1) {
        settings.mode = Mode::kMono;
        settings.keep_history = settings.keep_both_depths = false;
    }
    return settings;
}

void bsp_renderer_t::render(AskedFrame& asked, bsp_frame_result* result) {
    begin(asked);
    for (std::size_t p = 0; 2 * p < asked.eyes.size(); ++p) {
        const FrameResult done = part(p).render(eyesOf(asked, p), settingsOf(asked, p));
        if (p == 0 && result != nullptr) { writeStructure(result, resultOf(done, share_there_)); }
    }
    views_read_ = asked.eyes.size();
    has_depth_ = asked.settings.keep_depth;
}

Image bsp_renderer_t::read(std::uint32_t view, bool depth) {
    check(view < views_read_, "view is {}, {}", view,
          views_read_ == 0 ? "and nothing is rendered yet" : fmt::format("must be under {}", views_read_));
    StereoFrame& frame = *parts_[view / 2];
    const int eye = static_cast<int>(view % 2);
    if (!depth) { return frame.readPicture(eye); }
    check(has_depth_, "the frame kept no depths, must have BSP_FRAME_DEPTH");
    Image depths = frame.readDepth(eye);
    const Image colours = frame.readPicture(eye);
    for (std::size_t i = 0; i < depths.values.size(); ++i) {
        const float alpha = colours.values[4 * i + 3];
        depths.values[i] = alpha > 0.0f ? depths.values[i] / alpha : 0.0f;
    }
    return depths;
}

bsp_result bsp_renderer_create(bsp_device device, bsp_renderer* renderer) {
    return guarded([&] {
        check(device != nullptr && renderer != nullptr, "{} is null",
              device == nullptr ? "device" : "renderer");
        *renderer = new bsp_renderer_t(*device);
        return BSP_SUCCESS;
    });
}

void bsp_renderer_destroy(bsp_renderer renderer) { delete renderer; }

bsp_result bsp_render(bsp_renderer renderer, const bsp_frame_info* frame, bsp_frame_result* result) {
    return guarded([&] {
        check(renderer != nullptr, "renderer is null");
        if (result != nullptr) {
            checkHeader(result, BSP_TYPE_FRAME_RESULT, sizeof(bsp_header), "bsp_frame_result");
        }
        AskedFrame asked = renderer->ask(readFrame(frame), false);
        renderer->render(asked, result);
        return BSP_SUCCESS;
    });
}

namespace {

bsp_result readInto(bsp_renderer renderer, std::uint32_t view, bool depth, float* values,
                    std::uint64_t count) {
    return guarded([&] {
        check(renderer != nullptr && values != nullptr, "{} is null",
              renderer == nullptr ? "renderer" : "values");
        const Image image = renderer->read(view, depth);
        check(count >= image.values.size(), "the array holds {} floats, must hold {}", count,
              image.values.size());
        std::ranges::copy(image.values, values);
        return BSP_SUCCESS;
    });
}

}  // namespace

bsp_result bsp_read_colour(bsp_renderer renderer, std::uint32_t view, float* values, std::uint64_t count) {
    return readInto(renderer, view, false, values, count);
}

bsp_result bsp_read_depth(bsp_renderer renderer, std::uint32_t view, float* values, std::uint64_t count) {
    return readInto(renderer, view, true, values, count);
}
