// Workgroups: which one this is, and prefix sums across one. No subgroup width is assumed.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Dispatches of many groups are folded into rows.
uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

shared uint subgroup_sums[kGroupSize];

// The sum of `value` over the threads before this one; `total` is the sum over all. Every thread must call it.
uint scanGroup(uint value, out uint total) {
    const uint before_in_subgroup = subgroupExclusiveAdd(value);
    barrier();  // an earlier call may still be reading
    if (gl_SubgroupInvocationID == gl_SubgroupSize - 1) { subgroup_sums[gl_SubgroupID] = before_in_subgroup + value; }
    barrier();
    uint before = before_in_subgroup;
    total = 0;
    for (uint s = 0; s < gl_NumSubgroups; ++s) {
        const uint sum = subgroup_sums[s];
        if (s < gl_SubgroupID) { before += sum; }
        total += sum;
    }
    return before;
}
