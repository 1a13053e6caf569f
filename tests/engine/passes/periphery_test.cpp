// Facts about pictures of half the size for where an eye does not look: both passes against the float64 twin, on the device.
#include "engine/passes/periphery.h"
#include "engine/reference/periphery.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/engine/passes/past_stages.h"

SUITE(periphery) {

using Tiles = std::vector<std::uint8_t>;

Eye wideEye(glm::uvec2 size_px) { return {Pose{}, intrinsicsFromAngles({-0.9, 0.7, 0.8, -0.85}, size_px), size_px}; }

std::size_t pixelCount(const Eye& eye) { return std::size_t{eye.size_px.x} * eye.size_px.y; }
std::size_t tileCount(const Eye& eye) { return test::tileCount(eye.size_px); }

// Smooth, with details here and there that an eye would miss.
std::vector<glm::vec4> makeHalfPicture(const Eye& half) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> noise(-1.0f, 1.0f);
    std::vector<glm::vec4> colours;
    for (std::size_t i = 0; i < pixelCount(half); ++i) {
        const auto x = static_cast<float>(i % half.size_px.x), y = static_cast<float>(i / half.size_px.x);
        const float detail = 0.1f * std::max(std::sin(0.05f * x) * std::sin(0.04f * y), 0.0f);
        colours.emplace_back(0.5f + 0.3f * std::sin(0.11f * x) + detail * noise(random), 0.5f + 0.3f * std::cos(0.09f * y), 0.3f,
                             0.5f + 0.5f * std::sin(0.05f * (x + y)));
    }
    return colours;
}

// Every seventh tile, and a corner.
Tiles someHidden(const Eye& eye) {
    Tiles hidden(tileCount(eye), 0);
    for (std::size_t t = 0; t < hidden.size(); ++t) { hidden[t] = t % 7 == 3 || t % tilesOf(eye.size_px).x < 2 ? 1 : 0; }
    return hidden;
}

Tiles tilesOfMask(std::span<const gpu::uint> mask, const Eye& eye) {
    const glm::uvec2 tiles = tilesOf(eye.size_px);
    Tiles marked;
    for (std::size_t t = 0; t < tileCount(eye); ++t) {
        const std::size_t x = t % tiles.x, y = t / tiles.x;
        marked.push_back(static_cast<std::uint8_t>(mask[y * ((tiles.x + 31) / 32) + x / 32] >> (x % 32) & 1));
    }
    return marked;
}

// What a half-size picture knows of its pixels and tiles.
std::vector<gpu::uint> makeWords(std::size_t count) {
    std::vector<gpu::uint> words;
    for (std::size_t i = 0; i < count; ++i) { words.push_back(static_cast<gpu::uint>(i % 5 == 0 ? 0 : 1000 + i)); }
    return words;
}
std::vector<gpu::PastTile> makePastTiles(std::size_t count) {
    std::vector<gpu::PastTile> tiles;
    for (std::size_t t = 0; t < count; ++t) {
        const float error = 0.001f * static_cast<float>(t % 9);
        tiles.push_back({static_cast<gpu::uint>(10 * t), 3, gpu::vec4(0.5f), {error, 2 * error, 3 * error, 4 * error}, {1, 2, 3, 4}});
    }
    return tiles;
}

