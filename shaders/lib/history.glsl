// For shaders that make a picture from an earlier one, block by block or pixel by pixel, and define what kind
// of pictures these are: kHalfColours, kHiddenTiles, kByAddress; after their push constants,
// lib/tile_mask.glsl, lib/picture.glsl, lib/moving_pixel.glsl and lib/move_pixel.glsl.

const uvec2 kBlock = uvec2(kHistoryColumns, kHistoryRows);

bool isInHistory(HistoryView view, vec2 place_px) {
    return all(greaterThanEqual(place_px, vec2(0))) && all(lessThan(place_px, vec2(view.history_size_px)));
}

// With kByAddress, eight bytes are one access and sixteen bytes two, as if they were addresses: llvmpipe goes
// from lane to lane once per number of a vector, however wide it is. A 64-bit integer would do as well, but
// not every device has these. glslang gives an address the alignment of what it points to. Not for GPUs,
// whose compilers may take an address for a multiple of that alignment, which pixels are not.
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Eights { HalfColours at[]; };
struct Sixteen {
    FloatColours low;
    HalfColours high;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Sixteens { Sixteen at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer UVec4s { uvec4 at[]; };

void putSixteen(uvec2 address, uint i, uvec4 words) {
    if (kByAddress) {
        Sixteens(address).at[i].low = FloatColours(words.xy);
        Sixteens(address).at[i].high = HalfColours(words.zw);
    } else {
        UVec4s(address).at[i] = words;
    }
}

// What the history shows at a place.
struct Seen {
    uint word;            // lib/moving_pixel.glsl
    float inverse_depth;  // as seen in the picture that is being made
    vec2 off_px;          // where that pixel's middle lands, relative to `wanted_px`
};

bool isHiddenInHistory(HistoryView view, uvec2 at) {
    return kHiddenTiles && isThere(uvec2(pass.history_shown)) &&
           !isInMask(pass.history_shown, view.history_size_tiles, at / kTileSize);
}
// True if taps around the pixels of a box, less than a tile wide, include hidden ones, whose background would
// leak in.
bool reachesHidden(HistoryView view, ivec2 first, ivec2 last) {
    if (!kHiddenTiles) { return false; }
    const ivec2 end = ivec2(view.history_size_px) - 1;
    const uvec2 low = uvec2(clamp(first - kHistoryReach, ivec2(0), end)),
                high = uvec2(clamp(last + kHistoryReach, ivec2(0), end));
    return isHiddenInHistory(view, low) || isHiddenInHistory(view, high) ||
           isHiddenInHistory(view, uvec2(low.x, high.y)) || isHiddenInHistory(view, uvec2(high.x, low.y));
}

uint wordAt(HistoryView view, vec2 place_px) {
    const uvec2 at = pixelAt(view.history_size_px, place_px);
    return isHiddenInHistory(view, at) ? 0 : pass.source_words.at[at.y * view.history_size_px.x + at.x];
}

Seen look(HistoryView view, vec2 place_px, vec2 wanted_px) {
    const uint word = wordAt(view, place_px);
    const vec2 middle_px = floor(place_px) + 0.5;
    const float inverse_depth = word == 0 ? 0 : inverseDepthOf(word);
    const vec3 moves = moveOfPixel(view.now_from_history, middle_px, inverse_depth);
    return Seen(moves.z > 0 ? word : 0, inverse_depth / max(moves.z, 1e-6),
                (middle_px - wanted_px) + moves.xy);
}

// How far a place in the history moves per unit of inverse depth.
vec2 disparity(HistoryView view, vec2 pixel_px) {
    return view.history_from_now.shift.xy - pixel_px * view.history_from_now.shift.z;
}

// How far the place may be off because of its depth's spread; at most kMaxSpread.
vec2 uncertainMove(vec2 disparity_px, float spread) {
    const vec2 move_px = disparity_px * spread;
    const float length_px = length(move_px);
    return length_px > kMaxSpread ? move_px * (kMaxSpread / length_px) : move_px;
}

bool isHidden(HistoryView view, uvec2 pixel) {
    return kHiddenTiles && isThere(uvec2(pass.shown_mask)) &&
           !isInMask(pass.shown_mask, view.size_tiles, pixel / kTileSize);
}

vec4 sourceAt(uint i) {
    if (kHalfColours) {
        return unpackHalves(kByAddress ? uvec2(Eights(uvec2(pass.source)).at[i])
                                       : HalfColours(uvec2(pass.source)).at[i]);
    }
    if (!kByAddress) { return pass.source.at[i]; }
    Sixteens pixels = Sixteens(uvec2(pass.source));
    return uintBitsToFloat(uvec4(uvec2(pixels.at[i].low), uvec2(pixels.at[i].high)));
}

// For pixels inside the picture.
void putWord(HistoryView view, uvec2 pixel, uint word) {
    pass.target_words.at[pixel.y * view.size_px.x + pixel.x] = isHidden(view, pixel) ? 0 : word;
}
void putPixel(HistoryView view, uvec2 pixel, vec4 colour) {
    const uint at = pixel.y * view.size_px.x + pixel.x;
    const vec4 shown = isHidden(view, pixel) ? vec4(view.background, 0) : colour;
    if (kHalfColours && kByAddress) {
        Eights(uvec2(pass.target)).at[at] = HalfColours(packHalves(shown));
    } else if (kHalfColours) {
        HalfColours(uvec2(pass.target)).at[at] = packHalves(shown);
    } else {
        putSixteen(uvec2(pass.target), at, floatBitsToUint(shown));
    }
}
