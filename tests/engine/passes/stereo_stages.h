// The stereo passes on the device, one at a time, over arrays that come from the host and go back to it.
#pragma once

#include "tests/engine/passes/pass_stages.h"
#include "tests/engine/passes/stereo_cases.h"

namespace binosplat::test {

// Where moving pixels and arrivals lie: in buffers of their own, or row by row in the space of the affiliated
// eye's colours, which are floats or half floats.
enum class Rows { kOwn, kShared, kOwnHalves, kSharedHalves };
inline bool isShared(Rows rows) { return rows == Rows::kShared || rows == Rows::kSharedHalves; }
inline bool areHalves(Rows rows) { return rows == Rows::kOwnHalves || rows == Rows::kSharedHalves; }

// The longest row that resample keeps in shared memory.
inline std::uint32_t longestSharedRow(const Context& context) {
    return mostRowSteps(context) * gpu::kArrivalsStep;
}

// The arrays of the passes of warp and choose. Each call runs one pass; between calls, every array can be
// read or replaced. Arrays that a pass must write start as kUnwritten.
class StereoOnDevice {
public:
    static constexpr gpu::uint kUnwritten = 0xcdcdcdcdu;

    StereoOnDevice(Gpu& gpu, const gpu::WarpView& view, const std::vector<gpu::vec4>& colours,
                   const std::vector<gpu::uint>& moving, Rows rows = Rows::kOwn, std::uint32_t boxes = 64)
        : gpu_(gpu),
          rows_(rows),
          view_(withRows(view, rows)),
          colours_(areHalves(rows) ? gpu.upload("dominant colours", packHalves(colours))
                                   : gpu.upload("dominant colours", colours)),
          boxes_(gpu.allocate<gpu::PixelBox>("boxes", boxes)),
          box_capacity_(boxes) {
        writeWords(0, std::vector<gpu::uint>(pixelCount(), 0));
        writeWords(firstMoving(), moving);
    }

