// The workgroup that finishes last takes the next step of an algorithm, which then needs no command of its own. Nobody waits for
// anybody, so that workgroups may run in any order, one at a time if need be. For shaders that include lib/group.glsl.

shared uint group_is_last;

// Whether all other workgroups of the dispatch are done; `list` counts them and is back at 0 afterwards. In uniform control flow, by
// every workgroup, once.
//
// What the others wrote is then there to read, if it is read and written through a `coherent` array: a thread's writes come before its
// memoryBarrierBuffer (release, for the whole device), that before the barrier() at which thread 0 learns of it, and that before the
// atomicAdd, which the last workgroup's atomicAdd sees; from there the same way back: barrier() and memoryBarrierBuffer (acquire).
bool isLastGroup(ListStates list) {
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex == 0) {
        const uint done = atomicAdd(list.at[0].groups_done, 1) + 1;
        group_is_last = done == gl_NumWorkGroups.x * gl_NumWorkGroups.y ? 1 : 0;
        if (group_is_last != 0) { atomicExchange(list.at[0].groups_done, 0); }
    }
    barrier();
    memoryBarrierBuffer();
    return group_is_last != 0;
}
