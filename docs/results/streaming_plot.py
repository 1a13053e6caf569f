#!/usr/bin/env python3
"""Error and time against the budget of splats: streaming_plot.py BINOSPLAT OUT.svg SCENE SPLATS RENDER_OPTION...

Renders the streamed SCENE, of SPLATS splats at its finest level, with budgets of 5 to 100 per cent of these and whole (--lod 0), and prints
a table: splats, PSNR of the left eye against the whole scene's, time of a pair, splats on the device, memory. Plots PSNR and time.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SHARES = (0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0)
WIDTH, HEIGHT, LEFT, TOP, GAP = 320, 240, 52, 30, 80


def render(program, scene, options, more, out):
    subprocess.run([program, "render", scene, "--out", str(out), *options, *more], check=True, stdout=subprocess.DEVNULL)
    report = json.loads((out / "report.json").read_text())
    return report["counters"], report["gpu_total_ms"], report["peak_gpu_bytes"]


def psnr(program, a, b):
    said = subprocess.run([program, "compare", str(a), str(b)], check=True, capture_output=True, text=True).stdout
    return float(next(line.split()[1] for line in said.splitlines() if line.startswith("psnr ")))


def panel(x0, title, unit, points, low, high):
    def place(share, value):
        return x0 + WIDTH * share, TOP + HEIGHT * (high - value) / (high - low)

    out = [f'<text x="{x0}" y="{TOP - 10}" font-weight="bold">{title}</text>',
           f'<rect x="{x0}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>']
    for percent in (25, 50, 75, 100):
        x = x0 + WIDTH * percent / 100
        out.append(f'<path d="M{x} {TOP}v{HEIGHT}" stroke="#ddd"/><text x="{x}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{percent} %</text>')
    for step in range(5):
        value = low + (high - low) * step / 4
        y = place(0, value)[1]
        out.append(f'<path d="M{x0} {y:.1f}h{WIDTH}" stroke="#ddd"/><text x="{x0 - 6}" y="{y + 4:.1f}" text-anchor="end">{value:.0f}</text>')
    path = " ".join(f"{'L' if i else 'M'}{x:.1f} {y:.1f}" for i, (x, y) in enumerate(place(*point) for point in points))
    out.append(f'<path d="{path}" fill="none" stroke="#0072b2" stroke-width="2"/>')
    out += [f'<circle cx="{place(*point)[0]:.1f}" cy="{place(*point)[1]:.1f}" r="4" fill="#0072b2"/>' for point in points]
    out.append(f'<text x="{x0 + WIDTH / 2}" y="{TOP + HEIGHT + 34}" text-anchor="middle">budget, share of the finest level; {unit}</text>')
    return out


def main():
    program, picture, scene, splats, *options = sys.argv[1:]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        whole = pathlib.Path(folder) / "whole"
        _, whole_ms, whole_bytes = render(program, scene, options, ["--lod", "0"], whole)
        for share in SHARES:
            out = pathlib.Path(folder) / f"{share}"
            counters, ms, peak = render(program, scene, options, ["--splat-budget", str(round(share * int(splats)))], out)
            rows.append((share, counters, psnr(program, out / "left.exr", whole / "left.exr"), ms, peak))
    print(f"{'budget':>7} {'read':>9} {'PSNR dB':>8} {'ms':>8} {'MiB':>7}")
    for share, counters, db, ms, peak in rows:
        print(f"{100 * share:6.0f}% {counters['splats_read']:9} {db:8.1f} {ms:8.1f} {peak / 2**20:7.1f}")
    print(f"  whole {splats:>9} {'':>8} {whole_ms:8.1f} {whole_bytes / 2**20:7.1f}")
    errors = [(share, db) for share, _, db, _, _ in rows if share < 1]  # all of the splats are the same picture
    times = [(share, ms) for share, _, _, ms, _ in rows]
    body = panel(LEFT, "PSNR", "dB", errors, 10 * (min(db for _, db in errors) // 10), 10 * (max(db for _, db in errors) // 10 + 1))
    body += panel(LEFT + WIDTH + GAP, "time of a pair", "ms", times, 0, 400 * (max(ms for _, ms in times) // 400 + 1))
    pathlib.Path(picture).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + 2 * WIDTH + GAP + 20}" height="{TOP + HEIGHT + 46}" font-family="sans-serif" '
        f'font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(body) + "\n</svg>\n")


if __name__ == "__main__":
    main()