    // `ranges`: of the dominant eye's pairs. Arrays that the pass must clear are not clear before.
    // `may_move`: the dominant eye left what moving needs.
    void weigh(const std::vector<reference::TileRange>& ranges, bool hidden_tiles,
               std::size_t visible_count = 0, bool may_move = true) {
        const Buffer range_buffer = gpu_.upload("ranges", ranges),
                     lists = gpu_.upload("lists", std::vector{makeList(visible_count), gpu::ListState{}});
        gpu_.upload(counters_, std::vector{gpu::WarpCounters{}});
        for (Buffer* array : {&tile_errors, &tile_depths, &tile_mask, &bins}) {
            *array = makeArray(array->bytes() / sizeof(gpu::uint), kUnwritten);
        }
        dispatch(WeighKernel{.rectified = rectified()},
                 gpu::WeighPass{.warp = at(view_buffer_),
                                .ranges = at(range_buffer),
                                .moving = may_move ? moving() : gpu::DeviceAddress<gpu::uint>{},
                                .tile_kinds = at(tile_kinds),
                                .tile_costs = at(tile_costs),
                                .tile_errors = at(tile_errors),
                                .tile_depths = at(tile_depths),
                                .tile_mask = at(tile_mask),
                                .price_bins = at(bins),
                                .shown_mask = shownMask(hidden_tiles),
                                .visible = at(lists),
                                .masked_tiles = lists.address<gpu::ListState>(sizeof(gpu::ListState)),
                                .counters = at(counters_),
                                .kinds_given = 1},
                 tileGroups());
    }
    void boundDepths() {
        dispatch(DepthBoundsKernel{.half_colours = areHalves(rows_)},
                 gpu::DepthBoundsPass{.warp = at(view_buffer_),
                                      .colours = at(colours_),
                                      .half_colours = at(colours_),
                                      .moving = moving(),
                                      .bins = at(bins)},
                 {groupsOver(view_.size_tiles.x, gpu::kBoundsTiles), view_.size_tiles.y});
    }
    void findEdgeRois(bool hidden_tiles = false) {
        dispatch(EdgeRoisKernel{.rectified = rectified()},
                 gpu::EdgeRoisPass{.warp = at(view_buffer_),
                                   .bins = at(bins),
                                   .tile_kinds = at(tile_kinds),
                                   .shown_mask = shownMask(hidden_tiles),
                                   .counters = at(counters_)},
                 tileGroups());
    }
    void reproject(bool hidden_tiles = false, bool forward = false) {
        dispatch(ReprojectKernel{.rectified = rectified(), .forward = forward},
                 gpu::ReprojectPass{.warp = at(view_buffer_),
                                    .moving = moving(),
                                    .arrivals = arrivals(),
                                    .shown_mask = shownMask(hidden_tiles)},
                 pixelGroups());
    }
    // Splats in `order` as `scene` holds them, with the number of tiles that each meets in the dominant eye;
    // eye 1 is the affiliated one.
    void addNewcomers(const SceneOnDevice& scene, const std::vector<std::uint32_t>& order,
                      const std::vector<gpu::uint>& dominant_tiles) {
        std::vector<glm::uvec2> sets;
        for (const gpu::uint tiles : dominant_tiles) { sets.emplace_back(0, tiles << 10); }
        const Buffer order_buffer = gpu_.upload("order", order),
                     set_buffer = gpu_.upload("dominant sets of tiles", sets),
                     lists = gpu_.upload("lists", std::vector{makeList(order.size())});
        dispatch(NewcomersKernel{.splat_kind = scene.scene.splatKind()},
                 gpu::NewcomersPass{.chunks = scene.scene.chunks(),
                                    .eyes = at(scene.eyes),
                                    .warp = at(view_buffer_),
                                    .tile_depths = at(tile_depths),
                                    .order = at(order_buffer),
                                    .visible = at(lists),
                                    .source_sets = at(set_buffer),
                                    .tile_kinds = at(tile_kinds),
                                    .tile_errors = at(tile_errors),
                                    .counters = at(counters_),
                                    .chunk_bits = scene.scene.chunkBits(),
                                    .eye = 1,
                                    .is_dimmed = scene.scene.traits().is_dimmed},
                 {groupsOver(order.size(), gpu::kNewcomersBlock), 1});
    }
    struct ResampleParts {
        bool errors = false, depths = false, classes = false, components = false, forward = false;
        bool moves_row = false, hidden_tiles = false;  // of the dominant eye: moves its pixels itself
        glm::vec3 background{0.0f};
        bool odd = false;  // only rows, in two dispatches: see takeRowsApart
    };
    // From here on, resample takes half of the rows at a time.
    void takeRowsApart() {
        view_.rows_apart = 2;
        gpu_.upload(view_buffer_, std::vector{view_});
    }
    void resample(const ResampleParts& parts) {
        const bool whole = parts.errors && !parts.classes && !parts.hidden_tiles;
        const gpu::uint moved = whole ? gpu::kWholeRowMoved : gpu::kRowMoved;
        const gpu::uint row_source = parts.odd && rectified() != 0 ? gpu::kPlacesGiven
                                     : parts.moves_row             ? moved
                                                                   : gpu::kArrivalsGiven;
        const std::uint32_t width = view_.size_px.x;
        const bool shares = row_source != gpu::kPlacesGiven && width <= longestSharedRow(gpu_.context());
        const std::uint32_t row_steps = shares ? (width + gpu::kArrivalsStep - 1) / gpu::kArrivalsStep : 0;
        dispatch(ResampleKernel{.rectified = rectified(),
                                .row_steps = row_steps,
                                .half_colours = areHalves(rows_),
                                .row_source = row_source,
                                .way = parts.classes   ? gpu::kDoesAny
                                       : parts.errors  ? gpu::kPredicts
                                       : parts.forward ? gpu::kCopies
                                                       : gpu::kSamples},
                 gpu::ResamplePass{.warp = at(view_buffer_),
                                   .source = at(colours_),
                                   .half_source = at(colours_),
                                   .moving = parts.moves_row ? moving() : arrivals(),
                                   .target = at(affiliated),
                                   .half_target = at(affiliated),
                                   .depths = parts.depths ? at(depths) : gpu::DeviceAddress<float>{},
                                   .tile_kinds = at(tile_kinds),
                                   .tile_errors = parts.errors || parts.odd ? at(tile_errors)
                                                                            : gpu::DeviceAddress<gpu::uint>{},
                                   .pixel_classes = at(classes_),
                                   .counters = at(counters_),
                                   .shown_mask = shownMask(parts.hidden_tiles),
                                   .background = parts.background,
                                   .first_row = parts.odd ? 1u : 0u,
                                   .copies_colours = parts.forward ? 1u : 0u,
                                   .groups_holes = parts.components ? 1u : 0u},
                 {(view_.size_px.y + view_.rows_apart - 1) / view_.rows_apart, 1});
    }
    // All steps of the pass, whatever the counters say about holes.
    void findComponents() {
        const gpu::ComponentsPass pass{.warp = at(view_buffer_),
                                       .pixels = at(affiliated),
                                       .pixel_classes = at(classes_),
                                       .boxes = at(boxes_),
                                       .tile_kinds = at(tile_kinds),
                                       .counters = at(counters_),
                                       .box_capacity = box_capacity_,
                                       .slots_apart = areHalves(rows_) ? 1u : 2u};
        for (std::uint32_t step = 0; step < 3; ++step) {
            dispatch(ComponentsKernel{.step = step}, pass, pixelGroups());
        }
        dispatch(ComponentsKernel{.step = 3}, pass, {3, 1});
    }

