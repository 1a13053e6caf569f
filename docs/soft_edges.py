#!/usr/bin/env python3
"""How many pixels of a soft edge keep a depth between its two surfaces: `docs/soft_edges.py` prints the table of docs/tried.md, *Depth for
the runtime*.

A row of pixels blends depth 2 in front of depth 4, and `present`'s rule (shaders/present/present.comp) is applied to what it would read:
the mean of z, then that of 1/z."""

import math

FRONT, BACK = 1 / 2, 1 / 4
ON_SURFACE, BETWEEN_SURFACES, STEPS, OFF = 0.02, 0.1, 16, 0.03


def surface_along(inverse, at, way):
    depth = inverse[at]
    for step in range(STEPS):
        at += way
        if not 0 <= at < len(inverse):
            return 0
        if abs(inverse[at] - depth) <= ON_SURFACE * depth:
            return depth if step == 0 else inverse[at]
        depth = inverse[at]
    return 0


def submitted(inverse, at, by_inverse):
    # Along the edge nothing changes, so that the pixel's own depth is one of the ends.
    ends = [inverse[at]] + [end for end in (surface_along(inverse, at, 1), surface_along(inverse, at, -1)) if end > 0]
    front, back, own = max(ends), min(ends), inverse[at]
    if front <= (1 + BETWEEN_SURFACES) * back:
        return own
    share = (own - back) / (front - back) if by_inverse else (1 / back - 1 / own) / (1 / back - 1 / front)
    return front if share >= 0.5 else back


def count(cover, by_inverse):
    """Pixels between 2 % and 98 % of the front; those that are off as the mean, and as submitted."""
    inverse = [a * FRONT + (1 - a) * BACK if by_inverse else 1 / (a / FRONT + (1 - a) / BACK) for a in cover]
    soft = [i for i, a in enumerate(cover) if 0.02 < a < 0.98]

    def is_off(i, depth):
        return abs((FRONT if cover[i] >= 0.5 else BACK) / depth - 1) > OFF

    return len(soft), sum(is_off(i, inverse[i]) for i in soft), sum(is_off(i, submitted(inverse, i, by_inverse)) for i in soft)


def edge(width):
    shares = [min(max(0.5 - x / width, 0), 1) for x in range(-200, 200)]
    return [s * s * (3 - 2 * s) for s in shares]


def splat(deviation):
    return [0.99 * math.exp(-0.5 * (x / deviation) ** 2) for x in range(-200, 200)]


for name, shape, sizes in (("an edge over", edge, (8, 16, 24, 32, 48, 64)), ("a splat of", splat, (1, 2, 4, 8, 16))):
    for size in sizes:
        by_z, by_inverse = count(shape(size), False), count(shape(size), True)
        print(f"{name} {size} px:", ", ".join(f"{a} and {b}" for a, b in zip(by_z, by_inverse)))
