// The images that frames are drawn into: how large they are, how they become others, and what part is used.
#include "app/view/placement/view_eyes.h"
#include "app/view/scene_renderer.h"

#include <utility>

namespace binosplat {

namespace {

glm::uvec2 scaledSize(const xr::Instance& instance, glm::uvec2 recommended_px, double scale) {
    const glm::dvec2 wanted = glm::round(scale * glm::dvec2(recommended_px));
    return glm::clamp(glm::uvec2(wanted), glm::uvec2(16), instance.maxSizePx());
}

// For the pictures of both eyes, if axes stay.
glm::uvec2 coverPx(const FrameViews& views, glm::uvec2 view_px) {
    glm::uvec2 size_px(0);
    for (const xr::EyeView& eye : views.eyes) {
        size_px = glm::max(
            size_px, coverOf(eyeInScene({}, {}, eye.fov, view_px), glm::radians(kAxesMarginDegrees)).size_px);
    }
    return size_px;
}

}  // namespace

glm::uvec2 SceneRenderer::sizePx(double scale) const {
    return scaledSize(instance_, context_px_.value_or(instance_.recommendedSizePx()), scale);
}

glm::uvec2 SceneRenderer::insetPx(const ConnectedHeadset& headset, double scale) const {
    return headset.inset ? scaledSize(instance_, headset.inset->inset_px, scale) : glm::uvec2(0);
}

SceneRenderer::ImagesWanted SceneRenderer::imagesWanted(const ConnectedHeadset& headset,
                                                        const ViewSettings& settings,
                                                        const FrameViews& views) const {
    const glm::uvec2 view_px = sizePx(settings), cover_px = coverPx(views, view_px),
                     most_px = instance_.maxSizePx();
    ImagesWanted wanted{{view_px, insetPx(headset, settings.resolution_scale), false}, view_px, view_px, {}};
    if (settings.stereo.axes != Axes::kStay) { return wanted; }
    if (headset.inset) {
        wanted.why_not_stay = "the headset takes insets";
    } else if (glm::any(glm::greaterThan(cover_px, most_px))) {
        wanted.why_not_stay = fmt::format("pictures of {}x{} are larger than the runtime's {}x{}", cover_px.x,
                                          cover_px.y, most_px.x, most_px.y);
    } else {
        wanted.asked.stay = true;
        wanted.least_px = cover_px;
        // Angles may jitter by the rounding of their float32.
        wanted.size_px = glm::min(cover_px + gpu::kTileSize, most_px);
    }
    return wanted;
}

bool SceneRenderer::suit(const ConnectedHeadset& headset, const ImagesWanted& wanted) const {
    return images_asked_ == wanted.asked &&
           glm::all(glm::greaterThanEqual(headset.images->sizePx(), wanted.least_px));
}

ImagesFor SceneRenderer::imagesFor(ConnectedHeadset& headset, const ViewSettings& settings,
                                   const FrameViews& views, bool has_window) {
    ImagesAhead& ahead = headset.images_ahead;
    ahead.passOver();
    if (!headset.images) { return {{0, 0}, true}; }
    const ImagesWanted wanted = imagesWanted(headset, settings, views);
    if (suit(headset, wanted)) {
        ahead.giveUp();
        return {headset.images->sizePx(), true};
    }
    const bool are_there = ahead.have(
        wanted.asked, wanted.size_px,
        [&context = context_, &presenter = presenter_, format = format_,
         &session = std::as_const(headset.session), wanted, takes_depth = takes_depth_,
         turned_px = presenter_.turns() && wanted.asked.stay ? wanted.asked.view_px : glm::uvec2(0),
         has_window] {
            const auto make = [&](glm::uvec2 px) {
                auto images = std::make_unique<EyeImages>(session, presenter, format, px);
                if (!takes_depth) { images->dropDepth(); }
                return images;
            };
            const glm::uvec2 inset_px = wanted.asked.inset_px;
            ImageSet set{make(wanted.size_px), inset_px.x > 0 ? make(inset_px) : nullptr, {}, {}};
            set.presented = Presenter::makeBuffers(context, glm::max(wanted.size_px, inset_px),
                                                   set.eyes->takesDepth(), turned_px);
            if (has_window) { set.mirrored = MirrorWindow::makeEye(context, wanted.size_px, format); }
            return set;
        });
    return {ahead.sizePx(), are_there};
}

void SceneRenderer::fitImages(ConnectedHeadset& headset, const ViewSettings& settings,
                              const FrameViews& views, MirrorWindow* window) {
    context_px_ = headset.inset ? std::optional(headset.inset->context_px) : std::nullopt;
    const ImagesWanted wanted = imagesWanted(headset, settings, views);
    if (std::exchange(why_not_, wanted.why_not_stay) != wanted.why_not_stay && !wanted.why_not_stay.empty()) {
        log_.say("axes follow the view: " + wanted.why_not_stay);
    }
    sizes_.stay = wanted.asked.stay;
    const glm::uvec2 inset_px = wanted.asked.inset_px;
    if (headset.images && suit(headset, wanted)) { return; }
    const ImagesAsked before = std::exchange(images_asked_, wanted.asked);
    if (!headset.images) { return makeImages(headset, wanted.size_px, inset_px); }
    if (std::optional<ImageSet> made = headset.images_ahead.take(wanted.asked)) {
        exchangeImages(headset, std::move(*made), window);
        if (suit(headset, wanted)) { return; }  // unless angles have grown meanwhile
    }
    const glm::uvec2 before_px = headset.images->sizePx();
    const glm::uvec2 inset_before_px = headset.inset_images ? headset.inset_images->sizePx() : glm::uvec2(0);
    try {
        makeImages(headset, wanted.size_px, inset_px);
    } catch (const Error&) {
        images_asked_ = before;
        makeImages(headset, before_px, inset_before_px);
        throw;
    }
}

void SceneRenderer::exchangeImages(ConnectedHeadset& headset, ImageSet images, MirrorWindow* window) {
    for (EyeImages* const eyes : {images.eyes.get(), images.insets.get()}) {
        if (eyes != nullptr && !takes_depth_) { eyes->dropDepth(); }  // refused meanwhile
    }
    std::swap(headset.images, images.eyes);
    std::swap(headset.inset_images, images.insets);
    images.presented = presenter_.exchange(std::move(images.presented));
    if (window != nullptr && images.mirrored) {
        images.mirrored = window->exchange(std::move(images.mirrored), headset.images->sizePx());
    }
    headset.images_ahead.letGo(std::move(images));
}

void SceneRenderer::makeImages(ConnectedHeadset& headset, glm::uvec2 size_px, glm::uvec2 inset_px) {
    const auto make = [&](std::unique_ptr<EyeImages>& images, glm::uvec2 px) {
        images.reset();  // first, since both may not fit
        images = std::make_unique<EyeImages>(headset.session, presenter_, format_, px);
        if (!takes_depth_) { images->dropDepth(); }
    };
    headset.inset_images.reset();
    make(headset.images, size_px);
    // Before there is a scene, so that its first frame need not.
    if (presenter_.pixels().bytes() == 0) { presenter_.reserve(size_px, headset.images->takesDepth()); }
    if (headset.inset) { make(headset.inset_images, inset_px); }
}

void SceneRenderer::govern(ConnectedHeadset& headset, const ViewSettings& settings, const FrameViews& views,
                           ShownScene& shown, MirrorWindow* window) {
    // With coarse tiles both eyes are rendered whatever the budget.
    const StereoOptions& stereo = settings.stereo;
    const bool coarse = stereo.mode == Mode::kPredicted && stereo.half_periphery &&
                        stereo.foveation_deg > 0.0 && !headset.inset;
    governor_.wish(settings.quality, coarse ? Mode::kShared : stereo.mode,
                   {stereo.warp.budget, settings.resolution_scale, stereo.warp.error_bound_db});
    fitImages(headset, settings, views, window);
    takeGoverned(headset, views, shown);
    const double scale = governed_.resolution_scale;
    sizes_.view_px = sizePx(scale);
    sizes_.images_px = headset.images->sizePx();
    headset.images->draw(sizes_.view_px);
    if (headset.inset) {
        sizes_.inset_images_px = headset.inset_images->sizePx();
        headset.inset_images->draw(insetPx(headset, scale));
        sizes_.inset_px = headset.inset_images->partPx();
    }
}

void SceneRenderer::takeGoverned(const ConnectedHeadset& headset, const FrameViews& views,
                                 ShownScene& shown) {
    const GovernedSettings& chosen = governor_.settings();
    if (chosen == governed_) { return; }
    // Larger pictures may need longer lists, which are made beside frames of the present size.
    const glm::uvec2 size_px = sizePx(chosen.resolution_scale),
                     before_px = sizePx(governed_.resolution_scale);
    const bool fits =
        governed_count_ > 0 && glm::all(glm::lessThanEqual(before_px, headset.images->sizePx()));
    if (fits && glm::any(glm::greaterThan(size_px, before_px)) &&
        !shown.growFor(sizes_.stay ? coverPx(views, size_px) : size_px,
                       insetPx(headset, chosen.resolution_scale))) {
        return;
    }
    governed_ = chosen;
    ++governed_count_;
}

}  // namespace binosplat
