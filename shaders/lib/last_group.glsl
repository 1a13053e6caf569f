// The workgroup that finishes last takes the next step of an algorithm, which then needs no command of its own. Nobody waits for
// anybody, so that workgroups may run in any order, one at a time if need be. For shaders that include lib/group.glsl.

shared uint group_is_last;

// Whether all other workgroups of the dispatch are done; `list` counts them and is back at 0 afterwards. In uniform control flow, by
// every workgroup, once.
//
// What the others wrote is then there to read, if it is read and written through a `coherent` array. In the words of Vulkan's memory model
// each memoryBarrierBuffer releases and acquires for the whole device; two of them synchronize where a barrier() lies between them, or the
// two atomicAdds. So a thread's writes are handed to its thread 0, from there to thread 0 of the last workgroup, and on to its threads.
bool isLastGroup(ListStates list) {
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        memoryBarrierBuffer();
        const uint done = atomicAdd(list.at[0].groups_done, 1) + 1;
        group_is_last = done == gl_NumWorkGroups.x * gl_NumWorkGroups.y ? 1 : 0;
        if (group_is_last != 0) { atomicExchange(list.at[0].groups_done, 0); }
        memoryBarrierBuffer();
    }
    barrier();
    memoryBarrierBuffer();
    return group_is_last != 0;
}
