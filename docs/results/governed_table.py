#!/usr/bin/env python3
"""What the governor's choice is worth: governed_table.py BINOSPLAT DATA MOTION.csv OUT [SHARE [VIEW...]]

For each view of configs/bench/seen.toml at 640x640: has the governor hold `temporal` within SHARE (0.7) of the time
of `two-pass` at the same poses, and compares it with `temporal` at the full size and with lower resolutions in the
same time (bad tiles interpolated over times). Times are means of the frames' shares of `two-pass`. At 90 Hz
from second 16; what counts is the second from 17, when the governor has settled. DATA is a folder with the
scenes. Prints a row for each view, and writes what bench said under OUT.
"""
import csv
import os
import subprocess
import sys
import tomllib

METHODS = [{"name": "temporal", "mode": "temporal", "budget": [0.001, 0.02, 0.05, 0.1, 0.2, 0.3]},
           {"name": "shared", "mode": "shared", "resolution": [0.3, 0.4, 0.5, 0.6, 0.7, 0.8]}]
RATE, FIRST = 90, 90


def find(data, scene):
    names = [scene] if isinstance(scene, str) else scene
    if names[0].startswith("builtin:"):
        return names[0]
    return next(os.path.join(folder, names[0]) for folder, _, files in os.walk(data) if names[0] in files)


def bench(program, scene, view, motion, out, methods, every):
    """Rows of motion.csv by method."""
    os.makedirs(out, exist_ok=True)
    with open(f"{out}/plan.toml", "w") as file:
        print('[bench]\nmodes = ["two-pass"]\nscores = ["psnr"]\nwarm-up = 0', file=file)
        for head, table in [("methods", m) for m in methods] + [("views", view)]:
            print(f"\n[[{head}]]", *(f"{k} = {v!r}".replace("'", '"') for k, v in table.items()), sep="\n", file=file)
    command = [program, "bench", scene, "--config", f"{out}/plan.toml", "--size", "640x640", "--motion", motion, "--motion-axes",
               "unity", "--from", "16", "--seconds", "2", "--rate", str(RATE), "--every", str(every), "--out", out]
    with open(f"{out}/log.txt", "w") as log:
        subprocess.run(command, check=True, stdout=log, stderr=subprocess.STDOUT)
    rows = {}
    with open(f"{out}/motion.csv") as file:
        for row in csv.DictReader(file):
            if float(row["time_s"]) >= FIRST / RATE:
                rows.setdefault(row["method"], []).append(row)
    return rows


def values(rows, column):
    return [float(row[column]) for row in rows]


def mean(numbers):
    return sum(numbers) / len(numbers)


def at_time(points, time):
    points = sorted(points)
    if time < points[0][0]:
        return f"{points[0][1]:.2f} in {points[0][0]:.2f}"
    for (t0, b0), (t1, b1) in zip(points, points[1:]):
        if time <= t1:
            return f"{b0 + (b1 - b0) * (time - t0) / (t1 - t0):.2f}"
    return f"{points[-1][1]:.2f}"


def main():
    program, data, motion, out = sys.argv[1:5]
    share, wanted = float((sys.argv[5:] + ["0.7"])[0]), sys.argv[6:]
    plan = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../configs/bench/seen.toml")
    with open(plan, "rb") as file:
        views = [view for view in tomllib.load(file)["views"] if not wanted or view["name"] in wanted]
    print("| view | time | bad, % | temporal | lower resolution | chosen |\n|---|---|---|---|---|---|")
    for view in views:
        scene = find(data, view.get("scene"))
        view = {key: value for key, value in view.items() if key not in ("scene", "size")}
        folder = f"{out}/{view['name'].replace(', ', '_')}"
        governed = {"name": "governed", "mode": "temporal", "frame-time": f"{100 * share:g}%"}
        rows = bench(program, scene, view, motion, folder, [governed, *METHODS], 3)
        whole = values(rows["two-pass"], "gpu_total_ms")
        time = {method: mean([ms / all_ms for ms, all_ms in zip(values(of, "gpu_total_ms"), whole)])
                for method, of in rows.items()}
        bad = {method: 100 * mean(values(of, "bad_share")) for method, of in rows.items()}
        points = lambda name: [(time[m], bad[m]) for m in rows if m.startswith(name)]
        chosen = {}
        for row in rows["governed"]:
            key = f"{100 * float(row['resolution']):.0f} %, {float(row['error_bound_db']):.0f} dB"
            chosen[key] = chosen.get(key, 0) + 1
        print(f"| {view['name']} | {time['governed']:.2f} | {bad['governed']:.2f} | "
              f"{at_time(points('temporal'), time['governed'])} | {at_time(points('shared@'), time['governed'])} | "
              f"{'; '.join(f'{key} ({count})' for key, count in chosen.items())} |", flush=True)


main()
