// For sums_test: a workgroup brings 1024 values to where they are summed up, and the last one does that.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "types.h"
#include "lib/group.glsl"
#include "lib/last_group.glsl"
#include "lib/list.glsl"
#include "lib/sums.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    Uints values;
    CoherentUints sums;
    ListStates result;
    uint count;
    uint capacity;
} pass;

void main() {
    const uint begin = groupIndex() * 1024;
    for (uint i = begin + gl_LocalInvocationIndex; i < min(begin + 1024, pass.count); i += kGroupSize) { pass.sums.at[i] = pass.values.at[i]; }
    if (isLastGroup(pass.result)) { sumUp(pass.sums, pass.count, pass.result, pass.capacity); }
}
