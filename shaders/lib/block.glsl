// The blocks of kCullBlock splats that cull and compact go over, a workgroup each: all of a scene's, or with kInPages its visible pages
// (see cull_pages). Wants `pass` to be a CullPass or a CompactPass; needs lib/list.glsl.

uint blockCount() { return kInPages ? pass.visible_pages.at[0].count : groupsOver(pass.splat_count, kCullBlock); }

// The page that is a block of the list. Of many pages each run is listed where all of its pages would lie, and behind the pages are the numbers
// of visible ones before each run (cull_pages).
uint pageOfBlock(uint block) {
    const uint pages = groupsOver(pass.splat_count, kPageSplats), groups = groupsOver(pages, kGroupSize);
    const uint length = sumRunLength(groups, kMostPageGroupsInOneRun);
    if (length >= groups) { return pass.page_list.at[block]; }
    uint first = 0, before = 0;  // of the block's run, which is the last that begins no later
    for (uint run = 1; run < groupsOver(groups, length); ++run) {
        const uint begin = pass.page_list.at[pages + run];
        if (begin <= block) {
            first = run * length * kGroupSize;
            before = begin;
        }
    }
    return pass.page_list.at[first + (block - before)];
}

// The first splat of the block; if there is no such block (the last row of a dispatch may have more workgroups), one past all splats.
uint firstOfBlock(uint block) {
    if (!kInPages) { return min(block, groupsOver(pass.splat_count, kCullBlock)) * kCullBlock; }
    return block < pass.visible_pages.at[0].count ? pageOfBlock(block) * kCullBlock : pass.splat_count;
}
