// cull_pages: in a scene whose chunks come and go, lists the pages that may hold a splat that cull keeps, in
// the scene's order. The box around all that can be seen of a page is tested against the planes of the view,
// widened by the reach of the low-pass on the screen.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/sums.glsl"

layout(constant_id = 0) const uint kSplatKind = kDiscs;

const bool kPlaced = false;  // no splat of the scene is read
#include "lib/splat.glsl"
#include "lib/eye.glsl"
#include "lib/sign.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CullPagesPass pass; };

const uint kGroupWords = kGroupSize / 32;
shared uint visible_words[kGroupWords];

// The rounding error allowed for here and in cull, as a fraction of the distances that are summed.
const float kRounding = 1e-5;

struct Box {
    vec3 middle, half_size;  // in the world's axes, from the eye
};

// True if the box reaches beyond `least` along `normal`, a direction in the eye's axes of any length; also
// for NaN, which cull handles.
bool reaches(Box box, EyeView eye, vec3 normal, float least) {
    const vec3 n = normal.x * eye.camera_from_world_x + normal.y * eye.camera_from_world_y +
                   normal.z * eye.camera_from_world_z;
    const float rounding = kRounding * dot(abs(box.middle) + box.half_size, abs(n));
    return !isNegative(dot(box.middle, n) + dot(box.half_size, abs(n)) + rounding - least);
}

// One side of the view, widened or not: the points of a disc that cull tests may lie behind the eye, where a
// wider plane is not wider.
bool reachesSide(Box box, EyeView eye, vec3 normal, float wider_px, float least) {
    return reaches(box, eye, normal, least) || reaches(box, eye, normal + vec3(0, 0, wider_px), least);
}

bool mayShow(ScenePage page, EyeView eye) {
    const vec3 low = fromEye(eye, page.low), high = fromEye(eye, page.high);
    const Box box = Box(0.5 * (low + high), 0.5 * (high - low));
    if (!reaches(box, eye, vec3(0, 0, 1), eye.near)) { return false; }
    // On the screen a 3D Gaussian reaches as far as its ellipsoid does along f (1, 0, -slope), with the slope
    // clamped to the picture and its border (lib/gaussian.glsl). Beside the picture, that is at most its
    // reach along the side's normal plus the border times its reach in depth.
    const vec2 size_px = vec2(eye.size_px), to_far_edge = size_px - eye.principal_px;
    float wider_px = sqrt(kMaxCut / eye.low_pass);
    vec2 least = vec2(0);
    if (kSplatKind != kDiscs) {
        wider_px = sqrt(kMaxCut * eye.screen_variance) + kOutlinePadding;
        least = -(kDerivativeBorder * size_px + wider_px) * page.reach;
    }
    return reachesSide(box, eye, vec3(eye.focal_px.x, 0, eye.principal_px.x), wider_px, least.x) &&
           reachesSide(box, eye, vec3(-eye.focal_px.x, 0, to_far_edge.x), wider_px, least.x) &&
           reachesSide(box, eye, vec3(0, eye.focal_px.y, eye.principal_px.y), wider_px, least.y) &&
           reachesSide(box, eye, vec3(0, -eye.focal_px.y, to_far_edge.y), wider_px, least.y);
}

// By one workgroup: the visible pages of some words in order, from where the first of these words' pages
// would lie. Returns their number.
uint listPages(uint first_word, uint words) {
    const uint total = sumRange(pass.word_offsets, first_word, first_word + words);
    // As in lib/last_group.glsl: the sums are passed from the threads that made them to all.
    memoryBarrierBuffer();
    barrier();
    memoryBarrierBuffer();
    uint word = first_word + gl_LocalInvocationIndex;
    [[dont_unroll]] do {
        if (word >= first_word + words) { break; }
        uint bits = pass.page_bits.at[word], place = 32 * first_word + pass.word_offsets.at[word];
        [[dont_unroll]] while (bits != 0) {
            pass.page_list.at[place] = 32 * word + findLSB(bits);
            bits &= bits - 1;
            ++place;
        }
        word += kGroupSize;
    }
    while (word < first_word + words)
        ;
    return total;
}

void main() [[subgroup_uniform_control_flow]] {
    const uint group = groupIndex();
    if (gl_LocalInvocationIndex < kGroupWords) { visible_words[gl_LocalInvocationIndex] = 0; }
    const EyeView first_eye = shareEye(pass.eyes, pass.first_eye);
    const EyeView last_eye = shareEye(pass.eyes, pass.first_eye + pass.eye_count - 1);
    const uint i = group * kGroupSize + gl_LocalInvocationIndex;
    if (i < pass.page_count) {
        const ScenePage page = pass.pages.at[i];
        if (page.count > 0 && (mayShow(page, first_eye) || (pass.eye_count > 1 && mayShow(page, last_eye)))) {
            atomicOr(visible_words[gl_LocalInvocationIndex / 32], 1u << (gl_LocalInvocationIndex & 31));
        }
    }
    barrier();
    const uint words = groupsOver(pass.page_count, 32), word = group * kGroupWords + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex < kGroupWords && word < words) {
        pass.page_bits.at[word] = visible_words[gl_LocalInvocationIndex];
        pass.word_offsets.at[word] = bitCount(visible_words[gl_LocalInvocationIndex]);
    }
    // Like sumUp, for lib/block.glsl: if there are many, each run of pages has its own part of the list.
    const uint groups = groupsOver(pass.page_count, kGroupSize),
               length = sumRunLength(groups, kMostPageGroupsInOneRun);
    if (length < groups && group < groups) {
        const uint run = group / length, first = run * length, in_run = min(length, groups - first);
        if (isLastOfRun(pass.visible_pages, run, in_run, kSumRunBits)) {
            const uint total =
                listPages(first * kGroupWords, min(in_run * kGroupWords, words - first * kGroupWords));
            if (gl_LocalInvocationIndex == 0) { pass.page_list.at[pass.page_count + run] = total; }
        }
    }
    if (!isLastGroup(pass.visible_pages)) { return; }
    const uint total = length < groups ? sumRange(pass.page_list, pass.page_count,
                                                  pass.page_count + groupsOver(groups, length))
                                       : listPages(0, words);
    if (gl_LocalInvocationIndex != 0) { return; }
    ListState list = makeList(total, pass.page_count);
    list.per_item = dispatchOver(total, 1);
    pass.visible_pages.at[0] = list;
}
