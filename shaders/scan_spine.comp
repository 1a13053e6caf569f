// Prefix sums, second step: one workgroup sums the blocks' sums and states the list that is as long as their total.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes.h"
#include "lib/group.glsl"
#include "lib/list.glsl"

layout(local_size_x = kGroupSize) in;
layout(push_constant, scalar) uniform Push { ScanSpinePass pass; };
layout(constant_id = 0) const bool kOverList = true;  // false: pass.block_count says how many blocks there are

const uint kPerThread = 8;
const uint kTooManyKilos = 1u << 22;  // 2^32 / 1024

void main() {
    const uint blocks = kOverList ? (pass.list.at[0].count + kScanBlock - 1) / kScanBlock : pass.block_count;
    const uint thread = threadIndex();
    uint before_step = 0;
    // The sum may not fit into 32 bits. A second sum, of 1/1024 of each value rounded up, tells: it errs by at most 1024 a block.
    uint kilos = 0;
    for (uint step_begin = 0; step_begin < blocks; step_begin += kGroupSize * kPerThread) {
        const uint first = step_begin + thread * kPerThread;
        uint values[kPerThread];
        uint sum = 0;
        for (uint i = 0; i < kPerThread; ++i) {
            values[i] = first + i < blocks ? pass.block_sums.at[first + i] : 0;
            sum += values[i];
            kilos = min(kilos + (values[i] >> 10) + (values[i] > 0 ? 1 : 0), kTooManyKilos);
        }
        uint total;
        uint before = before_step + scanGroup(sum, total);
        for (uint i = 0; i < kPerThread; ++i) {
            if (first + i < blocks) { pass.block_sums.at[first + i] = before; }
            before += values[i];
        }
        before_step += total;
    }
    uint all_kilos;
    scanGroup(kilos, all_kilos);
    if (gl_LocalInvocationIndex == 0) {
        const bool overflow = all_kilos >= kTooManyKilos;
        pass.result.at[0] = makeList(overflow ? 0xffffffffu : before_step, pass.capacity);
    }
}
