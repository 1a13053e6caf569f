// Choosing, uploading and laying out the small pictures of the room.
#include "app/view/room/room_things.h"

#include "app/view/room/vignette.h"

#include <algorithm>

namespace binosplat {

namespace {

// A controller of no particular make: a handle in the fist, and a knob in front of it.
constexpr double kHandleWidthMetres = 0.035, kHandleBehindMetres = 0.07, kHandleAheadMetres = 0.045,
                 kKnobMetres = 0.055;
// What goes on without, if the runtime fails.
constexpr const char *kHands = "pictures of hands", *kArcs = "arcs",
                     *kMessages = "messages in front of the eyes";

}  // namespace

RoomThings::RoomThings(const xr::Session& session, const Context& context, vk::Format format)
    : troubles_(session.instance().troubles()), layout_(texelLayoutOf(format)), hand_drawing_(layout_) {
    if (!troubles_.tryFor("rays, controllers and the vignette",
                          [&] { makeSheet(session, context, format); })) {
        sheet_ = {};
    }
    const auto make = [&](DrawnImage& image, const char* name, glm::uvec2 size_px) {
        image.images = xr::Swapchain(session, name, size_px, format, xr::ImageUse::kDraw);
        image.texels = Buffer(context, name, std::uint64_t{size_px.x} * size_px.y * sizeof(std::uint32_t));
    };
    troubles_.tryFor(kArcs, [&] { make(arc_, "an arc", kArcPx); });
    troubles_.tryFor(kMessages, [&] { make(message_, "a message", kMessagePx); });
    if (!session.instance().tracksHands()) { return; }
    for (DrawnImage& hand : hands_) {
        troubles_.tryFor(kHands, [&] { make(hand, "a hand", kHandPicturePx); });
    }
}

void RoomThings::makeSheet(const xr::Session& session, const Context& context, vk::Format format) {
    const TexelPicture sheet = drawSprites(layout_);
    sheet_ = xr::Swapchain(session, "things in the room", sheet.size_px, format, xr::ImageUse::kDraw);
    const std::uint64_t bytes = sheet.texels.size() * sizeof(std::uint32_t);
    const Buffer upload(context, "things in the room", bytes, MemoryKind::kUpload);
    std::ranges::copy(sheet.texels, upload.mapped<std::uint32_t>().begin());
    Commands commands(context);
    commands.begin();
    commands.copyToImage(upload, sheet_.acquire(), sheet.size_px, vk::ImageAspectFlagBits::eColor);
    commands.submitAndWait();
    sheet_.release();
}

void RoomThings::giveUp() {
    quads_.clear();
    vignette_.reset();
    hands_ = {};
    arc_ = {};
    message_ = {};
    sheet_ = {};
}

xr::LayerQuad RoomThings::quadOf(const Thing& thing) const {
    const SpritePlace place = placeOf(thing.sprite);
    return {thing.strip.room_from_strip, thing.strip.size_m, &sheet_, place.from_px, place.size_px, false,
            nameOf(thing.sprite)};
}

void RoomThings::add(const Thing& thing) {
    if (sheet_.handle() != XR_NULL_HANDLE) { quads_.push_back(quadOf(thing)); }
}

void RoomThings::darken(double darkness, double width_m) {
    if (darkness <= 0.0 || sheet_.handle() == XR_NULL_HANDLE) { return; }
    const SpritePlace place = placeOfShade(darkness);
    const Pose ahead{glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, kVignetteMetres}};
    vignette_ = xr::LayerQuad{ahead,         glm::dvec2(width_m),   &sheet_,   place.from_px,
                              place.size_px, /*follows_head*/ true, "the dark"};
}

void RoomThings::choose(const RoomSight& sight) {
    quads_.clear();
    vignette_.reset();
    if (sight.vignette_m && sheet_.handle() != XR_NULL_HANDLE) {
        const Pose ahead{glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, kVignetteMetres}};
        vignette_ = quadOf({Sprite::kVignette, {ahead, glm::dvec2(*sight.vignette_m)}});
        vignette_->follows_head = true;
    }
    for (std::size_t h = 0; sight.hands && h < 2; ++h) {
        chooseHand((*sight.hands)[h], hands_[h], sight.eye);
    }
    if (sight.arc != nullptr) { chooseArc(*sight.arc, sight.eye); }
    for (const Thing& thing : sight.things) { add(thing); }
    if (sight.has_message) { chooseMessage(sight.message, sight.message_place); }
}

