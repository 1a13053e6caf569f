// Workgroups: which workgroup and thread this is, and prefix sums across a workgroup. Assumes no subgroup
// width, but that no subgroup of a workgroup has idle lanes: kernels request that where a device allows it
// (Context::fullSubgroups).
//
// After a branch that only some lanes took, lanes must be together again before they exchange values. Vulkan
// promises this if the whole workgroup came to that branch and, with subgroup_uniform_control_flow, if the
// whole subgroup did.
//
// Here and elsewhere, hot loops test at their end whether to go on: a device that runs branches under a mask,
// like llvmpipe, runs the body of a `for` once more than there are items.
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_subgroup_uniform_control_flow : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

// Dispatches of many groups are folded into rows.
uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// Even numbers first, then the odd ones: pictures are often full below and empty above, and a device that
// hands out workgroups in runs then gets runs of similar work.
uint spread(uint i, uint count) {
    const uint even = (count + 1) / 2;
    return i < even ? 2 * i : 2 * (i - even) + 1;
}

// Lanes are counted, since gl_SubgroupSize may state more than a subgroup holds. In uniform control flow
// only.
uint laneCount() { return subgroupBallotBitCount(subgroupBallot(true)); }

// The thread's place in the order of summation of the scans below: by subgroup and lane, which the invocation
// index need not follow.
uint threadIndex() { return gl_SubgroupID * laneCount() + gl_SubgroupInvocationID; }

// One value for each subgroup, of at least four lanes, and one for all.
shared uint subgroup_sums[kGroupSize / 4 + 1];

// The sum of `value` over the threads before this one; `total` is the sum over all. Every thread must call
// it.
uint scanGroup(uint value, out uint total) {
    const uint before_in_subgroup = subgroupExclusiveAdd(value);
    const uint of_subgroup = subgroupAdd(value);
    const uint lanes = laneCount();
    barrier();  // an earlier call may still be reading
    if (subgroupElect()) { subgroup_sums[gl_SubgroupID] = of_subgroup; }
    barrier();
    // The first subgroup sums the subgroups' sums, as many at a time as it has lanes.
    if (gl_SubgroupID == 0) {
        uint carry = 0, first = 0;
        [[dont_unroll]] do {
            const uint s = first + gl_SubgroupInvocationID;
            const uint sum = s < gl_NumSubgroups ? subgroup_sums[s] : 0;
            const uint before = subgroupExclusiveAdd(sum), of_all = subgroupAdd(sum);
            if (s < gl_NumSubgroups) { subgroup_sums[s] = carry + before; }
            carry += of_all;
            first += lanes;
        }
        while (first < gl_NumSubgroups)
            ;
        if (subgroupElect()) { subgroup_sums[gl_NumSubgroups] = carry; }
    }
    barrier();
    total = subgroup_sums[gl_NumSubgroups];
    return subgroup_sums[gl_SubgroupID] + before_in_subgroup;
}

// The greatest `value` of the threads up to and including this one; `greatest` is that of all. Every thread
// must call it.
uint scanGroupMax(uint value, out uint greatest) {
    const uint in_subgroup = subgroupInclusiveMax(value);
    const uint of_subgroup = subgroupMax(value);
    const uint lanes = laneCount();
    barrier();
    if (subgroupElect()) { subgroup_sums[gl_SubgroupID] = of_subgroup; }
    barrier();
    if (gl_SubgroupID == 0) {
        uint carry = 0, first = 0;
        [[dont_unroll]] do {
            const uint s = first + gl_SubgroupInvocationID;
            const uint own = s < gl_NumSubgroups ? subgroup_sums[s] : 0;
            const uint before = subgroupExclusiveMax(own), of_all = subgroupMax(own);
            if (s < gl_NumSubgroups) { subgroup_sums[s] = max(carry, before); }
            carry = max(carry, of_all);
            first += lanes;
        }
        while (first < gl_NumSubgroups)
            ;
        if (subgroupElect()) { subgroup_sums[gl_NumSubgroups] = carry; }
    }
    barrier();
    greatest = subgroup_sums[gl_NumSubgroups];
    return max(subgroup_sums[gl_SubgroupID], in_subgroup);
}
