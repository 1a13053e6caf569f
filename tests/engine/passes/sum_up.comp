// For sort_test: each workgroup adds a value to the sum.
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
    const uint group = groupIndex();
    if (group < pass.count && gl_LocalInvocationIndex == 0) { pass.sums.at[group] = pass.values.at[group]; }
    sumUp(pass.sums, group, pass.count, pass.result, pass.capacity);
}
