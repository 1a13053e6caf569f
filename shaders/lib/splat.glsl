// A splat from the scene to the camera: loading, and the ray-disc intersection of 2DGS (Huang et al. 2024,
// section 4.2) in the form that ProjectedSplat holds. Needs kSplatKind and kPlaced.
//
// A disc point is P(u, v) = u a + v b + c with a = s_u t_u, b = s_v t_v, c in camera space. A pixel's ray is
// z r with r = ((x - cx)/fx, (y - cy)/fy, 1). From u a + v b + c = z r follows (u, v, 1)/z = [a b c]^-1 r,
// and with t_w = t_u x t_v and delta = t_w . c the rows of that inverse are
//   u/z = (t_v x c) . r / (s_u delta),   v/z = (c x t_u) . r / (s_v delta),   1/z = t_w . r / delta:
// linear in the pixel, and free of the cancellation that det(a, b, c) has for tiny or long discs.

#include "lib/exact.glsl"

// A splat in camera space.
struct CameraSplat {
    vec3 centre;
    vec3 t_u, t_v;
    vec2 scale;
    float thickness;  // of 3D Gaussians
    float opacity;
};

vec3 cameraFromWorld(EyeView eye, vec3 direction) {
    return vec3(dot(eye.camera_from_world_x, direction), dot(eye.camera_from_world_y, direction),
                dot(eye.camera_from_world_z, direction));
}

// First and second column of the rotation matrix of a unit quaternion x, y, z, w.
void tangents(vec4 q, out vec3 t_u, out vec3 t_v) {
    t_u = vec3(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z), 2 * (q.x * q.z - q.w * q.y));
    t_v = vec3(2 * (q.x * q.y - q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x));
}

// Where a splat of the scene is. A chunk's addresses are read one by one, since some compilers crash if all
// of them are copied.
struct SplatPlace {
    uint chunk, in_chunk;
};
SplatPlace placeOfSplat(uint i, uint chunk_bits) {
    return SplatPlace(i >> chunk_bits, i & ((1u << chunk_bits) - 1));
}

// The placement of a chunk's scene among others, if there are any.
vec3 placed(SceneChunks chunks, uint chunk, vec3 position) {
    if (!kPlaced) { return position; }
    Placements placements = Placements(chunks.at[chunk].placement);
    const vec3 turned =
        position.x * placements.at[0].x + position.y * placements.at[0].y + position.z * placements.at[0].z;
    return placements.at[0].scale * turned + placements.at[0].position;
}
vec3 placedDirection(SceneChunks chunks, uint chunk, vec3 direction) {
    if (!kPlaced) { return direction; }
    Placements placements = Placements(chunks.at[chunk].placement);
    return direction.x * placements.at[0].x + direction.y * placements.at[0].y +
           direction.z * placements.at[0].z;
}
vec3 directionInScene(SceneChunks chunks, uint chunk, vec3 direction) {
    if (!kPlaced) { return direction; }
    Placements placements = Placements(chunks.at[chunk].placement);
    return vec3(dot(direction, placements.at[0].x), dot(direction, placements.at[0].y),
                dot(direction, placements.at[0].z));
}
float placedScale(SceneChunks chunks, uint chunk) {
    return kPlaced ? Placements(chunks.at[chunk].placement).at[0].scale : 1;
}

vec3 positionOf(SceneChunks chunks, SplatPlace at) {
    return placed(chunks, at.chunk, Vec3s(chunks.at[at.chunk].positions).at[at.in_chunk]);
}

