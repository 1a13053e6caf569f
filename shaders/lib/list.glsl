// Lists whose length only the GPU knows, and the dispatches over them.

uint groupsOver(uint count, uint group_items) {
    return count / group_items + (count % group_items != 0 ? 1 : 0);
}

DispatchSize dispatchOver(uint count, uint group_items) {
    // In rows of equal length, with less than a group for each row left over in the last one.
    const uint groups = groupsOver(count, group_items), rows = groupsOver(groups, kMaxGroupsX);
    return DispatchSize(groupsOver(groups, max(rows, 1)), rows, 1);
}

// The length of a run when many counts are summed in two steps; there are at most kSumRuns runs. Returns
// `count` if one step will do, since there are no more than `most_in_one`, or more than a run's counter of
// workgroups can count.
uint sumRunLength(uint count, uint most_in_one) {
    return count > most_in_one && count <= kSumRuns * ((1u << kSumRunBits) - 1) ? groupsOver(count, kSumRuns)
                                                                                : count;
}

// The sum of the counts before one of `count` counts, after sumUp.
uint sumBefore(Uints sums, uint i, uint count) {
    const uint length = sumRunLength(count, kMostInOneRun);
    return sums.at[i] + (length < count ? sums.at[count + i / length] : 0);
}

// How many keys of a list of `count` one workgroup of a sort takes: a list of any length has at most
// kMaxSortBlocks blocks.
uint sortBlockKeys(uint count) { return kSortBlock * max(groupsOver(count, kSortBlock * kMaxSortBlocks), 1); }

// A list of `needed` items, or an empty one if that exceeds `capacity`: the frame is then void and is done
// again.
ListState makeList(uint needed, uint capacity) {
    const uint count = needed <= capacity ? needed : 0;
    return ListState(needed, count, /*groups_done*/ 0, uvec4(0), dispatchOver(count, kGroupSize),
                     dispatchOver(count, kListBlock), dispatchOver(count, sortBlockKeys(count)));
}