    template <typename T = gpu::uint>
    [[nodiscard]] std::vector<T> read(const Buffer& array) {
        return gpu_.readBack<T>(array, array.bytes() / sizeof(T));
    }
    void write(const Buffer& array, const std::vector<gpu::uint>& values) { gpu_.upload(array, values); }

    [[nodiscard]] std::vector<gpu::uint> readArrivals() { return readWords(0); }
    [[nodiscard]] std::vector<gpu::uint> readMoving() { return readWords(firstMoving()); }
    [[nodiscard]] std::vector<gpu::vec4> readAffiliated() {
        return areHalves(rows_) ? unpackHalves(read<gpu::uvec2>(affiliated)) : read<gpu::vec4>(affiliated);
    }
    // Of a pixel's colour.
    [[nodiscard]] std::size_t wordsPerPixel() const { return areHalves(rows_) ? 2 : 4; }
    [[nodiscard]] gpu::WarpCounters readCounters() { return read<gpu::WarpCounters>(counters_)[0]; }
    [[nodiscard]] std::vector<std::uint8_t> readClasses() {
        const auto packed = read(classes_);
        std::vector<std::uint8_t> classes(pixelCount());
        for (std::size_t i = 0; i < classes.size(); ++i) {
            classes[i] = static_cast<std::uint8_t>(packed[classWord(i)] >> classShift(i) & 3);
        }
        return classes;
    }

    void writeArrivals(const std::vector<gpu::uint>& arrivals) { writeWords(0, arrivals); }
    void writeClasses(const std::vector<std::uint8_t>& classes) {
        std::vector<gpu::uint> packed(classes_.bytes() / sizeof(gpu::uint), 0);
        for (std::size_t i = 0; i < classes.size(); ++i) {
            packed[classWord(i)] |= gpu::uint{classes[i]} << classShift(i);
        }
        gpu_.upload(classes_, packed);
    }
    void writeCounters(const gpu::WarpCounters& counters) { gpu_.upload(counters_, std::vector{counters}); }
    // One byte per tile, which is 1 if the dominant eye's lens hides it.
    void writeHidden(const std::vector<std::uint8_t>& hidden) {
        std::vector<gpu::uint> shown = maskOf(hidden, view_.size_tiles);
        for (gpu::uint& word : shown) { word = ~word; }
        gpu_.upload(shown_mask_, shown);
    }

    // Whether pixels move along their rows.
    [[nodiscard]] std::uint32_t rectified() const {
        const glm::vec3 zero(0.0f);
        const auto alongRows = [&](const gpu::PixelMap& map) {
            return map.excess_y == zero && map.excess_z == zero && map.shift.y == 0.0f && map.shift.z == 0.0f;
        };
        return alongRows(view_.target_from_source) && alongRows(view_.source_from_target) ? 1 : 0;
    }
    [[nodiscard]] std::size_t pixelCount() const { return std::size_t{view_.size_px.x} * view_.size_px.y; }
    [[nodiscard]] std::size_t tileCount() const {
        return std::size_t{view_.size_tiles.x} * view_.size_tiles.y;
    }

private:
    static gpu::WarpView withRows(gpu::WarpView view, Rows rows) {
        view.row_words = (!isShared(rows) ? 1 : areHalves(rows) ? 2 : 4) * view.size_px.x;
        return view;
    }
    static gpu::WarpCounters movingAll() {
        gpu::WarpCounters counters{};
        counters.moves = 1;
        return counters;
    }
    // Two bits for each pixel, a row of a tile in a word.
    [[nodiscard]] std::size_t classWord(std::size_t pixel) const {
        return pixel / view_.size_px.x * view_.size_tiles.x + pixel % view_.size_px.x / 16;
    }
    [[nodiscard]] std::size_t classShift(std::size_t pixel) const { return pixel % view_.size_px.x % 16 * 2; }
    static std::uint32_t groupsOver(std::size_t items, std::uint32_t group_items = gpu::kWarpGroup) {
        return static_cast<std::uint32_t>((items + group_items - 1) / group_items);
    }
    [[nodiscard]] glm::uvec2 tileGroups() const { return {groupsOver(tileCount()), 1}; }
    [[nodiscard]] glm::uvec2 pixelGroups() const { return {view_.size_tiles.x, 2 * view_.size_tiles.y}; }

