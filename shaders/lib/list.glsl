// Lists whose length only the GPU knows, and the dispatches over them.

DispatchSize dispatchOver(uint count, uint group_items) {
    const uint groups = (count + group_items - 1) / group_items;
    return DispatchSize(min(groups, kMaxGroupsX), (groups + kMaxGroupsX - 1) / kMaxGroupsX, 1);
}

// A list of `needed` items, or an empty one if that is more than `capacity`: the frame is then void and done again.
ListState makeList(uint needed, uint capacity) {
    const uint count = needed <= capacity ? needed : 0;
    return ListState(needed, count, dispatchOver(count, kGroupSize), dispatchOver(count, kScanBlock), dispatchOver(count, kSortBlock),
                     dispatchOver(count, 1));
}