// The passes over pictures that come from the host.
class OnDevice {
public:
    OnDevice(Gpu& gpu, const Eye& eye, const Gaze& gaze, const Tiles& hidden, const std::vector<glm::vec4>& half_colours,
             const std::vector<float>& half_depths, bool halves)
        : gpu_(gpu),
          eye_(eye),
          half_eye_(halfOf(eye)),
          gaze_(gaze),
          buffers_(makeFrameBuffers(gpu.context(), 1)),
          tiles_(gpu.context(), eye.size_px),
          shown_(gpu.context()),
          passes_(gpu.context()) {
        shown_.set(hidden, tilesOf(eye.size_px));
        half_ = {.colours = halves ? gpu.upload("half colours", test::packHalves(half_colours)) : gpu.upload("half colours", half_colours),
                 .half_floats = halves,
                 .size_px = half_eye_.size_px};
        target_ = {.colours = gpu.upload("colours", std::vector<gpu::uint>((halves ? 2 : 4) * pixelCount(eye), kUnwritten)),
                   .half_floats = halves,
                   .size_px = eye.size_px};
        if (halves) {  // and later pictures are made from it
            half_.words = gpu.upload("half words", std::vector<gpu::uint>(pixelCount(half_eye_), kUnwritten));
            half_.tiles =
                gpu.upload("half tiles", std::vector<gpu::PastTile>(tileCount(half_eye_), gpu::PastTile{kUnwritten, 0, {}, {}, {}}));
            target_.words = gpu.upload("words", std::vector<gpu::uint>(pixelCount(eye), kUnwritten));
            target_.tiles = gpu.upload("tiles", std::vector<gpu::PastTile>(tileCount(eye), gpu::PastTile{kUnwritten, 0, {}, {}, {}}));
        }
        half_.depths = gpu.upload("half depths", half_depths);
        target_.depths = gpu.upload("depths", std::vector<gpu::uint>(pixelCount(eye), kUnwritten));
        gpu.upload(buffers_.state, std::vector{FrameState{}});
        gpu.run([&](Commands& commands) {
            shown_.record(commands);
            passes_.recordHalfChoice(commands, inputs());
        });
        if (halves) {
            nothing_known_ =
                std::ranges::all_of(gpu.readBack<gpu::uint>(half_.words, pixelCount(half_eye_)), [](gpu::uint word) { return word == 0; });
            gpu.upload(half_.colours, test::packHalves(half_colours));
            gpu.upload(half_.words, makeWords(pixelCount(half_eye_)));
            gpu.upload(half_.tiles, makePastTiles(tileCount(half_eye_)));
        }
        gpu.run([&](Commands& commands) {
            passes_.recordChoice(commands, inputs());
            passes_.recordFill(commands, inputs());
        });
        state_ = gpu.readBack<FrameState>(buffers_.state, 1).front();
        words_ = gpu.readBack<gpu::uint>(tiles_.buffer(), tiles_.buffer().bytes() / sizeof(gpu::uint));
    }

    // What is in a mask, if the list has the same tiles, each once.
    [[nodiscard]] Tiles ownTiles() const { return checked(0, eye_, state_.targets[0].chosen_tiles); }
    [[nodiscard]] Tiles halfTiles() const {
        return checked(WarpBuffers::maskWords(eye_.size_px) + 2 * tileCount(eye_), half_eye_, state_.targets[1].chosen_tiles);
    }
    [[nodiscard]] std::vector<glm::vec4> colours() {
        return target_.half_floats ? test::unpackHalves(gpu_.readBack<glm::uvec2>(target_.colours, pixelCount(eye_)))
                                   : gpu_.readBack<glm::vec4>(target_.colours, pixelCount(eye_));
    }
    [[nodiscard]] std::vector<float> depths() { return gpu_.readBack<float>(target_.depths, pixelCount(eye_)); }
    [[nodiscard]] std::vector<gpu::uint> words() { return gpu_.readBack<gpu::uint>(target_.words, pixelCount(eye_)); }
    [[nodiscard]] std::vector<gpu::PastTile> pastTiles() { return gpu_.readBack<gpu::PastTile>(target_.tiles, tileCount(eye_)); }
    // Whether the words of the half-size picture had been cleared before it was there.
    [[nodiscard]] bool wasCleared() const { return nothing_known_; }

    static constexpr gpu::uint kUnwritten = 0x3c003c00u;  // of half floats two ones

private:
    [[nodiscard]] PeripheryInputs inputs() const {
        return {buffers_, tiles_, 0, 1, Role::kNone, target_, half_, shown_, glm::vec3(0.25f), eye_.intrinsics, gaze_};
    }
    [[nodiscard]] Tiles checked(std::size_t first_word, const Eye& eye, const gpu::ListState& state) const {
        const std::span<const gpu::uint> words = std::span(words_).subspan(first_word);
        const Tiles marked = tilesOfMask(words, eye);
        Tiles listed(marked.size(), 0);
        CHECK(state.needed == state.count);
        for (const gpu::uint tile : words.subspan(WarpBuffers::maskWords(eye.size_px), state.count)) {
            REQUIRE(tile < listed.size());
            CHECK(listed[tile] == 0);
            listed[tile] = 1;
        }
        CHECK(listed == marked);
        return marked;
    }

    Gpu& gpu_;
    Eye eye_, half_eye_;
    Gaze gaze_;
    FrameBuffers buffers_;
    PeripheryBuffers tiles_;
    ShownTiles shown_;
    PeripheryPasses passes_;
    Picture half_, target_;
    FrameState state_{};
    std::vector<gpu::uint> words_;
    bool nothing_known_ = false;
};

std::vector<glm::dvec4> inDoubles(const std::vector<glm::vec4>& colours) { return {colours.begin(), colours.end()}; }

