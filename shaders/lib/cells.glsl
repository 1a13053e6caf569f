// For shaders that blend by cells; include this after lib/outline.glsl.

// The cells of the tile that the splat touches, one bit each.
uint cellsOf(ProjectedSplat splat, uvec2 tile_px, float low_pass) {
    const Outline outline = outlineOfProjected(splat, low_pass);
    if (!outline.ellipse) { return 15; }
    uint cells = 0;
    for (uint row = 0; row < 2; ++row) {
        const float first_row = float(tile_px.y + row * kCellSize) + 0.5;
        vec2 bounds = boundsBetweenRows(outline, first_row - kOutlinePadding,
                                        first_row + float(kCellSize - 1) + kOutlinePadding);
        bounds += vec2(-kOutlinePadding, kOutlinePadding) - (float(tile_px.x) + 0.5);
        // Pixel columns 0 to 7 and 8 to 15 of the tile.
        if (bounds.x <= float(kCellSize - 1) && bounds.y >= 0) { cells |= 1u << (2 * row); }
        if (bounds.x <= float(2 * kCellSize - 1) && bounds.y >= float(kCellSize)) {
            cells |= 2u << (2 * row);
        }
    }
    return cells;
}