// The splat in world space, without its chunk's fade.
CameraSplat loadUnfadedSplat(SceneChunks chunks, SplatPlace at) {
    const uvec2 positions = chunks.at[at.chunk].positions;
    Vec4s rotations = chunks.at[at.chunk].rotations;
    Vec2s scales = chunks.at[at.chunk].scales;
    const uvec2 thicknesses = chunks.at[at.chunk].thicknesses, opacities = chunks.at[at.chunk].opacities;
    CameraSplat splat;
    tangents(rotations.at[at.in_chunk], splat.t_u, splat.t_v);
    splat.t_u = placedDirection(chunks, at.chunk, splat.t_u);
    splat.t_v = placedDirection(chunks, at.chunk, splat.t_v);
    splat.centre = placed(chunks, at.chunk, Vec3s(positions).at[at.in_chunk]);
    const float scale = placedScale(chunks, at.chunk);
    splat.scale = scale * scales.at[at.in_chunk];
    splat.thickness = kSplatKind != kDiscs ? scale * Floats(thicknesses).at[at.in_chunk] : 0;
    splat.opacity = Floats(opacities).at[at.in_chunk];
    return splat;
}

CameraSplat loadWorldSplat(SceneChunks chunks, SplatPlace at) {
    CameraSplat splat = loadUnfadedSplat(chunks, at);
    splat.opacity *= chunks.at[at.chunk].fade;
    return splat;
}

// The vector from one place in the world, given in two floats, to another. Both may be close together and far
// from the origin: in this order, the first difference is exact if it is small compared with its terms.
vec3 fromPlace(vec3 from, vec3 from_low, vec3 position) {
    precise const vec3 difference = (position - from) - from_low;
    return difference;
}
vec3 fromEye(EyeView eye, vec3 position) { return fromPlace(eye.position, eye.position_low, position); }

CameraSplat cameraFromWorld(EyeView eye, CameraSplat splat) {
    splat.centre = cameraFromWorld(eye, fromEye(eye, splat.centre));
    splat.t_u = cameraFromWorld(eye, splat.t_u);
    splat.t_v = cameraFromWorld(eye, splat.t_v);
    return splat;
}

CameraSplat loadCameraSplat(SceneChunks chunks, SplatPlace at, EyeView eye) {
    return cameraFromWorld(eye, loadWorldSplat(chunks, at));
}

// rho at which alpha falls to 1/255; not positive for a splat that is never visible.
float cutOf(float opacity) { return opacity >= kMinAlpha ? (log2(opacity) + kLog2Of255) / kLog2PerRho : 0; }

// Opacity as -log2, so that alpha = exp2(-(this + kLog2PerRho rho)), with the sign as a flag.
float packOpacity(float opacity, bool has_reference) {
    // An opacity is at most 1, and at least 0 after dimming.
    const float negative_log2 = abs(log2(max(opacity, 1e-37)));
    return has_reference ? negative_log2 : uintBitsToFloat(floatBitsToUint(negative_log2) | 0x80000000u);
}
bool hasReference(ProjectedSplat splat) { return (floatBitsToUint(splat.opacity) & 0x80000000u) == 0; }
float negativeLog2Opacity(ProjectedSplat splat) { return abs(splat.opacity); }

// The remainder of reference_px that single precision drops, x and y in eight bits each, in units of half its
// last place. Without it, the edge of a splat of a few pixels would be wrong by 1e-4 of its alpha in a
// picture of 768 pixels, and that of a disc seen edge-on by far more.
vec2 halfLastPlace(vec2 value) {
    return uintBitsToFloat(floatBitsToUint(value) & 0x7f800000u) * 5.9604645e-8;
}
uint packRest(vec2 reference_px, vec2 rest_px) {
    return packSnorm4x8(vec4(0, 0, rest_px / max(halfLastPlace(reference_px), vec2(1e-30))));
}
vec2 restOfReference(ProjectedSplat splat) {
    return unpackSnorm4x8(splat.colour.y).zw * halfLastPlace(splat.reference_px);
}

uvec2 packColour(vec3 colour) {
    // The greatest half float is 65504; colours are not negative.
    const vec3 finite = mix(vec3(0), min(colour, vec3(65504)), greaterThan(colour, vec3(0)));
    return uvec2(packHalf2x16(finite.rg), packHalf2x16(vec2(finite.b, 0)));
}
vec3 unpackColour(uvec2 packed) { return vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x); }

