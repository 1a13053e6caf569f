// The blocks of kCullBlock splats that cull and compact go over, a workgroup each: all of a scene's, or with kInPages its visible pages
// (see cull_pages). Wants `pass` to be a CullPass or a CompactPass; needs lib/list.glsl.

uint blockCount() { return kInPages ? pass.visible_pages.at[0].count : groupsOver(pass.splat_count, kCullBlock); }

// The first splat of the block; if there is no such block (the last row of a dispatch may have more workgroups), one past all splats.
uint firstOfBlock(uint block) {
    if (!kInPages) { return min(block, groupsOver(pass.splat_count, kCullBlock)) * kCullBlock; }
    return block < pass.visible_pages.at[0].count ? pass.page_list.at[block] * kCullBlock : pass.splat_count;
}
