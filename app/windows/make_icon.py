#!/usr/bin/env python3
"""Writes binosplat.ico beside itself: two splats, one for each eye, brighter where they overlap. PNG pictures of 16
to 256 pixels."""

import math
import pathlib
import struct
import zlib

SIZES = (16, 32, 48, 256)


def pixel(x, y):
    """Colour and opacity at a place of the unit square."""
    red = green = blue = opacity = 0.0
    for centre, colour in ((0.36, (0.20, 0.55, 1.00)), (0.64, (1.00, 0.50, 0.15))):
        u, v = (x - centre) / 0.125, (y - 0.5) / 0.19
        alpha = min(0.99, 1.6 * math.exp(-0.5 * (u * u + v * v)))
        red, green, blue = (c + alpha * add for c, add in zip((red, green, blue), colour))
        opacity = 1 - (1 - opacity) * (1 - alpha)
    if opacity < 1 / 255:
        return bytes(4)
    return bytes([*(round(255 * min(1.0, c / max(opacity, 1e-6))) for c in (red, green, blue)), round(255 * opacity)])


def png(size):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + b"".join(pixel((x + 0.5) / size, (y + 0.5) / size) for x in range(size)) for y in range(size))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    pictures = [png(size) for size in SIZES]
    icon = struct.pack("<HHH", 0, 1, len(pictures))
    offset = len(icon) + 16 * len(pictures)
    for size, picture in zip(SIZES, pictures):
        icon += struct.pack("<BBBBHHII", size % 256, size % 256, 0, 0, 1, 32, len(picture), offset)
        offset += len(picture)
    pathlib.Path(__file__).with_name("binosplat.ico").write_bytes(icon + b"".join(pictures))


if __name__ == "__main__":
    main()