// The geometry of ProjectedSplat; see there. `has_reference`: the centre is beyond the near plane.
ProjectedSplat projectGeometry(CameraSplat splat, EyeView eye, out bool has_reference) {
    const vec3 c = splat.centre;
    has_reference = c.z > eye.near;
    const vec2 middle_px = vec2(eye.size_px) * 0.5;
    ProjectedSplat p;
    p.reference_px = has_reference ? eye.focal_px * c.xy / c.z + eye.principal_px : middle_px;
    p.inverse_depth = 1 / c.z;
    p.plane_from_pixel = vec3(kMaxPlaneSlope, 0, kMaxPlaneSlope);
    p.perspective = vec2(0);
    p.opacity = packOpacity(splat.opacity, has_reference);
    p.colour = uvec2(0);

    const vec3 t_w = cross(splat.t_u, splat.t_v);
    const float delta = dot(t_w, c);
    const vec3 row_u = cross(splat.t_v, c) / (splat.scale.x * delta);
    const vec3 row_v = cross(c, splat.t_u) / (splat.scale.y * delta);
    const vec3 row_w = t_w / delta;
    // Turn (u, v) within the disc so that v/z does not depend on dx.
    const vec2 along_x = vec2(row_u.x, row_v.x) / eye.focal_px.x;
    const vec2 along_y = vec2(row_u.y, row_v.y) / eye.focal_px.y;
    const float a = length(along_x);
    const vec2 turn = along_x / a;  // cosine, sine
    const vec3 plane = vec3(a, dot(turn, along_y), turn.x * along_y.y - turn.y * along_y.x);
    const bool disc = abs(delta) > kEdgeOnSine * length(c) && a < kMaxPlaneSlope &&
                      abs(plane.y) < kMaxPlaneSlope && abs(plane.z) < kMaxPlaneSlope && a > 0;
    if (disc) {
        p.plane_from_pixel = plane;
        p.perspective = row_w.xy / eye.focal_px;
        if (!has_reference) {
            const vec3 ray = vec3((middle_px - eye.principal_px) / eye.focal_px, 1);
            const vec2 offset = vec2(dot(row_u, ray), dot(row_v, ray));
            p.reference_px = vec2(dot(turn, offset), turn.x * offset.y - turn.y * offset.x);
            p.inverse_depth = dot(row_w, ray);
        }
    }
    return p;
}

// The projected centre to about 32 bits, from `position` in the world, for a splat that has a reference.
void placeExactly(inout ProjectedSplat p, vec3 position, EyeView eye) {
    const vec2 x = addExact(exactSum(position.x, -eye.position.x), vec2(-eye.position_low.x, 0));
    const vec2 y = addExact(exactSum(position.y, -eye.position.y), vec2(-eye.position_low.y, 0));
    const vec2 z = addExact(exactSum(position.z, -eye.position.z), vec2(-eye.position_low.z, 0));
    const vec2 depth = dotExact(eye.camera_from_world_z, eye.camera_from_world_z_low, x, y, z);
    const vec2 slope_x =
        divideExact(dotExact(eye.camera_from_world_x, eye.camera_from_world_x_low, x, y, z), depth);
    const vec2 slope_y =
        divideExact(dotExact(eye.camera_from_world_y, eye.camera_from_world_y_low, x, y, z), depth);
    const vec2 x_px = addExact(multiplyExact(vec2(eye.focal_px.x, eye.focal_px_low.x), slope_x),
                               vec2(eye.principal_px.x, eye.principal_px_low.x));
    const vec2 y_px = addExact(multiplyExact(vec2(eye.focal_px.y, eye.focal_px_low.y), slope_y),
                               vec2(eye.principal_px.y, eye.principal_px_low.y));
    p.reference_px = vec2(x_px.x, y_px.x);
    p.colour.y = packRest(p.reference_px, vec2(x_px.y, y_px.y));
}
