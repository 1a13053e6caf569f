// Workgroups: which one this is, and prefix sums across one. No subgroup width is assumed.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Dispatches of many groups are folded into rows.
uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

shared uint subgroup_sums[kGroupSize + 1];

// The sum of `value` over the threads before this one; `total` is the sum over all. Every thread must call it.
uint scanGroup(uint value, out uint total) {
    const uint before_in_subgroup = subgroupExclusiveAdd(value);
    barrier();  // an earlier call may still be reading
    if (gl_SubgroupInvocationID == gl_SubgroupSize - 1) { subgroup_sums[gl_SubgroupID] = before_in_subgroup + value; }
    barrier();
    // The first subgroup sums the subgroups' sums, as many at a time as it is wide.
    if (gl_SubgroupID == 0) {
        uint carry = 0;
        for (uint first = 0; first < gl_NumSubgroups; first += gl_SubgroupSize) {
            const uint s = first + gl_SubgroupInvocationID;
            const uint sum = s < gl_NumSubgroups ? subgroup_sums[s] : 0;
            const uint before = subgroupExclusiveAdd(sum);
            if (s < gl_NumSubgroups) { subgroup_sums[s] = carry + before; }
            carry += subgroupAdd(sum);
        }
        if (gl_SubgroupInvocationID == 0) { subgroup_sums[kGroupSize] = carry; }
    }
    barrier();
    total = subgroup_sums[kGroupSize];
    return subgroup_sums[gl_SubgroupID] + before_in_subgroup;
}

// The greatest `value` of the threads up to and with this one; `greatest` is that of all. Every thread must call it.
uint scanGroupMax(uint value, out uint greatest) {
    const uint in_subgroup = subgroupInclusiveMax(value);
    barrier();
    if (gl_SubgroupInvocationID == gl_SubgroupSize - 1) { subgroup_sums[gl_SubgroupID] = in_subgroup; }
    barrier();
    if (gl_SubgroupID == 0) {
        uint carry = 0;
        for (uint first = 0; first < gl_NumSubgroups; first += gl_SubgroupSize) {
            const uint s = first + gl_SubgroupInvocationID;
            const uint own = s < gl_NumSubgroups ? subgroup_sums[s] : 0;
            const uint before = subgroupExclusiveMax(own);
            if (s < gl_NumSubgroups) { subgroup_sums[s] = max(carry, before); }
            carry = max(carry, subgroupMax(own));
        }
        if (gl_SubgroupInvocationID == 0) { subgroup_sums[kGroupSize] = carry; }
    }
    barrier();
    greatest = subgroup_sums[kGroupSize];
    return max(subgroup_sums[gl_SubgroupID], in_subgroup);
}
