// The blocks of kCullBlock splats that cull and compact process, one per workgroup: all of a scene's blocks
// or, with kInPages, its visible pages (see cull_pages). Needs `pass` to be a CullPass or a CompactPass, and
// lib/list.glsl.

uint blockCount() {
    return kInPages ? pass.visible_pages.at[0].count : groupsOver(pass.splat_count, kCullBlock);
}

// The page of a block in the list. If there are many pages, each run is listed at the place that it would
// have if all pages were visible; then follow the numbers of visible pages before each run (cull_pages).
uint pageOfBlock(uint block) {
    const uint pages = groupsOver(pass.splat_count, kPageSplats), groups = groupsOver(pages, kGroupSize);
    const uint length = sumRunLength(groups, kMostPageGroupsInOneRun);
    if (length >= groups) { return pass.page_list.at[block]; }
    uint first = 0, before = 0;  // of the block's run: the last one that does not begin after it
    for (uint run = 1; run < groupsOver(groups, length); ++run) {
        const uint begin = pass.page_list.at[pages + run];
        if (begin <= block) {
            first = run * length * kGroupSize;
            before = begin;
        }
    }
    return pass.page_list.at[first + (block - before)];
}

// The first splat of the block, or the number of all splats if there is no such block (the last row of a
// dispatch may have more workgroups).
uint firstOfBlock(uint block) {
    if (!kInPages) { return min(block, groupsOver(pass.splat_count, kCullBlock)) * kCullBlock; }
    return block < pass.visible_pages.at[0].count ? pageOfBlock(block) * kCullBlock : pass.splat_count;
}
