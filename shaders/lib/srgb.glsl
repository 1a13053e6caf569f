// Conversions between light and display-encoded values, from 0 up (IEC 61966-2-1).

vec3 decode(vec3 encoded) {
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92,
               lessThanEqual(encoded, vec3(0.04045)));
}

vec3 encode(vec3 light) {
    return mix(1.055 * pow(light, vec3(1 / 2.4)) - 0.055, 12.92 * light,
               lessThanEqual(light, vec3(0.0031308)));
}
