// Sums up what each workgroup counted, in the last of them. For workgroups of kGroupSize; after lib/group.glsl and lib/list.glsl.

const uint kSumsPerThread = 8;

// Replaces `count` values by the sums of those before them, and writes `result`: a list as long as their total, empty if that is more
// than `capacity`, needing 0xffffffff if that is more than kMaxItems. By all threads of one workgroup.
void sumUp(CoherentUints sums, uint count, ListStates result, uint capacity) {
    const uint thread = threadIndex();
    uint before_step = 0;
    // The total may not fit into 32 bits: each thread's part of it has 33, the highest for "that much or more".
    uint own = 0, own_carry = 0, step_begin = 0;
    [[dont_unroll]] do {
        const uint first = step_begin + thread * kSumsPerThread;
        uint values[kSumsPerThread];
        [[unroll]] for (uint i = 0; i < kSumsPerThread; ++i) { values[i] = first + i < count ? sums.at[first + i] : 0; }
        uint in_step = 0;
        [[unroll]] for (uint i = 0; i < kSumsPerThread; ++i) {
            uint carry;
            own = uaddCarry(own, values[i], carry);
            own_carry |= carry;
            in_step += values[i];
        }
        uint of_step;
        uint before = before_step + scanGroup(in_step, of_step);
        [[unroll]] for (uint i = 0; i < kSumsPerThread; ++i) {
            if (first + i < count) { sums.at[first + i] = before; }
            before += values[i];
        }
        before_step += of_step;
        step_begin += kGroupSize * kSumsPerThread;
    } while (step_begin < count);
    // By halves the sum over the threads fits. That of the lower ones follows, since it is known modulo 2^32.
    uint upper_halves;
    scanGroup((own >> 16) + (own_carry << 16), upper_halves);
    const uint lower_halves = before_step - (upper_halves << 16);
    if (gl_LocalInvocationIndex == 0) {
        const bool fits = upper_halves + (lower_halves >> 16) < 0x10000u && before_step <= kMaxItems;
        result.at[0] = makeList(fits ? before_step : 0xffffffffu, capacity);
    }
}
