#!/usr/bin/env python3
"""Error against run time over motion, from the motion.json of one or more runs: motion_plot.py OUT.svg TITLE=motion.json[:POINT] ...

A panel a run, or the run's only point that holds POINT. Across: the median time of a pair as a share of two-pass's. Up: the PSNR of the
run, with a bar down to the worst frame's. `shared` has no error: a line where its time is.
"""
import json
import sys

WIDTH, HEIGHT, LEFT, TOP, GAP = 300, 260, 52, 40, 64
COLOURS = {"paper": "#e69f00", "predicted": "#0072b2", "alternate": "#009e73", "temporal": "#d55e00"}


def colour_of(method):
    return next((colour for name, colour in COLOURS.items() if method.startswith(name)), "#555")


def points_of(path, wanted):
    results = [r for r in json.load(open(path))["results"] if wanted in r["point"]]
    assert len({r["point"] for r in results}) == 1, f"{path}: {wanted!r} must be in the name of one point"
    base = next(r["gpu_total_ms"]["median"] for r in results if r["method"] == "two-pass")
    for result in results:
        psnr = result.get("psnr_db")
        yield result["method"], result["gpu_total_ms"]["median"] / base, psnr and psnr["run"], psnr and psnr["worst"]


def panel(title, points, x0, low, high):
    def x(share):
        return x0 + WIDTH * share / 1.05

    def y(db):
        return TOP + HEIGHT * (high - db) / (high - low)

    out = [f'<text x="{x0}" y="{TOP - 12}" font-weight="bold">{title}</text>',
           f'<rect x="{x0}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>']
    for tick in (0.2, 0.4, 0.6, 0.8, 1.0):
        out.append(f'<path d="M{x(tick):.1f} {TOP}v{HEIGHT}" stroke="#ddd"/>')
        out.append(f'<text x="{x(tick):.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{tick:.1f}</text>')
    for tick in range(low, high + 1, 5):
        out.append(f'<path d="M{x0} {y(tick):.1f}h{WIDTH}" stroke="#ddd"/>')
        out.append(f'<text x="{x0 - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick}</text>')
    out.append(f'<text x="{x0 + WIDTH / 2}" y="{TOP + HEIGHT + 34}" text-anchor="middle">time of a pair / two-pass</text>')
    for method, share, run, worst in points:
        if method == "shared":
            out.append(f'<path d="M{x(share):.1f} {TOP}v{HEIGHT}" stroke="#555" stroke-dasharray="4 3"/>')
            out.append(f'<text x="{x(share) - 4:.1f}" y="{TOP + 14}" text-anchor="end" fill="#555">shared: no error</text>')
        if run is None:
            continue
        colour = colour_of(method)
        out.append(f'<path d="M{x(share):.1f} {y(run):.1f}V{y(worst):.1f}" stroke="{colour}" stroke-width="2"/>')
        out.append(f'<circle cx="{x(share):.1f}" cy="{y(run):.1f}" r="4" fill="{colour}"/>')
        beside = 'x="%.1f" text-anchor="end"' % (x(share) - 7) if share > 0.7 or method == "alternate" else 'x="%.1f"' % (x(share) + 7)
        out.append(f'<text {beside} y="{y(run) + 4:.1f}" fill="{colour}">{method}</text>')
    return out


def main():
    runs = []
    for argument in sys.argv[2:]:
        title, path = argument.split("=", 1)
        path, _, wanted = path.partition(":")
        runs.append((title, list(points_of(path, wanted))))
    values = [v for _, points in runs for p in points for v in p[2:] if v is not None]
    low, high = 5 * int(min(values) // 5), 5 * int(-(-(max(values) + 2) // 5))  # room for a line of text
    width = LEFT + len(runs) * (WIDTH + GAP)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{TOP + HEIGHT + 48}" font-family="sans-serif" font-size="12">',
           '<rect width="100%" height="100%" fill="white"/>',
           f'<text x="14" y="{TOP + HEIGHT / 2}" transform="rotate(-90 14 {TOP + HEIGHT / 2})" text-anchor="middle">PSNR, dB: run, worst frame</text>']
    for i, (title, points) in enumerate(runs):
        out += panel(title, points, LEFT + i * (WIDTH + GAP), low, high)
    with open(sys.argv[1], "w") as file:
        file.write("\n".join(out + ["</svg>"]) + "\n")


main()
