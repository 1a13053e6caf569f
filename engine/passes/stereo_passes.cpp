// Recording the passes that make one eye from the other.
#include "engine/passes/stereo_passes.h"

#include "engine/geometry.h"

#include <cmath>
#include <cstddef>

namespace binosplat {
namespace {

// Components of holes beyond this many stand for themselves, pixel by pixel.
constexpr gpu::uint kMarkGroups = 64;

glm::dmat3 matrixOf(const Intrinsics& k) { return glm::dmat3(k.fx, 0, 0, 0, k.fy, 0, k.cx, k.cy, 1); }

// Target pixels from source pixels (paper, equations 3 to 5, with the pixel's inverse depth in place of its depth).
gpu::PixelMap pixelMap(const Eye& target, const Eye& source) {
    const Pose target_from_source = compose(inverse(target.world_from_camera), source.world_from_camera);
    const Intrinsics &k = target.intrinsics, &l = source.intrinsics;
    const glm::dquat& q = target.world_from_camera.orientation;
    const glm::dquat& r = source.world_from_camera.orientation;
    glm::dmat3 excess;
    if (q.w == r.w && q.x == r.x && q.y == r.y && q.z == r.z) {
        // K' K^-1 less the identity: exactly 0 wherever the intrinsics agree, so that rows stay rows if fy and cy do.
        const double x = k.fx / l.fx, y = k.fy / l.fy;
        excess = glm::dmat3(x - 1, 0, 0, 0, y - 1, 0, k.cx - x * l.cx, k.cy - y * l.cy, 0);
    } else {
        excess = matrixOf(k) * glm::mat3_cast(target_from_source.orientation) * glm::inverse(matrixOf(l)) - glm::dmat3(1.0);
    }
    glm::dvec3 shift = matrixOf(k) * target_from_source.position;
    // Eyes side by side differ along x alone, up to the rounding of their positions.
    for (int i = 1; i < 3; ++i) {
        if (std::abs(shift[i]) < 1e-12 * (std::abs(shift.x) + glm::length(source.world_from_camera.position))) { shift[i] = 0.0; }
    }
    const auto row = [&](int i) { return glm::vec3(excess[0][i], excess[1][i], excess[2][i]); };
    return {row(0), row(1), row(2), glm::vec3(shift)};
}

}  // namespace

gpu::StereoView stereoViewOf(const Eye& dominant, const Eye& affiliated, const StereoSettings& settings) {
    const glm::uvec2 tiles = tilesOf(dominant.size_px);
    gpu::StereoView view{};
    view.affiliated_from_dominant = pixelMap(affiliated, dominant);
    view.dominant_from_affiliated = pixelMap(dominant, affiliated);
    view.size_px = dominant.size_px;
    view.size_tiles = tiles;
    view.depth_choice = settings.depth_choice;
    view.gap_px = settings.gap_px;
    view.margin_px = settings.margin_px;
    view.edge_samples = settings.edge_samples;
    view.tight_edges = settings.tight_edges ? 1 : 0;
    view.center_rois = settings.center_rois ? 1 : 0;
    view.budget_tiles = static_cast<gpu::uint>(std::floor(settings.budget * (1.0 * tiles.x * tiles.y - settings.hidden_tiles)));
    view.hole_error = static_cast<float>(settings.hole_error);
    view.newcomer_error = static_cast<float>(settings.newcomer_error);
    return view;
}

bool isRectified(const gpu::StereoView& view) {
    const glm::vec3 zero(0.0f);
    const auto alongRows = [&](const gpu::PixelMap& map) {
        return map.excess_y == zero && map.excess_z == zero && map.shift.y == 0.0f && map.shift.z == 0.0f;
    };
    return alongRows(view.affiliated_from_dominant) && alongRows(view.dominant_from_affiliated);
}

bool isShifted(const gpu::StereoView& view) {
    const glm::vec3& row = view.affiliated_from_dominant.excess_x;
    return isRectified(view) && row.x == 0.0f && row.y == 0.0f;
}

void StereoPasses::record(Commands& commands, const GpuScene& scene, const FrameBuffers& buffers, const StereoBuffers& stereo,
                          const StereoSettings& settings, bool rectified, int dominant_eye, const EyeImage& dominant,
                          const EyeImage& affiliated, const std::array<ShownTiles, 2>& shown) {
    const auto view = buffers.state.address<gpu::StereoView>(offsetof(FrameState, stereo));
    const auto counters = buffers.state.address<gpu::StereoCounters>(offsetof(FrameState, stereo_counters));
    const auto visible = buffers.state.address<gpu::ListState>(FrameBuffers::visibleList(0));
    const auto colours = dominant.colours.address<gpu::vec4>();
    const auto depths = dominant.depths.address<float>();
    const auto pixels = affiliated.colours.address<gpu::StereoPixel>();
    const glm::uvec2 size_px = stereo.sizePx(), tiles = tilesOf(size_px);
    const std::uint32_t along_rows = rectified ? 1 : 0;
    const bool read_depth = settings.depth_choice != gpu::kDepthInverse;
    const bool predict = settings.patching == Patching::kPredicted;
    const bool paper = settings.patching == Patching::kPaper;
    const ShownTiles &dominant_shown = shown[dominant_eye], &affiliated_shown = shown[1 - dominant_eye];
    const bool dominant_hides = dominant_shown.hideAny(), affiliated_hides = affiliated_shown.hideAny();

    commands.beginPass("affiliated 8a_reproject");
    commands.fillZero(stereo.tiles());
    affiliated_shown.recordKinds(commands, stereo.tiles(), stereo.tileKindsOffset());
    commands.dispatch(kernels_.get("8a_reproject", sizeof(gpu::ReprojectPass), {along_rows, read_depth, dominant_hides}),
                      gpu::ReprojectPass{view, colours, depths, pixels, dominant_shown.before()}, tiles.x, tiles.y);
    commands.beginPass("affiliated 8b_resolve");
    commands.dispatch(kernels_.get("8b_resolve", sizeof(gpu::ResolvePass), {along_rows, predict, affiliated_hides}),
                      gpu::ResolvePass{view, colours, pixels, stereo.tileErrors(), stereo.tileKinds(), counters}, size_px.y);
    if (paper) {
        commands.beginPass("affiliated 8c_depth_bounds");
        commands.dispatch(kernels_.get("8c_depth_bounds", sizeof(gpu::DepthBoundsPass), {along_rows, read_depth}),
                          gpu::DepthBoundsPass{view, colours, depths, pixels, stereo.depthBins()}, tiles.x, tiles.y);
        commands.beginPass("affiliated 8d_edge_rois");
        commands.dispatch(kernels_.get("8d_edge_rois", sizeof(gpu::EdgeRoisPass), {along_rows}),
                          gpu::EdgeRoisPass{view, stereo.depthBins(), stereo.tileKinds(), counters}, 1);
    }
    if (paper && settings.center_rois) {
        commands.beginPass("affiliated 8e_components");
        const gpu::ComponentsPass pass{
            view, affiliated.colours.address<gpu::ComponentPixel>(), stereo.boxes(), stereo.tileKinds(), counters, stereo.boxCapacity()};
        const std::uint64_t groups = offsetof(FrameState, stereo_counters) + offsetof(gpu::StereoCounters, component_groups);
        for (std::uint32_t step = 0; step < 4; ++step) {
            commands.dispatchIndirect(kernels_.get("8e_components", sizeof(gpu::ComponentsPass), {along_rows, step}), pass, buffers.state,
                                      groups);
        }
        commands.dispatch(kernels_.get("8e_components", sizeof(gpu::ComponentsPass), {along_rows, 4u}), pass, kMarkGroups);
    }
    if (predict) {
        commands.beginPass("affiliated 8f_newcomers");
        const std::uint64_t visible_list = FrameBuffers::visibleList(0);
        commands.dispatchIndirect(
            kernels_.get("8f_newcomers", sizeof(gpu::NewcomersPass)),
            gpu::NewcomersPass{scene.chunks(), buffers.eyes(), view, pixels, buffers.visible.order().values, visible,
                               buffers.visible.tileCounts(), buffers.state.address<gpu::ListState>(FrameBuffers::pairList(dominant_eye)),
                               stereo.tileErrors(), counters, scene.chunkBits(), static_cast<gpu::uint>(1 - dominant_eye)},
            buffers.state, visible_list + offsetof(gpu::ListState, per_item));
    }
    if (paper || predict) {
        commands.beginPass("affiliated 8g_select");
        commands.dispatch(
            kernels_.get("8g_select", sizeof(gpu::SelectPass), {along_rows, predict, dominant_hides}),
            gpu::SelectPass{view, stereo.tileErrors(), stereo.tileKinds(), stereo.tileList(), stereo.tilesBefore(), visible,
                            buffers.state.address<gpu::ListState>(offsetof(FrameState, masked_tiles)),
                            buffers.state.address<gpu::ListState>(offsetof(FrameState, masked_visible)), counters, dominant_shown.before()},
            1);
    }
}

void StereoPasses::recordResample(Commands& commands, const FrameBuffers& buffers, const StereoBuffers& stereo, bool rectified,
                                  const EyeImage& dominant, const EyeImage& affiliated, const glm::vec3& background) {
    const auto view = buffers.state.address<gpu::StereoView>(offsetof(FrameState, stereo));
    const glm::uvec2 tiles = tilesOf(stereo.sizePx());
    commands.beginPass("affiliated 9_resample");
    commands.dispatch(kernels_.get("9_resample", sizeof(gpu::ResamplePass), {rectified ? 1u : 0u, affiliated.depths.bytes() > 0 ? 1u : 0u}),
                      gpu::ResamplePass{view, dominant.colours.address<gpu::vec4>(), affiliated.colours.address<gpu::StereoPixel>(),
                                        affiliated.colours.address<gpu::vec4>(), affiliated.depths.address<float>(), stereo.tileKinds(),
                                        stereo.pixelClasses(), background},
                      tiles.x, tiles.y);
}

}  // namespace binosplat
