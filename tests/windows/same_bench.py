#!/usr/bin/env python3
"""same_bench.py EXPECTED ACTUAL: checks whether two folders of `binosplat bench` have the same files, rows and
scores; times may differ. Prints the differences, and exits with 1 if there are any."""

import csv
import pathlib
import sys

SCORES = ("psnr", "ssim", "flip")
expected, actual = map(pathlib.Path, sys.argv[1:3])
odd = sorted({p.name for p in expected.iterdir()} ^ {p.name for p in actual.iterdir()})
rows = [list(csv.DictReader(open(folder / "bench.csv", encoding="utf-8", newline=""))) for folder in (expected, actual)]
if len(rows[0]) != len(rows[1]) or not rows[0]:
    odd.append(f"{len(rows[0])} and {len(rows[1])} rows")
for old, new in zip(*rows):
    for key in old:
        name = f"{old.get('method') or old.get('mode')}: {key} is {old[key]} and {new.get(key)}"
        if key in ("scene", "mode", "method", "series", "width", "height") and old[key] != new.get(key):
            odd.append(name)
        elif key.split(" ")[-1].startswith(SCORES) and old[key] != new.get(key) and abs(float(old[key] or "nan") - float(new[key] or "nan")) > 0.01:
            odd.append(name)
print("".join(f"    {line}\n" for line in odd), end="")
sys.exit(1 if odd else 0)