// What the picture leaves to later ones is the twin's.
void checkPast(OnDevice& device, const Eye& eye, const Eye& half, const std::vector<glm::dvec4>& colours, const Tiles& hidden,
               const Tiles& own) {
    CHECK(device.wasCleared());
    const std::vector<gpu::uint> half_words = makeWords(pixelCount(half)), words = device.words();
    const std::vector<gpu::PastTile> half_tiles = makePastTiles(tileCount(half)), tiles = device.pastTiles();
    reference::Past twin{
        eye, {}, std::vector<std::optional<reference::MovingPixel>>(pixelCount(eye)), std::vector<reference::PastTile>(tileCount(eye))};
    reference::Past from{half, {}, {}, {}};
    // The word itself stands for the depth.
    for (const gpu::uint word : half_words) {
        from.pixels.push_back(word == 0 ? std::nullopt : std::optional(reference::MovingPixel{static_cast<double>(word), 0}));
    }
    for (const gpu::PastTile& tile : half_tiles) { from.tiles.push_back(test::tileOf(tile)); }
    reference::fillPast(twin, from, reference::expectLosses(colours, eye), own, hidden);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::size_t tile = test::tileOf(i, eye.size_px);
        const double expected = own[tile] != 0 ? OnDevice::kUnwritten : twin.pixels[i] ? twin.pixels[i]->inverse_depth : 0.0;
        REQUIRE(words[i] == static_cast<gpu::uint>(expected));
    }
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (own[t] != 0) {  // cleared before it is rendered
            REQUIRE(tiles[t].cost == 0);
            continue;
        }
        REQUIRE(std::abs(static_cast<double>(tiles[t].cost) - static_cast<double>(twin.tiles[t].cost)) <= 1.0);
        REQUIRE(tiles[t].age == 0);
        for (int q = 0; q < 4; ++q) {
            REQUIRE(static_cast<double>(tiles[t].errors[q]) ==
                    doctest::Approx(twin.tiles[t].errors[static_cast<std::size_t>(q)]).epsilon(1e-3));
        }
    }
}

const std::vector<Gaze> kGazes{{{0.0, 0.0, 1.0}, 0.0}, {{0.0, 0.0, 1.0}, 0.35}, {{-3.0, 1.0, 4.0}, 0.1}, {{1.0, 0.0, 0.0}, 0.2}};
const std::vector<glm::uvec2> kSizes{{1, 1}, {2, 3}, {16, 16}, {17, 33}, {31, 32}, {33, 15}, {275, 403}};

TEST_CASE_FIXTURE(Gpu, "the tiles of both pictures are the twin's, and those that are not rendered are filled as the twin fills them") {
    std::size_t half_tiles = 0, within = 0, own_tiles = 0, filled = 0, kept = 0;
    int runs = 0;
    for (const glm::uvec2& size_px : kSizes) {
        const Eye eye = wideEye(size_px), half = halfOf(eye);
        for (const Gaze& gaze : kGazes) {
            for (const Tiles& hidden : {Tiles{}, someHidden(eye)}) {
                const bool halves = (runs++ / 2 + (hidden.empty() ? 0 : 1)) % 2 != 0;
                INFO("size ", size_px.x, ", clear ", gaze.clear_rad, ", hidden.empty ", hidden.empty(), ", halves ", halves);
                auto colours = makeHalfPicture(half);
                if (halves) { colours = test::unpackHalves(test::packHalves(colours)); }
                std::vector<float> depths;
                for (const glm::vec4& colour : colours) { depths.push_back(colour.a * (2.0f + colour.r)); }
                const reference::Gaze its_gaze{gaze.direction, gaze.clear_rad};
                OnDevice device(*this, eye, gaze, hidden, colours, depths, halves);
                CHECK(device.halfTiles() == reference::findHalfTiles(eye, its_gaze, hidden));
                half_tiles += static_cast<std::size_t>(std::ranges::count(device.halfTiles(), 1));
                const Tiles expected = reference::findOwnTiles(inDoubles(colours), eye, its_gaze, hidden), own = device.ownTiles();
                const std::vector<double> losses = reference::expectSeenLosses(inDoubles(colours), eye, its_gaze);
                const Tiles beyond = reference::findBeyond(eye, its_gaze);
                for (std::size_t t = 0; t < own.size(); ++t) {
                    // What is as good as either.
                    if (own[t] != expected[t]) { CHECK(losses[t] == doctest::Approx(0.0256).epsilon(1e-4)); }
                    own_tiles += own[t];
                    within += own[t] != 0 && beyond[t] == 0 ? 1 : 0;
                }
                reference::Picture whole{size_px, std::vector<glm::dvec4>(pixelCount(eye)), std::vector<double>(pixelCount(eye)), {}, {}};
                const reference::Picture samples{half.size_px, inDoubles(colours), {depths.begin(), depths.end()}, {}, {}};
                reference::fillPeriphery(whole, samples, own, hidden, glm::dvec3(0.25));
                const auto made = device.colours();
                const auto made_depths = device.depths();
                const glm::vec4 unwritten(halves ? 1.0f : std::bit_cast<float>(OnDevice::kUnwritten));
                double off = 0.0, off_depth = 0.0;
                for (std::size_t i = 0; i < made.size(); ++i) {
                    const bool is_own = own[test::tileOf(i, size_px)] != 0;
                    ++(is_own ? kept : filled);
                    if (is_own) {
                        REQUIRE(made[i] == unwritten);
                        continue;
                    }
                    for (int c = 0; c < 4; ++c) { off = std::max(off, std::abs(static_cast<double>(made[i][c]) - whole.rgba[i][c])); }
                    off_depth = std::max(off_depth, std::abs(static_cast<double>(made_depths[i]) - whole.depth[i]));
                }
                if (halves) { checkPast(device, eye, half, inDoubles(colours), hidden, own); }
                CHECK(off < (halves ? 2e-3 : 1e-6));
                CHECK(off_depth < (halves ? 1e-2 : 1e-5));
            }
        }
    }
    CHECK(half_tiles > 100);
    CHECK(within > 100);
    CHECK(own_tiles > within + 100);  // what lies beyond but is seen
    CHECK(filled > 100000);
    CHECK(kept > 10000);
}

