#!/usr/bin/env python3
"""Checks whether two builds of the program draw the same.

tests/same_pictures.py OLD NEW [--times N] [--modes A,B] [--size WxH] [SCENE...]

Covers every mode and the options that change its passes, over some scenes. Pictures are compared byte for byte;
in report.json, the counters, what was left out, the shares that were rendered, and the peak of memory (within
1 %). With --times the two builds alternate N times, and the median of the ratios of their pair times (new / old)
is printed. Exits with 1 if anything differs."""

import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

SCENES = ["builtin:atelier", "builtin:fence", "builtin:step-edge", "builtin:slanted-wall"]
CAMERA = ["--size", "300x260", "--ipd", "0.064"]
CANTED = ["--headset", "pimax_crystal", "--size", "200x180"]
WAYS = [
    ["--mode", "mono"],
    ["--mode", "two-pass"],
    ["--mode", "shared", "--dominant", "right"],
    ["--mode", "reproject"],
    ["--mode", "reproject", "--resampling", "forward"],
    ["--mode", "reproject", "--depth", "sum"],
    ["--mode", "paper"],
    ["--mode", "paper", "--center-roi", "--depth", "mean"],
    ["--mode", "paper", "--center-roi", "--dominant", "right", "--per-eye"],
    ["--mode", "predicted"],
    ["--mode", "predicted", "--dominant", "right", "--budget", "0.5", "--order", "distance"],
    ["--mode", "predicted", "--move-cost", "0"],
    ["--mode", "predicted", "--move-cost", "100000"],
    ["--mode", "predicted", "--foveation", "10", "--move-cost", "0"],
]


def render(program, scene, options, out):
    out.mkdir(exist_ok=True)
    for file in out.iterdir():
        file.unlink()
    command = [program, "render", scene, "--out", str(out), *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return json.loads((out / "report.json").read_text())


def contents(path):
    """The file's bytes, without the time at which an EXR file was written."""
    return re.sub(rb"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", b"", path.read_bytes())


def differences(old, new, old_dir, new_dir):
    names = sorted({p.name for d in (old_dir, new_dir) for p in d.iterdir() if p.name != "report.json"})
    for name in names:
        a, b = old_dir / name, new_dir / name
        if not (a.exists() and b.exists() and contents(a) == contents(b)):
            yield name
    for key in ("counters", "left_out", "tiles_rendered", "work_rendered"):
        if old.get(key) != new.get(key):
            odd = [k for k in old[key] if old[key][k] != new[key].get(k)] if isinstance(old.get(key), dict) else ""
            yield f"{key} {odd}"
    if abs(new["peak_gpu_bytes"] / old["peak_gpu_bytes"] - 1) > 0.01:
        yield f"peak_gpu_bytes {old['peak_gpu_bytes']} {new['peak_gpu_bytes']}"


def ways_of(asked):
    ways = [w for w in WAYS if not asked.modes or w[1] in asked.modes.split(",")]
    parallel = [["--size", asked.size, *CAMERA[2:], *w] for w in ways]
    return parallel + [[*CANTED, *w] for w in ways if w[1] in ("paper", "predicted", "reproject") and not asked.modes]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--modes", help="some alone, with a comma between them")
    parser.add_argument("--size", default=CAMERA[1])
    asked = parser.parse_intermixed_args()
    differing = 0
    with tempfile.TemporaryDirectory() as folder:
        dirs = [pathlib.Path(folder) / "old", pathlib.Path(folder) / "new"]
        for scene in asked.scenes:
            for way in ways_of(asked):
                ratios = []
                for turn in range(asked.times):
                    reports = {}
                    for i in (0, 1) if turn % 2 == 0 else (1, 0):
                        reports[i] = render((asked.old, asked.new)[i], scene, way, dirs[i])
                    ratios.append(reports[1]["gpu_total_ms"] / reports[0]["gpu_total_ms"])
                found = list(differences(reports[0], reports[1], *dirs))
                differing += bool(found)
                time = f", {statistics.median(ratios):.3f} of the time" if asked.times > 1 else ""
                print(f"{scene} {' '.join(way)}: {'; '.join(found) or 'the same'}{time}", flush=True)
    print(f"{differing} differ")
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