    // Of arrivals and, from `firstMoving` on, of moving pixels.
    [[nodiscard]] const Buffer& words() const { return isShared(rows_) ? affiliated : own_words_; }
    [[nodiscard]] std::size_t firstMoving() const { return isShared(rows_) ? view_.size_px.x : pixelCount(); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> arrivals() const { return at(words()); }
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> moving() const {
        return words().address<gpu::uint>(sizeof(gpu::uint) * firstMoving());
    }
    [[nodiscard]] std::size_t wordOf(std::size_t pixel, std::size_t first) const {
        return first + pixel / view_.size_px.x * view_.row_words + pixel % view_.size_px.x;
    }
    [[nodiscard]] std::vector<gpu::uint> readWords(std::size_t first) {
        const auto all = read(words());
        std::vector<gpu::uint> values(pixelCount());
        for (std::size_t i = 0; i < values.size(); ++i) { values[i] = all[wordOf(i, first)]; }
        return values;
    }
    void writeWords(std::size_t first, const std::vector<gpu::uint>& values) {
        auto all = read(words());
        for (std::size_t i = 0; i < values.size(); ++i) { all[wordOf(i, first)] = values[i]; }
        gpu_.upload(words(), all);
    }

    template <typename K>
    void dispatch(const K& variant, const typename K::Pass& pass, glm::uvec2 groups) {
        gpu_.dispatch(gpu_.kernel(variant), pass, groups);
    }
    [[nodiscard]] Buffer makeArray(std::size_t count, gpu::uint value) {
        return gpu_.upload("stereo array", std::vector<gpu::uint>(count, value));
    }
    // Where the dominant eye's lens hides parts; null if nowhere.
    [[nodiscard]] gpu::DeviceAddress<gpu::uint> shownMask(bool hidden_tiles) const {
        return hidden_tiles ? at(shown_mask_) : gpu::DeviceAddress<gpu::uint>{};
    }

    Gpu& gpu_;
    Rows rows_;
    gpu::WarpView view_;
    Buffer view_buffer_ = gpu_.upload("stereo view", std::vector{view_}),
           counters_ = gpu_.upload("stereo counters", std::vector{movingAll()});
    Buffer colours_, boxes_;
    Buffer classes_ = makeArray(std::size_t{view_.size_tiles.x} * view_.size_px.y, kUnwritten),
           shown_mask_ = makeArray(WarpBuffers::maskWords(view_.size_px), ~0u);
    // If rows have a buffer of their own.
    Buffer own_words_ = isShared(rows_) ? Buffer() : makeArray(2 * pixelCount(), 0);
    std::uint32_t box_capacity_;

public:
    // Of the affiliated eye; bins are depths, or prices.
    Buffer affiliated = makeArray(wordsPerPixel() * pixelCount(), kUnwritten),
           depths = makeArray(pixelCount(), kUnwritten), tile_kinds = makeArray(tileCount(), 0),
           tile_costs = makeArray(tileCount(), kUnwritten), tile_errors = makeArray(tileCount(), 0),
           tile_depths = makeArray(tileCount(), kUnwritten),
           tile_mask = makeArray(WarpBuffers::maskWords(view_.size_px), 0),
           bins = makeArray(gpu::kDepthBins, 0);
    static_assert(gpu::kDepthBins == gpu::kPriceBins);
};

inline gpu::WarpView viewOfCase(const StereoCase& c) {
    gpu::WarpView view =
        warpViewOf(relate(c.eyes.source, c.eyes.target), c.sizePx(), c.sizePx().x, settingsOf(c.settings));
    view.rows_apart = 1;  // until takeRowsApart
    return view;
}
inline StereoOnDevice toDevice(Gpu& gpu, const StereoCase& c, Rows rows = Rows::kOwn) {
    StereoOnDevice device(gpu, viewOfCase(c), coloursOf(c.dominant), movingOf(c.dominant, c.settings), rows);
    if (!c.settings.source_hidden.empty()) { device.writeHidden(c.settings.source_hidden); }
    return device;
}

}  // namespace binosplat::test
