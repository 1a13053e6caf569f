#!/usr/bin/env python3
"""The README's picture of an edge and its loop of a walk: docs/readme_pictures.py PROGRAM PLAYBOT POSES.csv docs

PLAYBOT is the streamed SOG scene (third level: 125,000 3D Gaussians), POSES.csv the recorded walk that docs/results/motion.md names. Needs
ImageMagick and img2webp (Debian: webp); the frames are kept below build/readme_pictures, and rendered again only where they are missing."""

import json
import math
import pathlib
import subprocess
import sys

FRAMES = pathlib.Path("build/readme_pictures")
METHODS = (
    ("two-pass", "rendered in full"),
    ("reproject", "warped, not patched"),
    ("predicted", "from the left eye, patched"),
    ("temporal", "from the past, patched"),
)
EDGE_VIEW = "--lod 2 --eye 0,-0.6,-1.6 --look 0,-0.4,0 --up 0,-1,0 --fov-x 60 --size 1024x1024 --from 20 --seconds 0.34".split()
EDGE_FRAME, EDGE_PX, EDGE_AT, MAGNIFIED = "frame_000030_right.png", 64, (656, 336), 3
ERROR_TIMES = 4
WALK_SPLATS, WALK_VIEW = "400000", "--size 400x400 --from 20 --seconds 2.6".split()
WALK_EVERY, WALK_QUALITY = 6, 82


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True).stdout


def render(program, scene, poses, name, *options):
    out = FRAMES / name
    if not (out / "report.json").exists():
        run(program, "render", scene, "--path", poses, "--path-axes", "unity", "--rate", "90", *options, "--out", out)
    return out


def psnr(a, b):
    a, b = (run("convert", picture, "-depth", "8", "rgb:-") for picture in (a, b))
    squares = sum((x - y) ** 2 for x, y in zip(a, b))
    return 10 * math.log10(255**2 * len(a) / squares) if squares else math.inf


def label(width, text):
    return ["(", "-size", f"{width}x20", "-background", "white", "-fill", "black", "-font", "DejaVu-Sans", "-pointsize", "12",
            "-gravity", "center", f"caption:{text}", ")"]


def draw_edge(program, playbot, poses, out):
    full, columns, side = None, [], EDGE_PX * MAGNIFIED
    for mode, words in METHODS:
        picture = render(program, playbot, poses, f"edge_{mode}", "--mode", mode, *EDGE_VIEW) / EDGE_FRAME
        crop, below, column = (FRAMES / f"{mode}_{part}.png" for part in ("crop", "below", "column"))
        run("convert", picture, "-crop", f"{EDGE_PX}x{EDGE_PX}+{EDGE_AT[0]}+{EDGE_AT[1]}", "+repage", crop)
        large = ["-filter", "point", "-resize", f"{100 * MAGNIFIED}%"]
        if full is None:  # the whole eye, with a box around the edge
            full = picture, crop
            corners = f"{EDGE_AT[0]},{EDGE_AT[1]} {EDGE_AT[0] + EDGE_PX},{EDGE_AT[1] + EDGE_PX}"
            box = ["-fill", "none", "-stroke", "red", "-strokewidth", "6", "-draw", f"rectangle {corners}"]
            run("convert", picture, *box, "-resize", f"{side}x{side}", below)
            whole, part = mode, f"where it is; errors: {ERROR_TIMES} times"
        else:
            difference = ["-compose", "difference", "-composite", "-evaluate", "multiply", ERROR_TIMES]
            run("convert", crop, full[1], *difference, *large, below)
            whole, part = f"{mode}, {psnr(picture, full[0]):.1f} dB", f"here {psnr(crop, full[1]):.1f} dB"
        run("convert", *label(side, words), "(", crop, *large, ")", *label(side, whole), below, *label(side, part), "-append", column)
        columns += [column, "(", "-size", "8x1", "xc:white", ")"]
    run("convert", *columns[:-5], "-background", "white", "+append", "+repage", "-strip", "-depth", "8", out / "edge.png")


def draw_walk(program, poses, out):
    scene = FRAMES / "atelier.ply"
    if not scene.exists():
        run(program, "scene", "atelier", "--splats", WALK_SPLATS, "--out", scene)
    folder = render(program, scene, poses, "walk", *WALK_VIEW)
    count = len(json.loads((folder / "report.json").read_text())["frames"])
    numbers = list(range(0, count, WALK_EVERY))
    pairs = []
    for number in numbers:
        pair = FRAMES / f"pair_{number:06}.png"
        eyes = [folder / f"frame_{number:06}_{eye}.png" for eye in ("left", "right")]
        run("convert", eyes[0], "(", "-size", "8x1", "xc:white", ")", eyes[1], "-background", "white", "+append", "+repage", pair)
        pairs.append(pair)
    there_and_back = pairs + pairs[-2:0:-1]
    # Every frame whole: what img2webp keeps from one frame to the next leaves seams.
    run("img2webp", "-loop", 0, "-kmin", 0, "-kmax", 1, "-lossy", "-q", WALK_QUALITY, "-m", 6, "-d", round(WALK_EVERY / 90 * 1000),
        *there_and_back, "-o", out / "walk.webp")


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    program, playbot, poses, out = sys.argv[1:]
    FRAMES.mkdir(parents=True, exist_ok=True)
    draw_edge(program, playbot, poses, pathlib.Path(out))
    draw_walk(program, poses, pathlib.Path(out))


if __name__ == "__main__":
    main()
