#ifndef BINOSPLAT_SHADERS_LIB_ADDRESS_GLSL
#define BINOSPLAT_SHADERS_LIB_ADDRESS_GLSL

// True if an address is not null.
bool isThere(uvec2 address) { return any(notEqual(address, uvec2(0))); }

#endif
