// Numbers of 48 bits as unevaluated sums x + y of two floats, |y| at most half a unit in the last place of x
// (Dekker 1971, Knuth 4.2.2). For the few steps where float32's 24 bits would show: the centre of a splat on
// the screen is a difference of large numbers. No fused multiply-add is assumed, since Vulkan does not
// promise one.

// a + b, exactly.
vec2 exactSum(float a, float b) {
    precise const float sum = a + b;
    precise const float b_part = sum - a;
    precise const float error = (a - (sum - b_part)) + (b - b_part);
    return vec2(sum, error);
}

// Two numbers |a| >= |b| as one.
vec2 normalized(float a, float b) {
    precise const float sum = a + b;
    precise const float error = b - (sum - a);
    return vec2(sum, error);
}

// a b, exactly: halves of twelve bits have products of twenty-four.
vec2 exactProduct(float a, float b) {
    const float a_high = uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u);
    const float b_high = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);
    precise const float a_low = a - a_high, b_low = b - b_high;
    precise const float product = a * b;
    precise const float error =
        ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return vec2(product, error);
}

vec2 addExact(vec2 a, vec2 b) {
    const vec2 sum = exactSum(a.x, b.x);
    precise const float low = sum.y + (a.y + b.y);
    return normalized(sum.x, low);
}

vec2 multiplyExact(vec2 a, vec2 b) {
    const vec2 product = exactProduct(a.x, b.x);
    precise const float low = product.y + (a.x * b.y + a.y * b.x);
    return normalized(product.x, low);
}

vec2 divideExact(vec2 a, vec2 b) {
    precise const float quotient = a.x / b.x;
    const vec2 product = exactProduct(quotient, b.x);
    precise const float rest = (((a.x - product.x) - product.y) + a.y) - quotient * b.y;
    precise const float low = rest / b.x;
    return normalized(quotient, low);
}

vec2 dotExact(vec3 a, vec3 a_low, vec2 x, vec2 y, vec2 z) {
    return addExact(addExact(multiplyExact(vec2(a.x, a_low.x), x), multiplyExact(vec2(a.y, a_low.y), y)),
                    multiplyExact(vec2(a.z, a_low.z), z));
}
