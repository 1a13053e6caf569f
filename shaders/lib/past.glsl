// What making a picture from a past one takes, block by block or pixel by pixel. For shaders that say what kind of pictures: kHalfColours, kDepth,
// kHiddenTiles; after their push constants, lib/tile_mask.glsl, lib/picture.glsl, lib/moving_pixel.glsl and lib/move_pixel.glsl.

const uvec2 kBlock = uvec2(kPastColumns, kPastRows);

bool isInPast(PastView view, vec2 place_px) { return all(greaterThanEqual(place_px, vec2(0))) && all(lessThan(place_px, vec2(view.past_size_px))); }

// What the past shows at a place.
struct Seen {
    uint word;  // lib/moving_pixel.glsl
    float inverse_depth;  // as the picture that is made sees it
    vec2 off_px;          // where that pixel's middle comes to lie, less where `wanted_px` is
};

// The lens hides the same parts of a picture at any size. By a pixel's middle: a GPU's division is not exact, not even of equal numbers.
bool isHiddenInPast(PastView view, uvec2 at) {
    if (!kHiddenTiles) { return false; }
    return !isInMask(pass.shown_mask, view.size_tiles, uvec2((vec2(at) + 0.5) * (vec2(view.size_px) / vec2(view.past_size_px))) / kTileSize);
}

uint wordAt(PastView view, vec2 place_px) {
    const uvec2 at = uvec2(clamp(place_px, vec2(0), vec2(view.past_size_px) - 1));
    return isHiddenInPast(view, at) ? 0 : pass.source_words.at[at.y * view.past_size_px.x + at.x];
}

Seen look(PastView view, vec2 place_px, vec2 wanted_px) {
    const uint word = wordAt(view, place_px);
    const vec2 middle_px = floor(place_px) + 0.5;
    const float inverse_depth = word == 0 ? 0 : inverseDepthOf(word);
    const vec3 moves = moveOfPixel(view.now_from_past, middle_px, inverse_depth);
    return Seen(moves.z > 0 ? word : 0, inverse_depth / max(moves.z, 1e-6), (middle_px - wanted_px) + moves.xy);
}

// How far a place in the past moves for a unit of inverse depth.
vec2 disparity(PastView view, vec2 pixel_px) { return view.past_from_now.shift.xy - pixel_px * view.past_from_now.shift.z; }

// The amplitude of what an uncertain depth costs. `across` and `down`: how the picture changes from pixel to pixel.
vec2 uncertainMove(vec2 disparity_px, float spread) {
    const vec2 move_px = disparity_px * spread;
    const float length_px = length(move_px);
    return length_px > kMaxSpread ? move_px * (kMaxSpread / length_px) : move_px;
}

bool isHidden(PastView view, uvec2 pixel) {
    return kHiddenTiles && !isInMask(pass.shown_mask, view.size_tiles, pixel / kTileSize);
}

vec4 sourceAt(uint i) { return colourAt(pass.source, HalfColours(uvec2(pass.source)), i); }

// Of pixels inside the picture. A pixel's colour comes once its word is there.
void putWord(PastView view, uvec2 pixel, uint word) {
    pass.target_words.at[pixel.y * view.size_px.x + pixel.x] = isHidden(view, pixel) ? 0 : word;
}
void putPixel(PastView view, uvec2 pixel, vec4 colour) {
    const uint at = pixel.y * view.size_px.x + pixel.x;
    const vec4 shown = isHidden(view, pixel) ? vec4(pass.background, 0) : colour;
    putColour(pass.target, HalfColours(uvec2(pass.target)), at, shown);
    if (kDepth) {
        const uint word = pass.target_words.at[at];
        const float inverse_depth = word == 0 ? 0 : inverseDepthOf(word);
        pass.depths.at[at] = inverse_depth > 0 ? shown.a / inverse_depth : 0;
    }
}
