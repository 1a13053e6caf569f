// Three small drawings, and a file that records that they were shown.
#include "app/view/panel/first_steps.h"

#include "app/view/panel/message_picture.h"
#include "app/view/settings/view_files.h"
#include "engine/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <utility>

namespace binosplat {

namespace {

constexpr std::array<const char*, kGestures> kWords{
    "Left stick: walk where you look. Right stick: turn; ahead and back: rise and sink.",
    "With Teleport on the panel, the left stick ahead or a trigger throws an arc: let go to stand where it "
    "ends.",
    "Menu, Y or B hide the panel, or bring it before your eyes. Bare hands: pinch, with the palm to you."};

constexpr double kLine = 0.035, kSoft = 0.03;
constexpr glm::dvec3 kPlain(0.8), kHint = kRayLight, kPlace(0.2, 0.8, 1.0);

double toSegment(const glm::dvec2& at, const glm::dvec2& a, const glm::dvec2& b) {
    const double t = std::clamp(glm::dot(at - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(at, a + t * (b - a));
}

// What is drawn at a point of the square from -1 to 1 in each direction, y down.
struct Pen {
    glm::dvec2 at;
    DrawnPoint point{};

    void ink(double distance, double half_width, const glm::dvec3& light) {
        const double alpha = std::clamp((half_width - distance) / kSoft + 0.5, 0.0, 1.0);
        if (alpha >= point.alpha) { point = {light, alpha}; }
    }
    void line(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec3& light) {
        ink(toSegment(at, a, b), kLine, light);
    }
    void disc(const glm::dvec2& middle, double radius, const glm::dvec3& light) {
        ink(glm::distance(at, middle), radius, light);
    }
    void ring(const glm::dvec2& middle, const glm::dvec2& radius, const glm::dvec3& light) {
        const double share = glm::length((at - middle) / radius);
        ink(std::abs(share - 1.0) * std::min(radius.x, radius.y), kLine, light);
    }
    // From `from` outwards, with its tip at `to`.
    void arrow(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec3& light) {
        const glm::dvec2 back = 0.16 * glm::normalize(from - to), aside(-back.y, back.x);
        line(from, to, light);
        line(to, to + back + aside, light);
        line(to, to + back - aside, light);
    }
    // A handle below a round head with a stick and a button, `size` times as large as the square.
    void controller(const glm::dvec2& middle, double size, const glm::dvec3& stick,
                    const glm::dvec3& button) {
        const auto there = [&](double x, double y) { return middle + size * glm::dvec2(x, y); };
        ring(there(0.0, -0.25), glm::dvec2(0.55 * size), kPlain);
        line(there(-0.25, 0.25), there(-0.2, 0.95), kPlain);
        line(there(0.25, 0.25), there(0.2, 0.95), kPlain);
        line(there(-0.2, 0.95), there(0.2, 0.95), kPlain);
        disc(there(-0.12, -0.35), 0.16 * size, stick);
        disc(there(0.25, -0.1), 0.1 * size, button);
    }
};

DrawnPoint drawMoving(const glm::dvec2& at) {
    Pen pen{at};
    pen.controller({0.05, 0.1}, 0.85, kHint, kPlain);
    const glm::dvec2 stick(-0.05, -0.2);
    for (const glm::dvec2& way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, -1), glm::dvec2(0, 1)}) {
        pen.arrow(stick + 0.25 * way, stick + 0.72 * way, kHint);
    }
    return pen.point;
}

DrawnPoint drawThrowing(const glm::dvec2& at) {
    Pen pen{at};
    pen.controller({-0.65, 0.4}, 0.5, kHint, kPlain);
    const auto thrown = [](double t) {
        return glm::dvec2(-0.45 + 1.05 * t, 0.1 - 2.6 * t * (1.0 - t) + 0.6 * t);
    };
    for (int i = 0; i < 12; ++i) { pen.line(thrown(i / 12.0), thrown((i + 1) / 12.0), kHint); }
    pen.ring({0.6, 0.72}, {0.34, 0.14}, kPlace);
    return pen.point;
}

DrawnPoint drawPanelWay(const glm::dvec2& at) {
    Pen pen{at};
    pen.controller({-0.5, 0.25}, 0.7, kPlain, kHint);
    const glm::dvec2 low(0.1, -0.85), high(0.9, 0.25);
    for (const auto& [a, b] :
         {std::pair(low, glm::dvec2(high.x, low.y)), std::pair(glm::dvec2(high.x, low.y), high),
          std::pair(high, glm::dvec2(low.x, high.y)), std::pair(glm::dvec2(low.x, high.y), low)}) {
        pen.line(a, b, kPlace);
    }
    for (const double y : {-0.6, -0.3, 0.0}) { pen.line({0.25, y}, {0.75, y}, kPlace); }
    return pen.point;
}

std::filesystem::path seenFile() { return viewFolder() / "first-steps-shown"; }

}  // namespace

TexelPicture drawGesture(std::size_t gesture, const TexelLayout& layout) {
    static constexpr std::array<DrawnPoint (*)(const glm::dvec2&), kGestures> kDrawings{
        drawMoving, drawThrowing, drawPanelWay};
    return drawMessage(kWords.at(gesture), layout, kDrawings.at(gesture));
}

void FirstSteps::look() {
    if (std::exchange(has_looked_, true) || shown_ == FirstStepsShown::kNever) { return; }
    files_.read("looking for what was shown",
                [this, always = shown_ == FirstStepsShown::kAlways]() -> FileWorker::Done {
                    bool were_shown =
                        true;  // otherwise they would be shown every time if nothing can be saved
                    try {
                        std::error_code ignored;
                        were_shown = !always && std::filesystem::exists(seenFile(), ignored);
                    } catch (const Error&) {}
                    return [this, were_shown] { next_ = were_shown ? kGestures : 0; };
                });
}

std::optional<std::size_t> FirstSteps::update(double step_seconds) {
    look();
    seconds_left_ = std::max(seconds_left_ - step_seconds, 0.0);
    if (seconds_left_ > 0.0 || next_ == kGestures) { return std::nullopt; }
    seconds_left_ = kSecondsEach;
    if (next_ + 1 == kGestures) {
        files_.write("noting what was shown", []() -> FileWorker::Done {
            try {
                std::error_code ignored;
                std::filesystem::create_directories(viewFolder(), ignored);
                std::ofstream(seenFile()) << "The first three gestures were shown.\n";
            } catch (const Error&) {}
            return [] {};
        });
    }
    return next_++;
}

}  // namespace binosplat
