// Radix sort, second step of a round: every pair goes to its place. The sort is stable: a subgroup takes a
// contiguous run of a block's keys, counts its digits, and then walks through the run again, a subgroup's
// width at a time, ranking equal digits by comparing them across the lanes (Adinets and Merrill 2022, section
// 4.3, without the chained scan). Keys are read twice, so that a thread holds only one at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "passes.h"
#include "lib/address.glsl"
#include "lib/group.glsl"
#include "lib/list.glsl"

layout(constant_id = 0) const uint kThreads = 128;
layout(constant_id = 1) const uint kMaxSubgroups = 8;
// Not 0: the subgroup width, if comparisons are cheaper than ballots.
layout(constant_id = 2) const uint kComparedLanes = 0;
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push { SortScatterPass pass; };

// Counts, then where the next key of a subgroup's digit goes.
shared uint subgroup_digits[kMaxSubgroups * kMaxDigits];

uint digitOf(uint key) { return (key >> pass.shift) & (pass.digits - 1); }

// The lane's bit if its digit equals this lane's. A macro, since the lane must be a constant.
#define SAME_DIGIT(lane) (subgroupBroadcast(digit, lane) == digit ? 1u << (lane) : 0)

// The lanes among `valid` whose digit equals this lane's.
uvec4 matchDigit(uint digit, uvec4 valid) {
    if (kComparedLanes > 0) {
        uint peers = SAME_DIGIT(0) | SAME_DIGIT(1) | SAME_DIGIT(2) | SAME_DIGIT(3);
        if (kComparedLanes > 4) { peers |= SAME_DIGIT(4) | SAME_DIGIT(5) | SAME_DIGIT(6) | SAME_DIGIT(7); }
        return uvec4(peers & valid.x, 0, 0, 0);
    }
    uvec4 peers = valid;
    [[unroll]] for (uint bit = 0; bit < kMaxDigitBits; ++bit) {
        const bool set = (digit & (1u << bit)) != 0;
        const uvec4 lanes = subgroupBallot(set);
        peers &= set ? lanes : ~lanes;
    }
    return peers;
}

// Word by word: not every compiler knows subgroupBallotFindLSB for 64 lanes.
uint firstLane(uvec4 lanes) {
    if (lanes.x != 0) { return uint(findLSB(lanes.x)); }
    if (lanes.y != 0) { return 32 + uint(findLSB(lanes.y)); }
    return lanes.z != 0 ? 64 + uint(findLSB(lanes.z)) : 96 + uint(findLSB(lanes.w));
}

// Turns counts into places: where each digit begins overall and in this block, and where each subgroup's
// share of it does.
void placeDigits(uint block) {
    uint digit = gl_LocalInvocationIndex;
    if (digit >= pass.digits) { return; }
    [[dont_unroll]] do {
        uint place = pass.digit_begins.at[digit] + pass.run_sums.at[block / kSortRun * pass.digits + digit] +
                     pass.histograms.at[block * pass.digits + digit];
        uint s = 0;
        [[dont_unroll]] do {
            const uint in_run = subgroup_digits[s * pass.digits + digit];
            subgroup_digits[s * pass.digits + digit] = place;
            place += in_run;
            ++s;
        }
        while (s < gl_NumSubgroups)
            ;
        digit += kThreads;
    }
    while (digit < pass.digits)
        ;
}

void main() [[subgroup_uniform_control_flow]] {
    const uint count = pass.list.at[0].count;
    const uint block = gl_WorkGroupID.x;
    for (uint i = gl_LocalInvocationIndex; i < gl_NumSubgroups * pass.digits; i += kThreads) {
        subgroup_digits[i] = 0;
    }
    barrier();

    const bool has_values = isThere(uvec2(pass.values_in));
    const uint lanes = laneCount();
    const uint own_digits = gl_SubgroupID * pass.digits;
    const uint block_keys = sortBlockKeys(count), run_keys = block_keys / gl_NumSubgroups;
    const uint block_begin = min(block * block_keys, count);
    const uint run_begin = block_begin + min(gl_SubgroupID * run_keys, count - block_begin),
               run_end = run_begin + min(run_keys, count - run_begin);
    uint counted = run_begin + gl_SubgroupInvocationID;
    if (counted < run_end) {
        [[dont_unroll]] do {
            atomicAdd(subgroup_digits[own_digits + digitOf(pass.keys_in.at[counted])], 1);
            counted += lanes;
        }
        while (counted < run_end)
            ;
    }
    barrier();
    placeDigits(block);
    barrier();

    // Every subgroup takes the same number of steps, although the runs of a list's last block may be shorter:
    // a device may make whole workgroups wait at a subgroup's barrier, as Mesa 25's software device does. The
    // first run is the longest.
    const uint steps_end = min(run_keys, count - block_begin);
    uint step_begin = 0;
    [[dont_unroll]] do {
        const uint item = run_begin + step_begin + gl_SubgroupInvocationID;
        const bool valid = item < run_end;
        const uint key = valid ? pass.keys_in.at[item] : 0;
        const uint value = valid && has_values ? pass.values_in.at[item] : 0;
        const uint digit = digitOf(key);
        const uvec4 peers = matchDigit(digit, subgroupBallot(valid));
        const uint before = subgroupBallotExclusiveBitCount(peers);
        // The first of several equal digits takes places for all of them and tells the others where they are.
        uint place = 0;
        if (valid && before == 0) {
            place = atomicAdd(subgroup_digits[own_digits + digit], subgroupBallotBitCount(peers));
        }
        place = subgroupShuffle(place, firstLane(peers) & (lanes - 1)) + before;
        if (valid) {
            pass.keys_out.at[place] = key;
            if (has_values) { pass.values_out.at[place] = value; }
        }
        subgroupBarrier();  // in the next step another lane is the first of a digit
        step_begin += lanes;
    }
    while (step_begin < steps_end)
        ;
}