void RoomThings::chooseMessage(const std::optional<TexelPicture>& picture, const glm::dvec3& place) {
    if (picture && message_.texels.bytes() > 0) {
        if (!troubles_.tryFor(kMessages, [&] { message_.now = message_.images.acquire(); })) {
            message_ = {};
        }
        message_.picture = *picture;
    }
    if (message_.texels.bytes() == 0 || message_.picture.texels.empty()) { return; }
    const glm::dvec2 size_px(message_.picture.size_px);
    const Pose ahead{glm::dquat(1.0, 0.0, 0.0, 0.0), place};
    quads_.push_back({ahead,
                      kMessageMetres * glm::dvec2(1.0, size_px.y / size_px.x),
                      &message_.images,
                      {0, 0},
                      message_.picture.size_px,
                      /*follows_head*/ true,
                      "a message"});
}

void RoomThings::chooseArc(const Arc& arc, const glm::dvec3& eye) {
    if (arc_.texels.bytes() == 0) { return; }
    if (!troubles_.tryFor(kArcs, [&] { arc_.now = arc_.images.acquire(); })) {
        arc_ = {};
        return;
    }
    ArcPicture drawn = drawArc(arc, eye, layout_);
    arc_.picture = std::move(drawn.picture);
    for (std::size_t i = 0; i < kArcPieces; ++i) {
        const auto& place = drawn.places[i];
        const glm::uvec2 from_px(static_cast<std::uint32_t>(i) * kArcPiecePx.x, 0);
        if (place) {
            quads_.push_back(
                {place->room_from_strip, place->size_m, &arc_.images, from_px, kArcPiecePx, false, "an arc"});
        }
    }
}

void RoomThings::chooseHand(const xr::Hand& hand, DrawnImage& image, const glm::dvec3& eye) {
    const bool has_picture = hand.joints && image.texels.bytes() > 0;
    if (has_picture && troubles_.tryFor(kHands, [&] { image.now = image.images.acquire(); })) {
        const Strip place = handPicturePlace(*hand.joints, eye);
        hand_drawing_.draw(*hand.joints, place, eye, image.picture);
        quads_.push_back(
            {place.room_from_strip, place.size_m, &image.images, {0, 0}, kHandPicturePx, false, "a hand"});
        return;
    }
    if (has_picture) { image = {}; }  // no image was available
    if (hand.grip) {
        const auto along = [&](double metres) { return transform(*hand.grip, glm::dvec3(0.0, 0.0, metres)); };
        const Strip knob = facing(along(kHandleAheadMetres), glm::dvec2(kKnobMetres), eye);
        const std::optional<Strip> handle =
            stripBetween(along(-kHandleBehindMetres), along(kHandleAheadMetres), kHandleWidthMetres, eye);
        // The farther one first.
        const bool knob_is_behind =
            glm::distance(along(kHandleAheadMetres), eye) > glm::distance(along(-kHandleBehindMetres), eye);
        if (knob_is_behind) { add({Sprite::kKnob, knob}); }
        if (handle) { add({Sprite::kHandle, *handle}); }
        if (!knob_is_behind) { add({Sprite::kKnob, knob}); }
    }
}

void RoomThings::record(Commands& commands) {
    for (DrawnImage* image : drawnImages()) {
        if (!image->now) { continue; }
        const std::vector<std::uint32_t>& texels = image->picture.texels;
        commands.update(image->texels, texels.data(), texels.size() * sizeof texels[0], 0);
        commands.copyToImage(image->texels, image->now, image->picture.size_px,
                             vk::ImageAspectFlagBits::eColor);
    }
}

void RoomThings::release() {
    for (DrawnImage* image : drawnImages()) {
        const char* const what = image == &message_ ? kMessages : image == &arc_ ? kArcs : kHands;
        if (!std::exchange(image->now, nullptr) || troubles_.tryFor(what, [&] { image->images.release(); })) {
            continue;
        }
        std::erase_if(quads_, [&](const xr::LayerQuad& quad) { return quad.swapchain == &image->images; });
        *image = {};
    }
}

void RoomThings::addBehindPanel(xr::Layers& layers) const {
    if (vignette_) { layers.addQuad(*vignette_); }
}

void RoomThings::addBeforePanel(xr::Layers& layers) const {
    for (const xr::LayerQuad& quad : quads_) { layers.addQuad(quad); }
}

}  // namespace binosplat
