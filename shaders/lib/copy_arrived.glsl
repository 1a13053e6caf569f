// Colours that are copied, as in the paper. For resample.

// The source's pixel that arrived in a pixel of the row.
vec4 arrivedColour(WarpView warp, uint row, uvec2 at) {
    const uint arrival = arrivalAt(row, at.x);
    const vec2 place_px = movePixel(warp.source_from_target, vec2(at) + 0.5, inverseDepthOf(arrival)).xy;
    const ivec2 source = clamp(pixelOfParity(place_px, arrival), ivec2(0), ivec2(warp.size_px) - 1);
    return sourceAt(uint(source.y) * warp.size_px.x + uint(source.x));
}

struct Copied {
    vec4 colour;
    uint pixel_class;
    float inverse_depth;
};

// The paper to the letter. Section 3.1, stage 2: the initial view is the source pixels where they were
// projected; each keeps its colour. Stage 4: gaps, "small and surrounded by valid reprojected pixels", are
// "filled through adaptive interpolation". It does not say how small, or what adapts: here they are runs of
// up to gap_px in a row, with colours interpolated linearly between the run's two ends, whichever is farther.
// Longer runs are not filled in any other way in the paper either if centre ROIs are off (figure 3 a), and
// get the same; at the picture's border there is only one end. A row that nothing reached shows what is
// infinitely far away.
Copied copyArrived(WarpView warp, uint row, uvec2 at) {
    const bool here = arrivalAt(row, at.x) != 0;
    const int left = here ? int(at.x) : arrivedBefore(at.x),
              right = here ? int(at.x) : arrivedAfter(at.x, warp.size_px.x);
    if (left < 0 && right < 0) {
        const vec2 place_px = movePixel(warp.source_from_target, vec2(at) + 0.5, 0).xy;
        const uvec2 source = pixelAt(warp.size_px, place_px);
        return Copied(sourceAt(source.y * warp.size_px.x + source.x), kHole, 0);
    }
    const uint first = uint(left >= 0 ? left : right), last = uint(right >= 0 ? right : left);
    const float share = first == last ? 0 : float(at.x - first) / float(last - first);
    const bool inside = left >= 0 && right >= 0 && last - first - 1 <= warp.gap_px;
    return Copied(
        mix(arrivedColour(warp, row, uvec2(first, at.y)), arrivedColour(warp, row, uvec2(last, at.y)), share),
        here     ? kCovered
        : inside ? kGap
                 : kHole,
        mix(inverseDepthOf(arrivalAt(row, first)), inverseDepthOf(arrivalAt(row, last)), share));
}
