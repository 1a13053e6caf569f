// Prefix sums, third step: each block again, on top of what lies before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ScanApplyPass pass; };

const uint kPerThread = kScanBlock / kGroupSize;

void main() {
    const uint count = pass.list.at[0].count;
    const uint block = groupIndex();
    const uint first = block * kScanBlock + threadIndex() * kPerThread;
    uint values[kPerThread];
    uint sum = 0;
    for (uint i = 0; i < kPerThread; ++i) {
        values[i] = first + i < count ? pass.values.at[first + i] : 0;
        sum += values[i];
    }
    uint total;
    uint before = scanGroup(sum, total);
    if (block * kScanBlock < count) { before += pass.block_sums.at[block]; }
    for (uint i = 0; i < kPerThread; ++i) {
        if (first + i < count) { pass.values.at[first + i] = before; }
        before += values[i];
    }
}
