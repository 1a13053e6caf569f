#!/usr/bin/env python3
"""What foveation leaves out and what that costs, as a table for the results page: renders each view in full, by predicted errors alone, and
with --foveation, and compares the affiliated eye's pictures of 8 bits, whole and up to ten degrees from where the eye looks.

Usage: foveation_table.py BINOSPLAT [SCENE.ply ...]: run from the project's folder; without scenes the built-in ones alone.
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib


def read_png(path):
    """Width, height and rows of 8-bit RGB or RGBA; every filter that PNG has."""
    data = path.read_bytes()
    at, packed, width, height, channels = 8, b"", 0, 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", body[:10])
            channels = {2: 3, 6: 4}[colour]
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, size, rows, before = zlib.decompress(packed), width * channels, [], bytearray(width * channels)
    for y in range(height):
        kind, row = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for i in range(size):
            left, up = row[i - channels] if i >= channels else 0, before[i]
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                corner = before[i - channels] if i >= channels else 0
                guess = left + up - corner
                far = [(abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner)]
                row[i] = (row[i] + min(far)[2]) & 255
        rows.append(row)
        before = row
    return width, height, channels, rows


def psnr(a, b, inside):
    """Of the pixels for which `inside` is true, in decibels."""
    width, height, channels, rows = a
    sum_squares, count = 0, 0
    for y in range(height):
        for x in range(width):
            if not inside(x + 0.5, y + 0.5):
                continue
            i = x * channels
            count += 3
            for c in range(3):
                sum_squares += (rows[y][i + c] - b[3][y][x * b[2] + c]) ** 2
    return 10 * math.log10(255 ** 2 * count / max(sum_squares, 1e-9))


def main():
    binosplat = str(pathlib.Path(sys.argv[1]).resolve())
    near = ["--eye", "0,-0.6,-1.6", "--look", "0,-0.4,0", "--up", "0,-1,0", "--fov-x", "60", "--size", "1024x1024"]
    # The principal point of the right eye and its focal lengths, in pixels.
    square = (512.0, 512.0, 512 / math.tan(math.radians(30)), 512 / math.tan(math.radians(30)))

    def tangent(degrees):
        return math.tan(math.radians(degrees))

    size = (1176, 1184)  # half of its pixels each way
    fx, fy = size[0] / (tangent(45) + tangent(52)), size[1] / (tangent(48) + tangent(50))
    quest = (fx * tangent(45), fy * tangent(48), fx, fy)
    views = [("builtin:atelier, Quest 2", "builtin:atelier", ["--headset", "quest2", "--size", "1176x1184"], quest)]
    views += [(pathlib.Path(scene).stem, scene, near, square) for scene in sys.argv[2:]]
    print("| view | | tiles rendered again | of them for their error | work of an eye | PSNR whole | up to 10 degrees |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, scene, camera, (cx, cy, fx, fy) in views:
            def render(label, more):
                out = pathlib.Path(folder) / label
                subprocess.run([binosplat, "render", scene, *camera, "--out", str(out), *more], check=True, stdout=subprocess.DEVNULL)
                return read_png(out / "right.png"), json.loads((out / "report.json").read_text())["counters"]

            full, _ = render("full", ["--mode", "shared"])
            everywhere = lambda x, y: True
            middle = lambda x, y: math.hypot((x - cx) / fx, (y - cy) / fy) < math.tan(math.radians(10))
            for options in ["", "--foveation 15", "--foveation 8", "--foveation 8 --budget 0.4"]:
                picture, counters = render("made", options.split())
                label = f"`{options}`" if options else "no foveation"
                work = counters["work_patched"] / counters["work_full"]
                print(f"| {name} | {label} | {counters['tiles_patched']} | {counters['tiles_predicted']} | {work:.3f} | "
                      f"{psnr(picture, full, everywhere):.2f} | {psnr(picture, full, middle):.2f} |", flush=True)


if __name__ == "__main__":
    main()
