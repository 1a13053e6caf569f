// Built-in scenes: one to look at, and small analytic ones whose pictures can be derived by hand.
// World axes as in trained scenes: x right, y down, z forward; metres.
//
// builtin:atelier       a furnished room with a window onto hills, 1,000 to 40,000,000 splats of the same
//                       look (default 200,000). The floor is y = 0, the ceiling y = -2.8; x from -3 to 3, z
//                       from 0 to 5. Only its glazed vase has SH beyond degree 0 (degree 3).
//
// The analytic scenes have sh_degree 0 and one size each (--splats is refused if it differs). "Grey g" is a
// colour of (g, g, g).
// builtin:one-splat     one disc: centre (0, 0, 2), t_u = x, t_v = y, t_w = z, scales (0.2, 0.1), opacity
//                       0.8, colour (0.9, 0.6, 0.3).
// builtin:slanted-wall  41 x 41 discs, kWallStep = 0.1 apart along (1, 0, 1)/sqrt(2) and y, middle (0, 0, 4):
//                       the plane z = 4 + x. Scales (0.08, 0.08), opacity 0.95; colour by disc (i, j), i
//                       along the wall, j down, from 0 to 40: (0.2 + 0.6 i/40, 0.2 + 0.6 j/40, 0.5).
// builtin:two-layers    two discs facing the eye: centre (0, 0, 2), scales (0.5, 0.5), opacity 0.5, grey 0.8,
//                       and behind it centre (0, 0, 4), scales (1, 1), opacity 0.9, colour (0.1, 0.2, 0.6):
//                       seen from the origin, they cover the same pixels.
// builtin:step-edge     two walls facing the eye, each a grid of discs 0.05 apart with scales (0.04, 0.04)
//                       and opacity 0.95: z = 2, x from -1.5 to -0.05, y from -1.5 to 1.5 (30 x 61), grey
//                       0.75; and behind it z = 4, x and y from -3 to 3 (121 x 121), grey 0.25 where
//                       (floor(2x) + floor(2y)) is even and 0.4 elsewhere.
// builtin:fence         9 bars in front of a wall. Bar i from 0 to 8: x = -0.8 + 0.2 i, z = 1, 81 discs at
//                       y = -1 + 0.025 j, j from 0 to 80, scales (0.006, 0.02), opacity 0.95,
//                       colour (0.5, 0.3, 0.15). Wall: z = 3, x and y from -3 to 3, discs 0.05 apart
//                       (121 x 121), scales (0.04, 0.04), opacity 0.95,
//                       colour (0.3 + 0.1 sin(2 x), 0.5, 0.6 + 0.1 sin(3 y)).
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace binosplat {

struct BuiltinInfo {
    std::string name;  // without the prefix
    std::string what;  // one line for a listing
    std::uint64_t default_splats;
    std::uint64_t min_splats, max_splats;
};
std::vector<BuiltinInfo> listBuiltins();

// True if `source` has the prefix "builtin:".
bool isBuiltin(const std::string& source);

// The recommended view; `name` with or without the prefix. Empty for unknown names.
std::optional<View> builtinView(const std::string& name);

// Makes builtin:NAME with exactly `splats` splats (0: its default). The same on every run, whatever the
// number of threads. Throws Error for an unknown name or an impossible count.
Scene makeBuiltin(const std::string& source, std::uint64_t splats = 0, const Progress& progress = {});

}  // namespace binosplat