TEST_CASE("half of an eye's picture is the same view") {
    for (const glm::uvec2& size_px : kSizes) {
        const Eye eye = wideEye(size_px);
        for (const Eye& half : {halfOf(eye), reference::halfOf(eye)}) {
            CHECK(half.own_pixel_px == 0.5);
            CHECK(2u * half.size_px.x - size_px.x <= 1);
            CHECK(2u * half.size_px.y - size_px.y <= 1);
            // The middle of four pixels and of their sample is one direction.
            CHECK((2.0 - eye.intrinsics.cx) / eye.intrinsics.fx == doctest::Approx((1.0 - half.intrinsics.cx) / half.intrinsics.fx));
            CHECK((2.0 - eye.intrinsics.cy) / eye.intrinsics.fy == doctest::Approx((1.0 - half.intrinsics.cy) / half.intrinsics.fy));
        }
    }
}

TEST_CASE("a ramp is filled as a ramp, and a flat picture is seen nowhere") {
    const Eye eye = wideEye({160, 128}), half = reference::halfOf(eye);
    reference::Picture whole{eye.size_px, std::vector<glm::dvec4>(pixelCount(eye)), std::vector<double>(pixelCount(eye)), {}, {}};
    reference::Picture ramp{half.size_px, {}, {}, {}, {}};
    for (std::size_t i = 0; i < pixelCount(half); ++i) {
        ramp.rgba.emplace_back(2.0 * static_cast<double>(i % half.size_px.x) + 1.0, 0.5, 0.5, 1.0);
        ramp.depth.push_back(3.0);
    }
    reference::fillPeriphery(whole, ramp, Tiles(tileCount(eye), 0));
    for (std::size_t x = 4; x < 156; ++x) {
        const std::size_t i = 64 * std::size_t{eye.size_px.x} + x;
        CHECK(whole.rgba[i].r == doctest::Approx(static_cast<double>(x) + 0.5));
        CHECK(whole.rgba[i].g == doctest::Approx(0.5));
        CHECK(whole.depth[i] == doctest::Approx(3.0));
    }
    // All of it lies far aside of the gaze.
    const Eye fine = wideEye({640, 512});
    const reference::Gaze aside{{-3.0, 3.0, -1.0}, 0.0};
    const std::vector<glm::dvec4> flat(pixelCount(reference::halfOf(fine)), glm::dvec4(0.7));
    CHECK(std::ranges::all_of(reference::expectSeenLosses(flat, fine, aside), [](double loss) { return loss == 0.0; }));
    CHECK(std::ranges::count(reference::findOwnTiles(flat, fine, aside), 1) == 0);
}

}  // SUITE(periphery)
