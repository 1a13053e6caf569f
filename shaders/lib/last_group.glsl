// The workgroup that finishes last takes the next step of an algorithm, which then needs no command of its
// own. Workgroups never wait for each other, so they may run in any order, even one at a time. For shaders
// that include lib/group.glsl.

shared uint group_is_last;

// True if all other workgroups of the dispatch are done; `list` counts them and is back at 0 afterwards. Must
// be called in uniform control flow, once by every workgroup.
bool isLastGroup(ListStates list);
// The same for the `groups` workgroups of one run; the list counts 128 / bits runs, and `groups` is less than
// 2^bits.
bool isLastOfRun(ListStates list, uint run, uint groups, uint bits);

// What the others wrote can then be read, if it is written and read through a `coherent` array. In the words
// of Vulkan's memory model each memoryBarrierBuffer releases and acquires for the whole device; two of them
// synchronize if a barrier() lies between them, or the two atomicAdds. So a thread's writes are handed to its
// thread 0, from there to thread 0 of the last workgroup, and on to its threads. Hands what the workgroup
// wrote to its thread 0.
void beginLast() {
    memoryBarrierBuffer();
    barrier();
}

// And what others wrote, from there to all of its threads.
bool endLast() {
    barrier();
    memoryBarrierBuffer();
    return group_is_last != 0;
}

bool isLastGroup(ListStates list) {
    beginLast();
    if (gl_LocalInvocationIndex == 0) {
        memoryBarrierBuffer();
        const uint done = atomicAdd(list.at[0].groups_done, 1) + 1;
        group_is_last = done == gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_NumWorkGroups.z ? 1 : 0;
        if (group_is_last != 0) { atomicExchange(list.at[0].groups_done, 0); }
        memoryBarrierBuffer();
    }
    return endLast();
}

bool isLastOfRun(ListStates list, uint run, uint groups, uint bits) {
    beginLast();
    if (gl_LocalInvocationIndex == 0) {
        memoryBarrierBuffer();
        const uint in_word = 32 / bits, word = run / in_word, shift = bits * (run % in_word);
        const uint before =
            atomicAdd(list.at[0].run_groups_done[word], 1u << shift) >> shift & ((1u << bits) - 1);
        group_is_last = before + 1 == groups ? 1 : 0;
        if (group_is_last != 0) { atomicAdd(list.at[0].run_groups_done[word], 0u - (groups << shift)); }
        memoryBarrierBuffer();
    }
    return endLast();
}
