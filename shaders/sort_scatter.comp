// Radix sort, third step of a round: every pair goes to its place. Stable: within a block a subgroup ranks a contiguous run of
// keys, a subgroup's width at a time, by comparing digits with ballots (Adinets and Merrill 2022, section 4.3, without the
// chained scan).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "passes.h"
#include "lib/group.glsl"

layout(local_size_x = kSortGroupSize) in;
layout(push_constant, scalar) uniform Push { SortScatterPass pass; };
layout(constant_id = 0) const uint kMaxSubgroups = 16;

shared uint subgroup_digits[kMaxSubgroups * kDigits];  // counts, then where a subgroup's run of a digit begins

// The lanes of this subgroup whose digit equals this lane's.
uvec4 matchDigit(uint digit) {
    uvec4 peers = subgroupBallot(true);
    for (uint bit = 0; bit < 8; ++bit) {
        const bool set = ((digit >> bit) & 1) != 0;
        const uvec4 lanes = subgroupBallot(set);
        peers &= set ? lanes : ~lanes;
    }
    return peers;
}

void main() {
    const uint count = pass.list.at[0].count;
    const uint blocks = (count + kSortBlock - 1) / kSortBlock;
    const uint block = groupIndex();
    for (uint i = gl_LocalInvocationIndex; i < gl_NumSubgroups * kDigits; i += kSortGroupSize) { subgroup_digits[i] = 0; }
    barrier();

    // Rank: how many keys of the subgroup's run have the same digit and come before.
    const uint run_begin = block * kSortBlock + gl_SubgroupID * gl_SubgroupSize * kSortKeysPerThread + gl_SubgroupInvocationID;
    uint keys[kSortKeysPerThread];
    uint ranks[kSortKeysPerThread];
    for (uint i = 0; i < kSortKeysPerThread; ++i) {
        const uint item = run_begin + i * gl_SubgroupSize;
        // Past the end stand keys of the last digit; they come after all others and are not written.
        keys[i] = item < count ? pass.keys_in.at[item] : 0xffffffffu;
        const uint digit = (keys[i] >> pass.shift) & (kDigits - 1);
        const uvec4 peers = matchDigit(digit);
        const uint before = subgroupBallotExclusiveBitCount(peers);
        uint run_before = 0;
        if (before == 0) { run_before = atomicAdd(subgroup_digits[gl_SubgroupID * kDigits + digit], subgroupBallotBitCount(peers)); }
        subgroupMemoryBarrierShared();
        ranks[i] = before + subgroupShuffle(run_before, subgroupBallotFindLSB(peers));
    }
    barrier();

    // Where each digit begins, in all and in this block, and each subgroup's share of it.
    uint digits_before = 0;
    for (uint first = 0; first < kDigits; first += kSortGroupSize) {
        const uint digit = first + gl_LocalInvocationIndex;
        uint total;
        const uint before = digits_before + scanGroup(pass.totals.at[digit], total);
        digits_before += total;
        uint place = before + (block < blocks ? pass.histograms.at[digit * blocks + block] : 0);
        for (uint s = 0; s < gl_NumSubgroups; ++s) {
            const uint own = subgroup_digits[s * kDigits + digit];
            subgroup_digits[s * kDigits + digit] = place;
            place += own;
        }
    }
    barrier();

    for (uint i = 0; i < kSortKeysPerThread; ++i) {
        const uint item = run_begin + i * gl_SubgroupSize;
        if (item < count) {
            const uint digit = (keys[i] >> pass.shift) & (kDigits - 1);
            const uint place = subgroup_digits[gl_SubgroupID * kDigits + digit] + ranks[i];
            pass.keys_out.at[place] = keys[i];
            pass.values_out.at[place] = pass.values_in.at[item];
        }
    }
}
