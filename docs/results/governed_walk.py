#!/usr/bin/env python3
"""What the viewer's controller does over a minute: governed_walk.py BINOSPLAT SCENE MOTION.csv OUT [RATE [SECONDS]]

Walks with a recorded head (axes of Unity) in the simulated headset, at its real clock, with 384x384 pixels an
eye. Then the same head poses are shown in lock-step in `shared`, ungoverned, and every twelfth picture of the
two is compared. Writes OUT/walk.csv and OUT/walk.svg: late frames, resolution, bound and bad tiles over time.
Needs python3-numpy and python3-pil.
"""
import json
import os
import re
import subprocess
import sys

import numpy as np
from PIL import Image

EVERY, SIZE, REST_S = 12, 384, 2.0
HEADSET = f"size {SIZE} {SIZE}\neye left angles -35 35 35 -35\neye right angles -35 35 35 -35\n"


def frames_in(path):
    with open(path) if os.path.exists(path) else open(os.devnull) as file:
        return sum('"frame"' in line for line in file)


def view(program, scene, out, script, clock, mode, quality, frames):
    """Runs the viewer; the lines that it prints, each with the frames so far, and all frames."""
    os.makedirs(out, exist_ok=True)
    for name, text in (("walk.script", script), ("view.toml", f'[view]\nquality = "{quality}"\n')):
        with open(f"{out}/{name}", "w") as file:
            file.write(text)
    command = [program, "view", scene, "--simulate", f"{out}/walk.script", "--config", f"{out}/view.toml",
               "--mode", mode, "--out", f"{out}/pictures", "--frames", str(frames), "--hide-panel", "--hide-hands", "--load-first"]
    lines = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1,
                          env=dict(os.environ, SIMULATED_OPENXR_CLOCK=clock)) as run:
        for line in run.stdout:
            lines.append((frames_in(f"{out}/pictures/frames.jsonl"), line.rstrip()))
    if run.returncode != 0:
        sys.exit("\n".join(line for _, line in lines))
    with open(f"{out}/pictures/frames.jsonl") as file:
        return lines, [frame for frame in map(json.loads, file) if "frame" in frame]


def bad_share(a, b):
    """The share of tiles of 16x16 pixels under 30 dB, and the PSNR, of the two eyes' pictures side by side."""
    square = ((a - b) ** 2).mean(2)
    tiles = square.reshape(square.shape[0] // 16, 16, square.shape[1] // 16, 16).mean((1, 3))
    return (tiles > 1e-3).mean(), -10 * np.log10(max(square.mean(), 1e-10))


def read(path):
    return np.asarray(Image.open(path).convert("RGB"), np.float32) / 255


def pose(head):
    return " ".join(["position", *map(str, head["position"]), "rotation", *map(str, head["orientation"])])


def panel(top, title, points, low, high, seconds, steps):
    """A plot of (seconds, value), as steps or as points."""
    place = [(60 + 700 * t / seconds, top + 110 - 90 * (v - low) / (high - low)) for t, v in points]
    out = [f'<text x="60" y="{top + 12}" font-weight="bold">{title}</text>',
           f'<rect x="60" y="{top + 20}" width="700" height="90" fill="none" stroke="#888"/>',
           f'<text x="54" y="{top + 28}" text-anchor="end">{high:g}</text>',
           f'<text x="54" y="{top + 110}" text-anchor="end">{low:g}</text>']
    if steps:
        path = f"M{place[0][0]:.1f} {place[0][1]:.1f}" + "".join(f"H{x:.1f}V{y:.1f}" for x, y in place[1:]) + "H760"
    else:
        path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in place)
    return out + [f'<path d="{path}" fill="none" stroke="#0072b2" stroke-width="1.5"/>']


def main():
    program, scene, motion, out = sys.argv[1:5]
    rate, seconds = float((sys.argv[5:] + ["10"])[0]), float((sys.argv[6:] + ["60"])[0])
    frames = int(rate * (seconds + REST_S))
    script = f"{HEADSET}rate {rate:g} fixed\nhead-motion {os.path.abspath(motion)} axes unity start {REST_S:g} skip 10\nframes every {EVERY}\n"
    lines, shown = view(program, scene, f"{out}/governed", script, "real", "temporal", "balanced", frames)
    script = f"{HEADSET}rate {rate:g} fixed\n" + "".join(
        f"head {i / rate:.9f} {pose(frame['head'])}\n" for i, frame in enumerate(shown)) + f"frames every {EVERY}\n"
    _, full = view(program, scene, f"{out}/full", script, "lockstep", "shared", "off", len(shown))

    begin_ns, period_s = shown[0]["display_time_ns"], 1 / rate
    times = [1e-9 * (frame["display_time_ns"] - begin_ns) for frame in shown]
    width = [layer["views"][0]["rect"][2] for frame in shown for layer in frame["layers"] if layer["type"] == "projection"]
    width = [width[0]] * (len(shown) - len(width)) + width
    late = [0] + [round((b - a) / period_s) - 1 for a, b in zip(times, times[1:])]
    bounds = [(0, 30.0)]
    for at, line in lines:
        found = re.search(r"temporal at \d+ %, errors within (\d+) dB", line)
        if found:
            bounds.append((at, float(found.group(1))))
    bound_at = [[bound for at, bound in bounds if at <= i][-1] for i in range(len(shown))]
    rows, bad = [], []
    for i, frame in enumerate(shown):
        if "picture" in frame and "picture" in full[i]:
            share, db = bad_share(read(f"{out}/governed/pictures/{frame['picture']}"), read(f"{out}/full/pictures/{full[i]['picture']}"))
            bad.append((times[i], 100 * share))
            rows.append(f"{i},{times[i]:.3f},{late[i]},{width[i] / max(width):.2f},{bound_at[i]:g},{share:.5f},{db:.2f}")
        else:
            rows.append(f"{i},{times[i]:.3f},{late[i]},{width[i] / max(width):.2f},{bound_at[i]:g},,")
    with open(f"{out}/walk.csv", "w") as file:
        file.write("\n".join(["frame,time_s,periods_late,resolution,error_bound_db,bad_share,psnr_db", *rows, ""]))
    plots = [("late frames in the second before", [(t, sum(l > 0 for s, l in zip(times, late) if t - 1 < s <= t)) for t in times], 0, max(3, int(rate)), True),
             ("resolution, share of the width", [(t, w / max(width)) for t, w in zip(times, width)], 0, 1, True),
             ("bound, dB", list(zip(times, bound_at)), 20, 30, True),
             ("bad tiles, %", bad, 0, max(5, max(b for _, b in bad)), False)]
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="790" height="580" font-family="sans-serif" font-size="12">',
             '<rect width="100%" height="100%" fill="#fff"/>']
    for i, (title, points, low, high, steps) in enumerate(plots):
        parts += panel(10 + 135 * i, title, points, low, high, times[-1], steps)
    parts += [f'<text x="{60 + 700 * i / 6:.0f}" y="560" text-anchor="middle">{times[-1] * i / 6:.0f} s</text>' for i in range(7)]
    with open(f"{out}/walk.svg", "w") as file:
        file.write("\n".join(parts + ["</svg>", ""]))
    print(f"{len(shown)} frames in {times[-1]:.1f} s, {sum(l > 0 for l in late)} late; {len(bounds) - 1} changes; "
          f"bad tiles {np.mean([b for _, b in bad]):.2f} % in the mean, {max(b for _, b in bad):.2f} % at most")


main()
