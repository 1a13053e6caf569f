// Radix sort, third step of a round: every pair goes to its place. Stable: within a block a subgroup ranks a contiguous run of
// keys, a subgroup's width at a time, by comparing digits with ballots (Adinets and Merrill 2022, section 4.3, without the
// chained scan).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/group.glsl"

layout(constant_id = 0) const uint kThreads = 128;
layout(constant_id = 1) const uint kMaxSubgroups = 16;
layout(constant_id = 2) const bool kNarrowSubgroups = false;  // all have at most 8 invocations
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { SortScatterPass pass; };

const uint kKeysPerThread = kSortBlock / kThreads;

shared uint subgroup_digits[kMaxSubgroups * kMaxDigits];  // counts, then where a subgroup's run of a digit begins

// The lanes of this subgroup whose digit equals this lane's.
uvec4 matchDigit(uint digit) {
    if (kNarrowSubgroups) {  // a comparison a lane is then cheaper than a ballot a bit
        uint peers = 0;
        [[unroll]] for (uint lane = 0; lane < 8; ++lane) {
            if (subgroupBroadcast(digit, lane) == digit) { peers |= 1u << lane; }
        }
        return uvec4(peers, 0, 0, 0);
    }
    uvec4 peers = subgroupBallot(true);
    for (uint bit = 1; bit < pass.digits; bit <<= 1) {
        const bool set = (digit & bit) != 0;
        const uvec4 lanes = subgroupBallot(set);
        peers &= set ? lanes : ~lanes;
    }
    return peers;
}

void main() {
    const uint count = pass.list.at[0].count;
    const uint blocks = (count + kSortBlock - 1) / kSortBlock;
    const uint block = groupIndex();
    for (uint i = gl_LocalInvocationIndex; i < gl_NumSubgroups * pass.digits; i += kThreads) { subgroup_digits[i] = 0; }
    barrier();

    // Rank: how many keys of the subgroup's run have the same digit and come before.
    const uint lanes = laneCount();
    const uint run_begin = block * kSortBlock + gl_SubgroupID * lanes * kKeysPerThread + gl_SubgroupInvocationID;
    uint keys[kKeysPerThread];
    uint ranks[kKeysPerThread];
    for (uint i = 0; i < kKeysPerThread; ++i) {
        const uint item = run_begin + i * lanes;
        // Past the end stand keys of the last digit; they come after all others and are not written.
        keys[i] = item < count ? pass.keys_in.at[item] : 0xffffffffu;
        const uint digit = (keys[i] >> pass.shift) & (pass.digits - 1);
        const uvec4 peers = matchDigit(digit);
        const uint before = subgroupBallotExclusiveBitCount(peers);
        uint run_before = 0;
        if (before == 0) { run_before = atomicAdd(subgroup_digits[gl_SubgroupID * pass.digits + digit], subgroupBallotBitCount(peers)); }
        subgroupMemoryBarrierShared();
        ranks[i] = before + subgroupShuffle(run_before, subgroupBallotFindLSB(peers));
    }
    barrier();

    // Where each digit begins, in all and in this block, and each subgroup's share of it.
    const uint digits_per_thread = (pass.digits + kThreads - 1) / kThreads;
    const uint first_digit = min(threadIndex() * digits_per_thread, pass.digits);
    const uint end_digit = min(first_digit + digits_per_thread, pass.digits);
    uint own = 0;
    for (uint digit = first_digit; digit < end_digit; ++digit) { own += pass.totals.at[digit]; }
    uint total;
    uint before = scanGroup(own, total);
    for (uint digit = first_digit; digit < end_digit; ++digit) {
        uint place = before + (block < blocks ? pass.histograms.at[digit * blocks + block] : 0);
        before += pass.totals.at[digit];
        for (uint s = 0; s < gl_NumSubgroups; ++s) {
            const uint in_run = subgroup_digits[s * pass.digits + digit];
            subgroup_digits[s * pass.digits + digit] = place;
            place += in_run;
        }
    }
    barrier();

    for (uint i = 0; i < kKeysPerThread; ++i) {
        const uint item = run_begin + i * lanes;
        if (item < count) {
            const uint digit = (keys[i] >> pass.shift) & (pass.digits - 1);
            const uint place = subgroup_digits[gl_SubgroupID * pass.digits + digit] + ranks[i];
            pass.keys_out.at[place] = keys[i];
            pass.values_out.at[place] = pass.values_in.at[item];
        }
    }
}
