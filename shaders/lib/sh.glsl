// Colour of a splat from spherical harmonics, bands 0 to kShDegree (real SH with the signs of 3DGS, Kerbl et
// al. 2023). Needs lib/splat.glsl.

layout(constant_id = 0) const uint kShDegree = 0;
// Half floats of bands 1 to kShDegree, and the words they take.
const uint kShHalves = 3 * ((kShDegree + 1) * (kShDegree + 1) - 1);
const uint kShWords = (kShHalves + 1) / 2;

// Coefficient k >= 1: halves 3 (k - 1) and the two after it.
vec3 shCoefficient(Uints sh, uint first_word, uint k) {
    const uint half_index = 3 * (k - 1);
    const uint word = first_word + half_index / 2;
    const vec2 low = unpackHalf2x16(sh.at[word]);
    if ((half_index & 1) == 0) { return vec3(low, unpackHalf2x16(sh.at[word + 1]).x); }
    return vec3(low.y, unpackHalf2x16(sh.at[word + 1]));
}

// max(0, 0.5 + SH(d)) for a unit direction from the eye to the splat. Some placed scenes may have fewer bands
// than others.
vec3 shColour(SceneChunks chunks, SplatPlace at, vec3 direction) {
    const vec3 d = directionInScene(chunks, at.chunk, direction);
    const uint bands = kPlaced ? chunks.at[at.chunk].sh_degree : kShDegree;
    const uvec2 base = chunks.at[at.chunk].base_colours.at[at.in_chunk];
    vec3 colour = 0.5 + 0.28209479177387814 * vec3(unpackHalf2x16(base.x), unpackHalf2x16(base.y).x);
    Uints sh = Uints(chunks.at[at.chunk].sh);
    const uint word = at.in_chunk * (kPlaced ? (3 * ((bands + 1) * (bands + 1) - 1) + 1) / 2 : kShWords);
    if (kShDegree >= 1 && bands >= 1) {
        colour += 0.4886025119029199 * (d.z * shCoefficient(sh, word, 2) - d.y * shCoefficient(sh, word, 1) -
                                        d.x * shCoefficient(sh, word, 3));
    }
    const vec3 dd = d * d;
    if (kShDegree >= 2 && bands >= 2) {
        colour += 1.0925484305920792 *
                      (d.x * d.y * shCoefficient(sh, word, 4) - d.y * d.z * shCoefficient(sh, word, 5) -
                       d.x * d.z * shCoefficient(sh, word, 7)) +
                  0.31539156525252005 * (2 * dd.z - dd.x - dd.y) * shCoefficient(sh, word, 6) +
                  0.5462742152960396 * (dd.x - dd.y) * shCoefficient(sh, word, 8);
    }
    if (kShDegree >= 3 && bands >= 3) {
        colour += -0.5900435899266435 * d.y * (3 * dd.x - dd.y) * shCoefficient(sh, word, 9) +
                  2.890611442640554 * d.x * d.y * d.z * shCoefficient(sh, word, 10) -
                  0.4570457994644658 * d.y * (4 * dd.z - dd.x - dd.y) * shCoefficient(sh, word, 11) +
                  0.3731763325901154 * d.z * (2 * dd.z - 3 * dd.x - 3 * dd.y) * shCoefficient(sh, word, 12) -
                  0.4570457994644658 * d.x * (4 * dd.z - dd.x - dd.y) * shCoefficient(sh, word, 13) +
                  1.445305721320277 * d.z * (dd.x - dd.y) * shCoefficient(sh, word, 14) -
                  0.5900435899266435 * d.x * (dd.x - 3 * dd.y) * shCoefficient(sh, word, 15);
    }
    return max(colour, vec3(0));
}
