// Built-in scenes: two to look at, and small analytic ones whose pictures can be derived by hand.
// World axes as in trained scenes: x right, y down, z forward; metres.
//
// builtin:atelier       a furnished room with a window onto hills, 1,000 to 10,000,000 splats of the same look (default 200,000).
//                       The floor is y = 0, the ceiling y = -2.8; x from -3 to 3, z from 0 to 5. Only its glazed vase has SH beyond
//                       degree 0 (degree 3).
//
// builtin:clockwork     things that turn, swing and appear, 2,000 to 1,000,000 splats of the same look (default 20,000), sh_degree 0.
//                       Periodic after kClockworkFrames = 120 frames, 30 in a second. Splat i is the same piece of the same thing in all
//                       frames, of constant scales and colour; its quaternion turns without a change of sign, from the last frame to
//                       the first, too. Opacity 0.95, but for the lamp. Angles are from x towards y: positive ones are clockwise as seen.
//                       At frame f, with s = f / 120, t = (f - a) / (b - a) kept to [0, 1] and e(a, b) = 3 t^2 - 2 t^3, in this order:
//   what stays          three fifths of the splats, the same to the last bit in all frames: a wall z = 2.8 and a table top y = 0.8, both
//                       with x from -2.2 to 2.2, posts, the clock's case and dial, the lamp's foot.
//   three wheels        of n teeth, middle plane z = 1.6, 0.08 thick, pitch radius R = 0.025 n, teeth from R - 0.05 to R + 0.04. Each turns
//                       about z through its middle by 2 pi k s; its white tooth points to angle a at f = 0, where a0 = -atan(4/3):
//                         n = 18, middle (-0.39, 0.24), k = 2, a = a0
//                         n = 9, middle (0.015, -0.30), k = -4, a = a0 + 200 degrees
//                         n = 6, middle (-0.285, -0.525), k = 6, a = a0 + 105 degrees
//   hand                0.31 long, turns about z through (0.62, -0.46, 2.44) by 4 pi s; upright at f = 0.
//   pendulum            turns about z through (0.62, -0.10, 2.48) by 20 degrees sin(4 pi s). Its bob, of radius 0.14, hangs 0.62 below.
//   cuckoo              a box of 0.16 x 0.16 x 0.14 with a beak, middle (0.62, -0.985, 2.705), comes 0.35 (e(32, 44) - e(64, 76)) along
//                       -z.
//   door                of 0.25 x 0.26, middle of its left edge (0.495, -0.985, 2.545), turns about y through there, its right edge
//                       towards the eye, by 115 degrees (e(20, 32) - e(76, 88)).
//   lamp                a globe, middle (0.94, 0.38, 2.0), radius 0.15, of opacity 0.95 (1 - e(40, 52) + e(88, 100)).
//
// The analytic scenes have sh_degree 0 and one size each (--splats is refused if it differs). "Grey g" is a colour of (g, g, g).
// builtin:one-splat     one disc: centre (0, 0, 2), t_u = x, t_v = y, t_w = z, scales (0.2, 0.1), opacity 0.8, colour (0.9, 0.6, 0.3).
// builtin:slanted-wall  41 x 41 discs, kWallStep = 0.1 apart along (1, 0, 1)/sqrt(2) and y, middle (0, 0, 4): the plane z = 4 + x.
//                       Scales (0.08, 0.08), opacity 0.95; colour by disc (i, j), i along the wall, j down, from 0 to 40:
//                       (0.2 + 0.6 i/40, 0.2 + 0.6 j/40, 0.5).
// builtin:two-layers    two discs facing the eye: centre (0, 0, 2), scales (0.5, 0.5), opacity 0.5, grey 0.8, and behind it
//                       centre (0, 0, 4), scales (1, 1), opacity 0.9, colour (0.1, 0.2, 0.6): as seen from the origin
//                       they cover the same pixels.
// builtin:step-edge     two walls facing the eye, each a grid of discs 0.05 apart with scales (0.04, 0.04) and opacity 0.95:
//                       z = 2, x from -1.5 to -0.05, y from -1.5 to 1.5 (30 x 61), grey 0.75; and behind it z = 4, x and y from -3 to 3
//                       (121 x 121), grey 0.25 where (floor(2x) + floor(2y)) is even and 0.4 elsewhere.
// builtin:fence         9 bars before a wall. Bar i from 0 to 8: x = -0.8 + 0.2 i, z = 1, 81 discs at y = -1 + 0.025 j, j from 0 to 80,
//                       scales (0.006, 0.02), opacity 0.95, colour (0.5, 0.3, 0.15). Wall: z = 3, x and y from -3 to 3, discs 0.05 apart
//                       (121 x 121), scales (0.04, 0.04), opacity 0.95, colour (0.3 + 0.1 sin(2 x), 0.5, 0.6 + 0.1 sin(3 y)).
#pragma once

#include "engine/scene/scene.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// A view of a built-in scene.
struct View {
    glm::dvec3 eye, look, up;
    double fov_x_deg;
};

struct BuiltinInfo {
    std::string name;  // without the prefix
    std::string what;  // one line for a listing
    std::uint64_t default_splats;
    std::uint64_t min_splats, max_splats;
};
std::vector<BuiltinInfo> listBuiltins();

// True if `source` has the prefix "builtin:".
bool isBuiltin(const std::string& source);

// The recommended view; `name` with or without the prefix. Empty for names that are not there.
std::optional<View> builtinView(const std::string& name);

inline constexpr std::uint64_t kClockworkFrames = 120;

// The frames until a scene repeats; 1 for those that do not move. `source` with or without the prefix.
std::uint64_t builtinFrameCount(const std::string& source);

// Makes builtin:NAME with exactly `splats` splats (0: its default) as it is at `frame`; splat i is the same piece of the same thing in all
// frames. The same on every run, whatever the number of threads. Throws Error for a name or a count it does not have, and for a frame other
// than 0 of a scene that does not move.
Scene makeBuiltin(const std::string& source, std::uint64_t splats = 0, const Progress& progress = {}, std::uint64_t frame = 0);
// For making many frames of a scene that moves: while this is held, what they share is made only once. Null for one that does not move.
std::shared_ptr<const void> keepBuiltin(const std::string& source, std::uint64_t splats = 0);

}  // namespace binosplat
