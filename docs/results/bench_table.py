#!/usr/bin/env python3
"""A table of README.md from what `bench` wrote: bench_table.py front|pays|headsets|stages bench.csv

front: a row a method, a column a view. pays: a row a view, what `predicted` takes. headsets: a row a headset. stages: milliseconds
of the first view's stages.
"""
import csv
import sys


def number(row, column):
    return float(row[column]) if row.get(column) else None


def name_of(row):
    scene = row["scene"].split("/")[-1].removesuffix(".ply").removeprefix("builtin:")
    parts = [scene, row["view"], row["headset"], f'{int(row["splats"]):,} splats', f'{row["width"]}x{row["height"]}']
    return ", ".join(p for p in parts if p) + (" (3DGS)" if row["backbone"] == "3DGS" else "")


def percent(row):
    count, tiles = number(row, "tiles_patched"), number(row, "tiles_right")
    return f"{100 * count / tiles:.0f} %" if count and tiles and count < tiles else "all" if count else "0 %"


def psnr(row):
    value = number(row, "all psnr_db")
    return "equal" if value is None or value == float("inf") else f"{value:.1f} dB"


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def front(frames):
    methods = list(dict.fromkeys(r["method"] for rows in frames.values() for r in rows))

    def cell(row):
        if row["method"] in ("two-pass", "shared"):
            return f'{number(row, "ratio_to_two_pass"):.2f}'
        text = f'{psnr(row)}, {number(row, "ratio_to_two_pass"):.2f}/{number(row, "ratio_to_shared"):.2f}'
        return text + (f", {percent(row)}" if number(row, "tiles_patched") else "")

    find = lambda rows, method: next(cell(r) for r in rows if r["method"] == method)
    table(["method", *frames], ([method, *(find(rows, method) for rows in frames.values())] for method in methods))


def pays(frames):
    rows = []
    for name, of_frame in frames.items():
        by = {r["method"]: r for r in of_frame}
        predicted, mono = by["predicted"], by["mono"]
        eye = number(mono, "gpu_total_ms")
        beside = (number(predicted, "reprojection ms") or 0) + (number(predicted, "ROI choice ms") or 0)
        dominant = number(predicted, "cull+sort ms") + number(predicted, "dominant ms")
        work = number(predicted, "work_rendered")
        rendered = percent(predicted) + (f", {100 * work:.0f} %" if percent(predicted) != "all" else "")
        ratios = [number(by[m], "ratio_to_two_pass") for m in ("paper", "shared")]
        rows.append([name, *(f"{number(predicted, c):.2f}" for c in ("ratio_to_shared", "ratio_to_two_pass")), psnr(predicted).removesuffix(" dB"),
                     rendered, f"{beside / eye:.2f}", f"{dominant / eye:.2f}", *(f"{r:.2f}" for r in ratios),
                     f'{number(predicted, "peak_gpu_bytes") / number(by["two-pass"], "peak_gpu_bytes"):.2f}'])
    table(["view", "predicted / shared", "predicted / two-pass", "PSNR dB", "rendered", "beside", "dominant / mono", "paper / two-pass",
           "shared / two-pass", "memory / two-pass"], rows)


def headsets(frames):
    rows = []
    for of_frame in frames.values():
        by = {r["method"]: r for r in of_frame}
        predicted = by["predicted"]
        rows.append([predicted["headset"], *(psnr(by[m]).removesuffix(" dB") for m in ("reproject", "paper", "predicted")),
                     f'{number(predicted, "all ssim"):.3f}', f'{number(predicted, "ratio_to_two_pass"):.2f}',
                     f'{number(predicted, "ratio_to_shared"):.2f}', percent(predicted)])
    table(["headset", "reproject", "paper", "predicted", "its SSIM", "/ two-pass", "/ shared", "tiles rendered"], rows)


def stages(frames):
    rows = next(iter(frames.values()))
    columns = ["cull+sort ms", "dominant ms", "both eyes ms", "reprojection ms", "ROI choice ms", "patch ms", "affiliated ms"]
    table(["stage", *(r["method"] for r in rows)],
          ([c.removesuffix(" ms"), *(f"{number(r, c):.1f}" if number(r, c) else "" for r in rows)] for c in columns))


def main():
    frames = {}
    for row in csv.DictReader(open(sys.argv[2])):
        frames.setdefault(name_of(row), []).append(row)
    {"front": front, "pays": pays, "headsets": headsets, "stages": stages}[sys.argv[1]](frames)


main()
