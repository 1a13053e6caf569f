#!/usr/bin/env python3
"""PSNR of a training's test cameras: evaluate.py SCENE cameras.json PHOTOGRAPHS [--every N]

SCENE is what the training made (a PLY file, or its output folder), cameras.json the file that 3DGS and 2DGS leave
beside it, PHOTOGRAPHS the folder of the pictures it names. As in these trainings, every eighth camera by name is
a test camera. Photographs are PNG files of 8 bits or, if python3-pil is installed, anything that it reads; if they
are a whole number of times larger than the camera says, they are averaged down.
"""

import argparse
import json
import pathlib
import struct
import sys
import zlib

import binosplat
import numpy as np


def read_png(path):
    """(H, W, 3), 0 to 1, of a PNG file with 8 bits a channel that is not interlaced."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        sys.exit(f"{path}: is no PNG file, must be one, or install python3-pil")
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colours, *_, interlaced = struct.unpack(">IIBBBBB", data[at + 8:at + 21])
        packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += length + 12
    channels = {0: 1, 2: 3, 4: 2, 6: 4}.get(colours)
    if depth != 8 or channels is None or interlaced:
        sys.exit(f"{path}: is a PNG file of another kind, must have 8 bits a channel, or install python3-pil")
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    image = np.zeros((height + 1, width + 1, channels), np.uint8)  # a row and a column of zeros before it
    for y in range(height):
        line, above = rows[y, 1:].reshape(width, channels), image[y]
        now, kind = image[y + 1], rows[y, 0]
        if kind == 0:
            now[1:] = line
        elif kind == 1:
            now[1:] = np.cumsum(line, axis=0, dtype=np.uint8)
        elif kind == 2:
            now[1:] = line + above[1:]
        else:
            for x in range(width):
                a, b, c = now[x].astype(int), above[x + 1].astype(int), above[x].astype(int)
                p = a + b - c
                nearest = np.where((abs(p - a) <= abs(p - b)) & (abs(p - a) <= abs(p - c)), a, np.where(abs(p - b) <= abs(p - c), b, c))
                now[x + 1] = line[x] + ((a + b) // 2 if kind == 3 else nearest).astype(np.uint8)
    image = image[1:, 1:]
    return (image[..., :3] if channels > 2 else image[..., :1].repeat(3, 2)) / 255.0


def read_photograph(path, width, height):
    try:
        from PIL import Image
        photograph = np.asarray(Image.open(path).convert("RGB")) / 255.0
    except ImportError:
        photograph = read_png(path)
    factor = photograph.shape[1] // width
    if factor < 1 or photograph.shape[:2] != (factor * height, factor * width):
        sys.exit(f"{path}: has {photograph.shape[1]}x{photograph.shape[0]} pixels, must have {width}x{height}")
    return photograph.reshape(height, factor, width, factor, 3).mean(axis=(1, 3))


def view_of(camera):
    """A camera of cameras.json: its matrix leads from the camera to the world; the principal point is the middle
    unless it is given."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = camera["rotation"], camera["position"]
    width, height = camera["width"], camera["height"]
    return binosplat.View.from_intrinsics(matrix, camera["fx"], camera["fy"], camera.get("cx", width / 2), camera.get("cy", height / 2), width, height)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("cameras", type=pathlib.Path)
    parser.add_argument("photographs", type=pathlib.Path)
    parser.add_argument("--every", type=int, default=8)
    options = parser.parse_args()
    cameras = sorted(json.loads(options.cameras.read_text()), key=lambda camera: camera["img_name"])[::options.every]
    scene = binosplat.Scene.from_file(options.scene)
    scores = []
    for camera in cameras:
        found = sorted(options.photographs.glob(pathlib.Path(camera["img_name"]).stem + ".*"))
        if not found:
            sys.exit(f"{options.photographs}: has no picture {camera['img_name']}")
        colour, _ = scene.render(view_of(camera))
        error = np.mean((np.clip(colour[0, ..., :3], 0, 1) - read_photograph(found[0], camera["width"], camera["height"])) ** 2)
        scores.append(10 * np.log10(1 / error))
        print(f"{camera['img_name']} {scores[-1]:.2f}")
    print(f"mean {np.mean(scores):.2f} dB of {len(scores)} test cameras")


if __name__ == "__main__":
    main()
