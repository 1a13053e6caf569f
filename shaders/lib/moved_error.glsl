// The expected error of a pixel that is reprojected. For resample.

// The uncertainty of a pixel's inverse depth, as a variance: the pixel blends several depths, and may have
// that of one of its neighbours.
float uncertaintyOf(uint row, uint x, uint width, Resolved resolved) {
    const float own = kSpreadWeight * resolved.inverse_depth;
    float step = 0;
    [[unroll]] for (uint side = 0; side < 2; ++side) {
        const uint beside = x + 2 * side - 1;  // no column beyond either end
        const uint arrival = beside < width ? arrivalAt(row, beside) : 0;
        if (arrival != 0) { step = max(step, abs(inverseDepthOf(arrival) - resolved.inverse_depth)); }
    }
    return resolved.variance_share * (own * own) + step * step;
}

// The expected squared error of a hole's pixel, which repeats what is `repeated_px` away: hidden content is
// expected to differ from that as much as the content at the same distance on the other side does.
float holeError(WarpView warp, vec2 source_px, int repeated_px) {
    const ivec2 last = ivec2(warp.size_px) - 1;
    const ivec2 source = ivec2(floor(clamp(source_px, vec2(-1e6), vec2(1e6))));
    const ivec2 here = clamp(source, ivec2(0), last),
                beyond = clamp(source + ivec2(repeated_px, 0), ivec2(0), last);
    const int width = last.x + 1;
    const vec3 difference = warp.hole_error * (sourceAt(uint(beyond.y * width + beyond.x)).rgb -
                                               sourceAt(uint(here.y * width + here.x)).rgb);
    return dot(difference, difference) + kLeastHoleError;
}
