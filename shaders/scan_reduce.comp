// Prefix sums, first step: the sum of each block of kScanBlock values.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ScanReducePass pass; };

void main() {
    const uint count = pass.list.at[0].count;
    const uint block = groupIndex();
    uint sum = 0;
    for (uint i = gl_LocalInvocationIndex; i < kScanBlock; i += kGroupSize) {
        const uint item = block * kScanBlock + i;
        if (item < count) { sum += pass.values.at[item]; }
    }
    uint total;
    scanGroup(sum, total);
    if (gl_LocalInvocationIndex == 0 && block * kScanBlock < count) { pass.block_sums.at[block] = total; }
}
