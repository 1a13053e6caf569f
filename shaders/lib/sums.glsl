// Sums what each workgroup counted. For workgroups of kGroupSize; after lib/group.glsl, lib/last_group.glsl
// and lib/list.glsl. The last workgroup does it. Many counts take two steps, by runs of counts
// (sumRunLength), each summed by the last workgroup of its run.

const uint kSumsPerThread = 8;

// Replaces the values from `step_begin` to `end` by the sums of those before them and returns the sum of all,
// or 0xffffffff if that exceeds kMaxItems. All threads of one workgroup must call it.
uint sumRange(CoherentUints sums, uint step_begin, uint end) {
    const uint thread = threadIndex();
    uint before_step = 0;
    // The total may not fit into 32 bits: each thread's part of it has 33, the highest one for "that much or
    // more".
    uint own = 0, own_carry = 0;
    [[dont_unroll]] do {
        const uint first = step_begin + thread * kSumsPerThread;
        uint values[kSumsPerThread];
        [[unroll]] for (uint i = 0; i < kSumsPerThread; ++i) {
            values[i] = first + i < end ? sums.at[first + i] : 0;
        }
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
            if (first + i < end) { sums.at[first + i] = before; }
            before += values[i];
        }
        before_step += of_step;
        step_begin += kGroupSize * kSumsPerThread;
    }
    while (step_begin < end)
        ;
    // Split into halves, the sum over the threads fits. The sum of the lower halves follows, since it is
    // known modulo 2^32.
    uint upper_halves;
    scanGroup((own >> 16) + (own_carry << 16), upper_halves);
    const uint lower_halves = before_step - (upper_halves << 16);
    const bool fits = upper_halves + (lower_halves >> 16) < 0x10000u && before_step <= kMaxItems;
    return fits ? before_step : 0xffffffffu;
}

// Makes `result` a list as long as the sum of the first `count` values, or an empty one if that exceeds
// `capacity`. All threads of one workgroup must call it.
void sumUpAtOnce(CoherentUints sums, uint count, ListStates result, uint capacity) {
    const uint total = sumRange(sums, 0, count);
    if (gl_LocalInvocationIndex == 0) { result.at[0] = makeList(total, capacity); }
}

// The same in as many steps as `count` requires. Every workgroup calls it once, when its count has been
// written; `group` is its place among `count`, or beyond if it has none. The sums in place of the counts, and
// in kSumRuns words after all of them, are for sumBefore.
void sumUp(CoherentUints sums, uint group, uint count, ListStates result, uint capacity) {
    const uint length = sumRunLength(count, kMostInOneRun);
    bool of_all = length >= count;
    [[dont_unroll]] do {  // compilers would generate code for each call of sumRange
        uint begin = 0, end = count;
        if (!of_all) {
            begin = group / length * length;
            end = min(begin + length, count);
        } else if (length < count) {
            begin = count;
            end = count + groupsOver(count, length);
        }
        if (of_all ? isLastGroup(result)
                   : group < count && isLastOfRun(result, begin / length, end - begin, kSumRunBits)) {
            const uint total = sumRange(sums, begin, end);
            if (gl_LocalInvocationIndex == 0) {
                if (of_all) {
                    result.at[0] = makeList(total, capacity);
                } else {
                    sums.at[count + begin / length] = min(total, kMaxItems + 1);
                }
            }
        }
        if (of_all) { return; }
        of_all = true;
    }
    while (true)
        ;
}
