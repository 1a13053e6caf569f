// How sharply an eye sees its picture, by the angle from its gaze.

float angleFromGaze(EyeGaze gaze, vec2 px) {
    const vec3 direction = vec3((px - gaze.principal_px) / gaze.focal_px, 1);
    return atan(length(cross(direction, gaze.direction)), dot(direction, gaze.direction));
}

vec2 middleOfTile(uvec2 tile) { return vec2(tile * kTileSize + kTileSize / 2); }

float finestCycle(EyeGaze gaze, float angle) {
    return kFovealCycle + kCyclePerAngle * max(angle - gaze.clear_rad, 0);
}

// The finest cycle that an eye resolves grows linearly with the angle from its gaze (Guenter et al. 2012). A
// picture has cycles of two pixels and longer; the eye sees the share of them that is not finer than what it
// resolves, along both axes.
float seenShare(EyeGaze gaze, uvec2 tile) {
    const float share = min(gaze.pixel_cycle / finestCycle(gaze, angleFromGaze(gaze, middleOfTile(tile))), 1);
    return share * share;
}

// The same with the angular size of the pixels there: the farther they are from the lens's axis, the smaller
// they appear.
float seenShareThere(EyeGaze gaze, uvec2 tile) {
    const vec2 px = middleOfTile(tile);
    const float stretch = length(vec3((px - gaze.principal_px) / gaze.focal_px, 1));
    const float solid_angle = 1 / (gaze.focal_px.x * gaze.focal_px.y * stretch * stretch * stretch),
                finest = finestCycle(gaze, angleFromGaze(gaze, px));
    return min(4 * solid_angle / (finest * finest), 1);
}
